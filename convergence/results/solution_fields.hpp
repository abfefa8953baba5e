#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "convergence/oracle/oracle.hpp"
#include "convergence/results/solve_record.hpp"
#include "solver/input/field_file.hpp"
#include "solver/solution.hpp"

/// Fields of solutions and of exact answers at the cell centres of a grid: lengths in m, tractions in Pa.
namespace slipstick::convergence {

/// Tractions, pressure, stick, slip and dissipated energy (J/m^2) of a solution, the last two of its step,
/// and the exact traction where it is known. The columns refer to the solution, which must outlive them.
std::vector<solver::FieldColumn> solution_columns(const solver::Solution& solution, const OracleAnswer& exact);

/// Writes these, for the cells under pressure.
void write_solution_fields(const std::filesystem::path& file, const solver::Solution& solution,
                           const OracleAnswer& exact);

/// Traction over mu p0 in the contact cells along the positive x1 axis and along the diagonal; empty where
/// the exact tractions are not known.
std::vector<ProfilePoint> make_profile(const solver::Solution& solution, const OracleAnswer& exact);

struct GridColumns {
  solver::Grid grid;
  std::vector<solver::Column> columns;
  Eigen::ArrayXd pressure;
};

/// The exact answer on the scene's grid, in the columns of solution_columns() without the slips, which have no closed
/// form. A cone's pressure is infinite on the axis, where an odd number of cells has a centre. Throws InputError for an
/// answer without tractions and a grid that does not fit in memory. ranks: the processes that share the grid.
GridColumns exact_columns(const solver::Scene& scene, const Oracle& oracle, const solver::Ranks& ranks = {});

/// Writes these, for the cells under pressure. Throws InputError for a file that cannot be written, too.
void write_exact_fields(const std::filesystem::path& file, const solver::Scene& scene, const Oracle& oracle,
                        const solver::Ranks& ranks = {});

}  // namespace slipstick::convergence
