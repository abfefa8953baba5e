#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/oracle/oracle.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/input/field_file.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {

/// A solution as the result file has it: SI units, radians, errors against the exact answer where there is
/// one. A number that does not exist is null, with its reason beside it under the same name and "_reason".
Json solve_result(const solver::Scene& scene, const solver::Solution& solution, const OracleAnswer& exact);

/// The end of one step of a history: its state, certificate, errors and cost.
Json step_result(const solver::Scene& scene, const solver::Solution& solution, const OracleAnswer& exact);

/// Whether the result of a scene has steps: what it asks for decides, not how far a solve came.
bool has_history(const solver::Scene& scene);

/// Adds the steps of a history to the result of its last one, with their sums.
void add_steps(Json& result, Json steps);

/// Why slip has no direction in a result.
inline constexpr const char* kNoSlip = "nothing slips";

/// The same for a person: a few lines.
std::string solve_text(const Json& result);

/// Traction over mu p0 in the contact's cells beside the positive x1 axis and along the diagonal, as rows of
/// {radius (r/a), value, exact, error}; none where the exact tractions are not known.
Json profile_json(const solver::Solution& solution, const OracleAnswer& exact);

/// Tractions, pressure, slip, stick and the energy dissipated (J/m^2) of a solution (and the exact traction,
/// where known) over its cells, which the columns refer to; slip and dissipated of its step.
std::vector<solver::FieldColumn> solution_columns(const solver::Solution& solution,
                                                  const OracleAnswer& exact);

/// Writes these, where there is pressure.
void write_solution_fields(const std::filesystem::path& file, const solver::Solution& solution,
                           const OracleAnswer& exact);

}  // namespace slipstick::convergence
