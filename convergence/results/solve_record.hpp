#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "solver/grid/grid.hpp"
#include "solver/newton/safeguards.hpp"
#include "solver/scene/roughness.hpp"
#include "solver/scene/scene.hpp"
#include "solver/solution.hpp"

/// The result of one solve as a value, in SI units and radians: docs/schema/solve.schema.json has the same
/// names. to_json() and from_json() are the only two places where it becomes JSON and comes back.
namespace slipstick::convergence {

using Json = nlohmann::ordered_json;

/// A number, or NaN and the reason why it does not exist.
struct Number {
  double value = std::numeric_limits<double>::quiet_NaN();
  std::string why_missing = {};

  operator double() const { return value; }  // NOLINT(google-explicit-constructor): it is used as a number
};

/// A value that is not finite is missing, for this reason.
inline Number number_or(double value, const std::string& why_missing) {
  return std::isfinite(value) ? Number{value} : Number{.why_missing = why_missing};
}

/// Components along x1 and x2, or NaN and the reason why they do not exist.
struct Components {
  std::array<double, 2> values{Number().value, Number().value};
  std::string why_missing = {};

  bool is_known() const { return std::isfinite(values[0]) && std::isfinite(values[1]); }
  /// sqrt(v1^2 + v2^2), NaN where they are missing.
  double length() const { return std::hypot(values[0], values[1]); }
};

enum class RunStatus {
  converged,
  not_converged,
  refused,  ///< the scene cannot be had: gross slip or too little memory
  failed    ///< the process that solved it ended without a result
};
std::string to_string(RunStatus status);

/// Size of contact and stick area; the normal contact.
struct ContactRecord {
  solver::Index contact_cells = 0;
  solver::Index stick_cells = 0;
  solver::CountedArea contact_area = {};  ///< m^2
  solver::CountedArea stick_area = {};    ///< m^2
  Number contact_radius = {};             ///< m, as the following
  Number contact_radius_counted = {};     ///< of a circle with the area of the contact cells
  Number stick_radius = {};
  std::string stick_radius_note = {};  ///< why the stick radius is only counted; empty: it is not
  Number stick_radius_counted = {};
  Number stick_ratio = {};  ///< stick_radius over contact_radius
  Number normal_load = {};  ///< N
  Number peak_pressure = {};
  Number approach = {};
};

struct FrictionRecord {
  Number coefficient = {};
  std::string law = {};  ///< empty: Coulomb's without a map
  std::optional<double> shear_strength = {};
  std::optional<double> exponent = {};
  std::string map = {};  ///< file of the friction's factors; empty: none
  Number force = {};     ///< N, that slides the contact along a line
};

/// How far the loads could rise, and the motion in which the contact would slide: about a centre or along a line.
struct LimitRecord {
  Number factor = {};
  std::optional<std::array<double, 2>> centre = {};     ///< m
  std::optional<std::array<double, 2>> direction = {};  ///< of length 1
};

/// Tangential loads and motions since the first step began.
struct LoadsRecord {
  Number twist_angle = {};       ///< rad
  Number moment = {};            ///< N m
  Number moment_limit = {};      ///< N m, without force
  Number moment_ratio = {};      ///< moment over moment_limit
  Number twist = {};             ///< G a^2 twist_angle / (mu W)
  std::string warning = {};      ///< why an imposed load is likely a mistake; empty: it is not
  Components force = {};         ///< N
  Components displacement = {};  ///< m
  LimitRecord limit = {};
};

/// J.
struct EnergyRecord {
  Number elastic = {};
  Number dissipated = {};                       ///< in the step
  Number work = {};                             ///< of the loads, less the stored energy
  std::optional<Number> dissipated_total = {};  ///< since the first step began
};

/// See solver::ContinuumGap and solver::PressureGap; missing numbers have the reason.
struct ContinuumRecord {
  Number gap = {};
  Number energy = {};  ///< J
  Number quadrature_error = {};
  std::string number = {};  ///< that the loads leave open: twist_angle, displacement, moment or force
  Number low = {};          ///< its interval in the continuous problem
  Number high = {};
  Number pressure_gap = {};
  Number pressure_energy = {};  ///< J
  Number pressure_quadrature_error = {};
  Number friction_bound_error = {};  ///< over energy
};

/// See solver::Certificate.
struct CertificateRecord {
  Number gap = {};
  Number energy_error = {};
  Number rounding = {};
  Number moment = {};
  Number force = {};
  Number friction_bound = {};
  std::optional<Number> energy = {};  ///< J; fields of other programs have none
  std::optional<ContinuumRecord> continuum = {};
};

/// The uncertainty of each number by the length of the steps.
struct PathsRecord {
  Number twist_angle = {};
  Number displacement = {};
  Number moment = {};
  Number force = {};
};

/// See solver::Resolution.
struct ResolutionRecord {
  double stick_width = 0.0;
  double slip_width = 0.0;
  std::string number = {};  ///< key of the number that the loads leave open
  Number uncertainty = {};  ///< of it, relative
  Number absolute = {};     ///< the same in its unit, as the following
  Number mesh = {};
  Number path = {};
  PathsRecord paths = {};
  std::string warning = {};  ///< empty: the mesh resolves the contact
};

/// See FieldError.
struct FieldErrorRecord {
  Number l1 = {};
  Number l2 = {};
  Number max = {};
  std::string kept = {};  ///< of sharpened fields: the edges whose cells keep their numbers, and why
};

/// See TractionError.
struct TractionErrorRecord {
  FieldErrorRecord at_centres = {};
  FieldErrorRecord averaged = {};
  FieldErrorRecord stick_edge = {};
  FieldErrorRecord contact_edge = {};
  FieldErrorRecord inside = {};
  FieldErrorRecord outside = {};
  std::optional<FieldErrorRecord> sharpened = {};
};

/// See Oracle.
struct ExactRecord {
  Number twist_angle = {};
  Number twist = {};
  Number moment = {};
  Number moment_limit = {};
  Components force = {};
  Components displacement = {};
  Number stick_radius = {};
  Number stick_ratio = {};
  Number contact_radius = {};
  Components semi_axes = {};  ///< m, the longer one first
  Number peak_pressure = {};
  Number approach = {};
  Number dissipated = {};
  double relative_uncertainty = 0.0;
};

/// Errors against the exact answer: computed/exact - 1, see Errors. Without an exact answer, and for the
/// exact answer itself, only the reason is known, in `twist`, `moment` and `stick_radius`.
struct ErrorsRecord {
  Number twist = {};
  Number moment = {};
  Number moment_limit = {};
  Number displacement = {};
  Number stick_radius = {};
  Number stick_ratio = {};
  Number stick_radius_counted = {};
  Number contact_radius = {};
  Number peak_pressure = {};
  Number dissipated = {};
  TractionErrorRecord traction = {};
  FieldErrorRecord pressure = {};
  std::optional<ExactRecord> exact = {};
};

struct WorkRecord {
  int iterations = 0;
  double operator_applications = 0.0;  ///< tangential, of all grids, in applications on the finest one
  double pressure_applications = 0.0;  ///< of the normal operator, counted the same way
  std::optional<int> turns = {};       ///< of pressure and shear, under full coupling
  solver::Seconds seconds = {};
};

/// The end of a step.
struct EndRecord {
  ContactRecord contact = {};
  FrictionRecord friction = {};
  LoadsRecord loads = {};
  EnergyRecord energy = {};
  CertificateRecord certificate = {};
  ResolutionRecord resolution = {};
  ErrorsRecord errors = {};
  WorkRecord work = {};
};

/// One step of a history.
struct StepRecord {
  std::string name = {};
  int cycle = 1;
  RunStatus status = RunStatus::not_converged;
  std::string message = {};  ///< why it did not converge; empty: it did
  EndRecord end = {};
};

struct HistoryRecord {
  Number dissipated = {};  ///< J, of all steps
  Number worst_gap = {};   ///< the largest certificate.gap
  double operator_applications = 0.0;
  double seconds = 0.0;
  std::vector<StepRecord> steps = {};
};

/// The discrete problem and the method.
struct ProblemRecord {
  std::string method = {};  ///< "exact", "program" or a word of solver.method; empty: a history that broke off
  std::string op = {};
  std::string cell_traction = {};
  std::string pressure = {};
  std::string profile = {};  ///< of the exact answer
  std::vector<solver::Omission> left_out = {};
  std::array<solver::Index, 2> cells{};
  std::array<double, 2> cell_size{};  ///< m
  std::vector<solver::RoughnessSpectrum> roughness = {};
  double tolerance = 0.0;
};

struct GridRecord {
  std::array<solver::Index, 2> cells{};
  long applications = 0;
  int iterations = 0;
  Number stopped_at = {};  ///< gap over energy
};

/// See solver::SlipDirection: degrees.
struct SlipDirectionRecord {
  Number mean = {};
  Number max = {};
};

/// How the last step was solved.
struct MethodRecord {
  std::vector<GridRecord> grids = {};  ///< coarsest first
  solver::Safeguards safeguards = {};
  int pressure_iterations = 0;
  double pressure_complementarity = 0.0;
  Number change = {};  ///< last value of the method's stopping test
  SlipDirectionRecord slip_direction = {};
};

/// Several processes that share a grid: numbers in the order of the ranks.
struct RanksRecord {
  int number = 0;
  std::vector<double> peak_bytes = {};
  std::vector<double> sent_bytes = {};
  std::vector<double> sent_messages = {};
};

struct MemoryRecord {
  double solver_bytes = 0.0;     ///< predicted, of operators and workspaces
  double predicted_bytes = 0.0;  ///< of the whole step
  std::size_t peak_bytes = 0;
  std::optional<RanksRecord> ranks = {};
};

/// How a result was made.
struct Provenance {
  std::string version = {};  ///< of slipstick
  std::string commit = {};   ///< of its source
  std::string compiler = {};
  std::string flags = {};
  std::string libraries = {};
  std::string cpu = {};
  int threads = 1;  ///< of the operator
};

/// Numbers that another program states of its answer.
struct OwnNumbers {
  std::optional<double> twist_angle = {};  ///< rad
  std::optional<double> twist = {};        ///< the same, where it was written under this older name
  std::optional<double> iterations = {};
  std::optional<double> seconds = {};
  std::optional<bool> converged = {};
  std::string message = {};
};

/// The program that found pressure and tractions.
struct ProgramRecord {
  std::string name = {};
  std::string file = {};
  std::string version = {};
  std::string fields = {};  ///< "pressure and tractions" or "pressure"
  double wall_seconds = 0.0;
  double cpu_seconds = 0.0;
  OwnNumbers own = {};
};

/// A traction over mu p0 at radius/a.
struct ProfilePoint {
  double radius = 0.0;
  double value = 0.0;
  double exact = 0.0;
  double error = 0.0;
};

/// One solve: an answer on a grid (at the end of the last step, with all steps of a history); an exact
/// answer; the steps of a history that broke off; or the reason why a run has no answer.
struct SolveRecord {
  RunStatus status = RunStatus::not_converged;
  std::string message = {};                ///< why it is not converged
  std::string run = {};                    ///< of a run without an answer: its scene and overrides
  bool out_of_memory = false;              ///< it was refused for its memory
  std::string name = {};                   ///< of the scene
  std::vector<std::string> warnings = {};  ///< see doubts_about()
  ProblemRecord problem = {};
  EndRecord end = {};
  MethodRecord method = {};
  MemoryRecord memory = {};
  Provenance provenance = {};
  std::optional<HistoryRecord> history = {};
  std::optional<ProgramRecord> program = {};
  std::optional<std::vector<ProfilePoint>> profile = {};
  std::optional<FieldErrorRecord> stress_error = {};

  /// Whether it has no answer: it was refused or failed.
  bool is_failed() const { return status == RunStatus::refused || status == RunStatus::failed; }
  bool is_converged() const { return status == RunStatus::converged; }
  bool is_exact() const { return problem.method == "exact"; }
  /// s, of all steps; NaN where there is no answer.
  double seconds() const;
};

Json to_json(const SolveRecord& record);
/// Throws InputError for JSON that is no result of a solve.
SolveRecord from_json(const Json& json);

/// Each of them.
std::vector<Json> to_json(const std::vector<SolveRecord>& records);

/// Parts of it, for rows of tables and checkpoints.
Json to_json(const StepRecord& step);
StepRecord step_from_json(const Json& json);
Json to_json(const CertificateRecord& certificate);
Json to_json(const FieldErrorRecord& error);
Json to_json(const solver::Safeguards& safeguards);
Json to_json(const TractionErrorRecord& error);
void to_json(Json& json, const Provenance& provenance);

}  // namespace slipstick::convergence
