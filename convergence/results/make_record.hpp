#pragma once

#include <string>
#include <vector>

#include "convergence/oracle/errors.hpp"
#include "convergence/oracle/oracle.hpp"
#include "convergence/results/solve_record.hpp"
#include "solver/solution.hpp"

/// Records of solutions: SI units, radians, errors against the exact answer where there is one.
namespace slipstick::convergence {

/// steps: all steps of the scene's history with the last one; empty without a history.
SolveRecord make_record(const solver::Scene& scene, const solver::Solution& solution, const OracleAnswer& exact,
                        std::vector<StepRecord> steps = {});

/// The end of one step of a history.
StepRecord make_step(const solver::Scene& scene, const solver::Solution& solution, const OracleAnswer& exact);

/// The finished steps of a history that broke off, at least one.
SolveRecord make_incomplete(const std::string& scene_name, const std::string& why, std::vector<StepRecord> steps);

/// Reasons to doubt that a scene is the one that was meant, or that the theory holds for it: from the sizes
/// of slopes, pressures and twists in its result. They change no status and no verdict.
std::vector<std::string> doubts_about(const solver::Scene& scene, const SolveRecord& record);

/// Whether the scene has several steps, solved or not.
bool has_history(const solver::Scene& scene);

/// Key of a number in records: twist_angle, displacement, moment or force.
const char* quantity_key(double solver::Quantities::*number);

/// Reason why slip has no direction.
inline constexpr const char* kNoSlip = "nothing slips";

// ---------------------------------------------------------------- parts; reason: why a number is missing

/// The parts of a friction law; force: N, that slides the contact.
FrictionRecord make_friction(const solver::FrictionLaw& law, double force);
/// Without its energy.
CertificateRecord make_certificate(const solver::Certificate& certificate, const std::string& reason);
/// The errors of a result without an exact answer: only the reason.
ErrorsRecord no_errors(const std::string& reason);
FieldErrorRecord make_field_error(const FieldError& error, const std::string& reason);
/// Without sharpened fields.
TractionErrorRecord make_traction_error(const TractionError& error, const std::string& reason);

/// The most memory that this process has held, in bytes.
std::size_t peak_bytes();

}  // namespace slipstick::convergence
