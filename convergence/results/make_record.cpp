#include "convergence/results/make_record.hpp"

#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <utility>

#include "convergence/results/provenance.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/mpi/communicator.hpp"

namespace slipstick::convergence {
namespace {

using solver::Solution;

const std::string kBrokeDown = "the solve broke down";
const std::string kBroken = "the solve broke down, or there is no friction";
const std::string kNoPeak = "the exact pressure has no finite peak";

Components pair_or(const std::array<double, 2>& values, const std::string& why_missing) {
  const Components pair{.values = values};
  return pair.is_known() ? pair : Components{.why_missing = why_missing};
}

// ---------------------------------------------------------------- contact, loads, energies

ContactRecord contact_of(const solver::Scene& scene, const Solution& solution) {
  const bool solved = scene.contact.pressure == solver::PressureModel::solved;
  return {.contact_cells = solution.contact_cells,
          .stick_cells = solution.stick_cells,
          .contact_area = solution.contact_area,
          .stick_area = solution.stick_area,
          .contact_radius = {solution.contact_radius},
          .contact_radius_counted = {solution.contact_radius_counted},
          .stick_radius = number_or(solution.stick_radius, kBrokeDown),
          .stick_radius_note = solution.stick_radius_note,
          .stick_radius_counted = {solution.stick_radius_counted},
          .stick_ratio = number_or(solution.stick_radius / solution.contact_radius, "no contact"),
          .normal_load = {solution.normal_load},
          .peak_pressure = {solution.peak_pressure},
          .approach = solved ? Number{solution.approach} : Number{.why_missing = "the normal contact was not solved"}};
}

LimitRecord limit_of(const solver::LimitLoad& limit) {
  LimitRecord record{.factor = number_or(limit.factor, std::isnan(limit.factor) ? kBroken : "no load is imposed")};
  if (!std::isfinite(limit.factor)) return record;
  if (limit.centre) {
    record.centre = *limit.centre;
  } else {
    const double size = std::hypot(limit.sliding.delta1, limit.sliding.delta2);
    record.direction = {limit.sliding.delta1 / size, limit.sliding.delta2 / size};
  }
  return record;
}

/// A twist is taken for a mistake above 15 times the elastic twist, where the moment is within 1e-4 of its
/// limit. No contact out of 120 that were twisted to 0.02 to 0.999 of the limit was there.
constexpr double kFarBeyondElastic = 15.0;
constexpr double kNextToLimit = 1e-4;

/// The warning about a twist that was likely not meant in rad. While nothing slips, twist times moment is
/// twice the elastic energy.
std::string load_warning(const Solution& solution) {
  const auto imposed = solver::value_if<solver::Twist>(solution.loads.torsion);
  const double a = solution.contact_radius;
  const double normalised = solution.shear_modulus * a * a / solution.friction_force;
  const double times = std::abs(solution.twist_angle * solution.moment) / (2.0 * solution.elastic_energy);
  const bool slides = std::abs(solution.moment) > (1.0 - kNextToLimit) * solution.moment_limit;
  if (!imposed || !slides || !(times > kFarBeyondElastic)) return "";
  return fmt::format(
      "all slides: the imposed twist of {:.6g} rad is {:.3g} times the one that the bodies take up by "
      "deforming; {}.twist is in rad, while a result's twist is G a^2 phi/(mu W), of which {:.6g} is {:.6g} "
      "rad",
      *imposed, times, solution.loads.key, *imposed, *imposed / normalised);
}

LoadsRecord loads_of(const Solution& solution) {
  const double a = solution.contact_radius;
  return {.twist_angle = number_or(solution.twist_angle, kBrokeDown),
          .moment = number_or(solution.moment, kBrokeDown),
          .moment_limit = {solution.moment_limit},
          .moment_ratio = number_or(solution.moment / solution.moment_limit,
                                    solution.moment_limit > 0.0 ? kBrokeDown : "the limit moment is zero"),
          .twist = number_or(solution.shear_modulus * a * a * solution.twist_angle / solution.friction_force,
                             "without friction the normalised twist has no scale"),
          .warning = load_warning(solution),
          .force = pair_or(solution.force, kBrokeDown),
          .displacement = pair_or(solution.displacement, kBrokeDown),
          .limit = limit_of(solution.limit)};
}

EnergyRecord energy_of(const Solution& solution) {
  return {.elastic = number_or(solution.elastic_energy, kBrokeDown),
          .dissipated = number_or(solution.dissipated, kBrokeDown),
          .work = number_or(solution.work, kBrokeDown)};
}

// ---------------------------------------------------------------- resolution

constexpr std::array kQuantityKeys{"twist_angle", "displacement", "moment", "force"};

/// The warning that the number is not known well enough to be used, and the remedy.
std::string poorly_resolved(const solver::Resolution& resolution) {
  const double mesh = resolution.mesh.*resolution.number;
  const double path = resolution.path.*resolution.number;
  const std::string uncertain =
      std::isfinite(resolution.uncertainty) ? "uncertain by " + percent_text(resolution.uncertainty) : "not determined";
  const double open = resolution.open.*resolution.number;
  if (!(resolution.step <= solver::kPoorlyResolved) || (open > 0.0 && open >= 0.5 * mesh)) {
    return fmt::format(
        "the mesh is too coarse: the stick area is {:.2g} cells wide, so the contact's motion is {}; take "
        "more cells, or a load further from gross slip",
        resolution.stick_width, uncertain);
  }
  if (std::isinf(path)) {
    return "the error by the length of the steps is not known: its estimate solves on few cells and with "
           "more parts of the steps, which do not carry these loads; compare with a larger solver.substeps";
  }
  if (path > mesh) {
    return fmt::format(
        "the loads are brought in too few parts, so the contact's motion is {}; set solver.substeps higher{}",
        uncertain, resolution.number == &solver::Quantities::twist ? ", or use --accuracy" : "");
  }
  return fmt::format("cancellation between steps dominates, so it is {}; take more cells", uncertain);
}

ResolutionRecord resolution_of(const solver::Resolution& resolution) {
  const double mesh = resolution.mesh.*resolution.number;
  const std::string unknown = std::isfinite(mesh)
                                  ? "the steps' parts on few cells, or more of them, do not carry these loads"
                                  : "the stick area lies within a cell";
  const auto known = [&](double value) { return number_or(value, unknown); };
  const solver::Quantities& path = resolution.path;
  const bool resolved = resolution.uncertainty <= solver::kPoorlyResolved;
  return {.stick_width = resolution.stick_width,
          .slip_width = resolution.slip_width,
          .number = quantity_key(resolution.number),
          .uncertainty = known(resolution.uncertainty),
          .absolute = known(resolution.absolute),
          .mesh = known(mesh),
          .path = known(path.*resolution.number),
          .paths = {.twist_angle = known(path.twist),
                    .displacement = known(path.displacement),
                    .moment = known(path.moment),
                    .force = known(path.force)},
          .warning = resolved ? "" : poorly_resolved(resolution)};
}

// ---------------------------------------------------------------- errors

ExactRecord exact_of(const Oracle& oracle) {
  const std::string reason = oracle.only_normal.empty() ? "the exact solution does not say" : oracle.only_normal;
  const auto known = [&](double value) { return number_or(value, reason); };
  return {.twist_angle = known(oracle.twist_angle),
          .twist = known(oracle.state.twist),
          .moment = known(oracle.moment),
          .moment_limit = known(oracle.friction.moment_limit),
          .force = pair_or(oracle.force, reason),
          .displacement = pair_or(oracle.displacement, reason),
          .stick_radius = known(oracle.stick_radius),
          .stick_ratio = known(oracle.state.stick_ratio),
          .contact_radius = known(oracle.contact_radius),
          .semi_axes = pair_or({oracle.longer_semi_axis(), oracle.shorter_semi_axis()}, reason),
          .peak_pressure = number_or(oracle.normal.peak_pressure, kNoPeak),
          .approach = known(oracle.normal.approach),
          .dissipated = known(oracle.dissipated),
          .relative_uncertainty = oracle.relative_uncertainty};
}

ErrorsRecord errors_of(const Solution& solution, const OracleAnswer& exact) {
  if (!exact.oracle) return no_errors(exact.reason);
  const Oracle& oracle = *exact.oracle;
  const Errors errors = compare(solution, oracle);
  const std::string reason = "the exact value is zero or not known, or the result is not a number";
  const std::string& no_friction = oracle.only_normal.empty() ? reason : oracle.only_normal;
  const auto known = [&](double value) { return number_or(value, reason); };
  const auto of_friction = [&](double value) { return number_or(value, no_friction); };
  ErrorsRecord record{
      .twist = of_friction(errors.twist),
      .moment = known(errors.moment),
      .moment_limit = known(errors.moment_limit),
      .displacement = of_friction(errors.displacement),
      .stick_radius = of_friction(errors.stick_radius),
      .stick_ratio = of_friction(errors.stick_ratio),
      .stick_radius_counted = of_friction(errors.stick_radius_counted),
      .contact_radius = known(errors.contact_radius),
      .peak_pressure = number_or(errors.peak_pressure, std::isfinite(oracle.normal.peak_pressure) ? reason : kNoPeak),
      .dissipated = of_friction(errors.dissipated),
      .traction = make_traction_error(errors.traction, no_friction),
      .pressure = make_field_error(errors.pressure, reason),
      .exact = exact_of(oracle)};
  record.traction.sharpened = make_field_error(errors.sharpened, no_friction);
  record.traction.sharpened->kept = errors.kept;
  return record;
}

// ---------------------------------------------------------------- a step, a solve

WorkRecord work_of(const solver::Scene& scene, const Solution& solution) {
  return {.iterations = solution.iterations,
          .operator_applications = solution.operator_applications,
          .pressure_applications = solution.pressure_applications,
          .turns = scene.contact.coupling == solver::Coupling::full ? std::optional(solution.turns) : std::nullopt,
          .seconds = solution.seconds};
}

EndRecord end_of(const solver::Scene& scene, const Solution& solution, const OracleAnswer& exact) {
  EndRecord end{.contact = contact_of(scene, solution),
                .friction = make_friction(scene.contact.friction, solution.friction_force),
                .loads = loads_of(solution),
                .energy = energy_of(solution),
                .certificate = make_certificate(solution.certificate, kBroken),
                .resolution = resolution_of(solution.resolution),
                .errors = errors_of(solution, exact),
                .work = work_of(scene, solution)};
  end.certificate.energy = number_or(solution.certificate.energy, kBroken);
  return end;
}

RunStatus status_of(const Solution& solution) {
  return solution.status == solver::Status::converged ? RunStatus::converged : RunStatus::not_converged;
}

/// Spectra of the random surfaces, measured on the generated heights.
std::vector<solver::RoughnessSpectrum> spectra_of(const std::vector<solver::Surface>& surfaces) {
  std::vector<solver::RoughnessSpectrum> spectra;
  for (const solver::Surface& surface : surfaces) {
    if (surface.shape == solver::Shape::roughness) spectra.push_back(measure_spectrum(surface.roughness));
  }
  return spectra;
}

ProblemRecord problem_of(const solver::Scene& scene, const Solution& solution) {
  const solver::Grid& grid = solution.grid;
  return {.method = to_string(scene.solver.method),
          .op = to_string(scene.solver.op),
          .cell_traction = to_string(scene.solver.cell_traction),
          .pressure = to_string(scene.contact.pressure),
          .left_out = solution.left_out,
          .cells = {grid.n1, grid.n2},
          .cell_size = {grid.h1, grid.h2},
          .roughness = spectra_of(scene.surfaces),
          .tolerance = scene.solver.tolerance};
}

MethodRecord method_of(const Solution& solution) {
  const std::string& no_direction = solution.status == solver::Status::converged ? kNoSlip : kBroken;
  MethodRecord record{.safeguards = solution.safeguards,
                      .pressure_iterations = solution.pressure_iterations,
                      .pressure_complementarity = solution.pressure_complementarity,
                      .change = number_or(solution.change, kBrokeDown),
                      .slip_direction = {.mean = number_or(solution.slip_direction.mean, no_direction),
                                         .max = number_or(solution.slip_direction.max, no_direction)}};
  for (const solver::GridWork& work : solution.grids) {
    record.grids.push_back({.cells = {work.n1, work.n2},
                            .applications = work.applications,
                            .iterations = work.iterations,
                            .stopped_at = number_or(work.gap, kBrokeDown)});
  }
  return record;
}

/// All ranks call it at the same time.
RanksRecord ranks_of(const solver::Ranks& ranks) {
  const solver::Communicator::Sent sent = ranks.communicator().sent();
  return {.number = ranks.number(),
          .peak_bytes = ranks.of_each(static_cast<double>(peak_bytes())),
          .sent_bytes = ranks.of_each(sent.bytes),
          .sent_messages = ranks.of_each(sent.messages)};
}

/// Sums over the steps, which get the energy dissipated so far.
HistoryRecord history_of(std::vector<StepRecord> steps) {
  HistoryRecord history;
  double dissipated = 0.0;
  double worst = 0.0;
  for (StepRecord& step : steps) {
    dissipated += step.end.energy.dissipated;
    step.end.energy.dissipated_total = number_or(dissipated, kBroken);
    history.operator_applications += step.end.work.operator_applications;
    history.seconds += step.end.work.seconds.total;
    const double gap = step.end.certificate.gap;
    worst = std::max(worst, std::isnan(gap) ? INFINITY : gap);
  }
  history.dissipated = number_or(dissipated, kBroken);
  history.worst_gap = number_or(worst, kBroken);
  history.steps = std::move(steps);
  return history;
}

}  // namespace

const char* quantity_key(double solver::Quantities::*number) {
  return kQuantityKeys[static_cast<std::size_t>(std::ranges::find(solver::kQuantities, number) -
                                                solver::kQuantities.begin())];
}

SolveRecord make_record(const solver::Scene& scene, const Solution& solution, const OracleAnswer& exact,
                        std::vector<StepRecord> steps) {
  SolveRecord record{.status = status_of(solution),
                     .message = solution.message,
                     .name = scene.name,
                     .problem = problem_of(scene, solution),
                     .end = end_of(scene, solution, exact),
                     .method = method_of(solution),
                     .memory = {.solver_bytes = solution.bytes,
                                .predicted_bytes = solution.predicted_bytes,
                                .peak_bytes = peak_bytes()},
                     .provenance = provenance(solution.threads)};
  if (solution.grid.ranks.several()) record.memory.ranks = ranks_of(solution.grid.ranks);
  if (!steps.empty()) record.history = history_of(std::move(steps));
  record.warnings = doubts_about(scene, record);
  record.end.energy.dissipated_total =
      record.history ? record.history->dissipated : number_or(solution.dissipated, kBroken);
  return record;
}

StepRecord make_step(const solver::Scene& scene, const Solution& solution, const OracleAnswer& exact) {
  return {.name = solution.loads.name,
          .cycle = solution.cycle,
          .status = status_of(solution),
          .message = solution.message,
          .end = end_of(scene, solution, exact)};
}

SolveRecord make_incomplete(const std::string& scene_name, const std::string& why, std::vector<StepRecord> steps) {
  SolveRecord record;
  record.message = why;
  record.name = scene_name;
  record.history = history_of(std::move(steps));
  return record;
}

bool has_history(const solver::Scene& scene) { return scene.steps.size() > 1 || scene.cycles > 1; }

FrictionRecord make_friction(const solver::FrictionLaw& law, double force) {
  using enum solver::FrictionKind;
  const bool has_strength = law.kind == tresca || law.kind == capped;
  FrictionRecord record{.coefficient = {law.coefficient},
                        .law = law.is_coulomb() ? "" : to_string(law.kind),
                        .shear_strength = has_strength ? std::optional(law.shear_strength) : std::nullopt,
                        .exponent = law.kind == power ? std::optional(law.exponent) : std::nullopt,
                        .map = law.map.string(),
                        .force = number_or(force, kBrokeDown)};
  if (law.kind == tresca) {
    record.coefficient = {.why_missing = "Tresca's law has a shear strength, no coefficient"};
  }
  return record;
}

CertificateRecord make_certificate(const solver::Certificate& certificate, const std::string& reason) {
  return {.gap = number_or(certificate.gap, reason),
          .energy_error = number_or(certificate.energy_error, reason),
          .rounding = number_or(certificate.rounding, reason),
          .moment = number_or(certificate.moment, reason),
          .force = number_or(certificate.force, reason),
          .friction_bound = number_or(certificate.friction_bound, reason)};
}

ErrorsRecord no_errors(const std::string& reason) {
  ErrorsRecord errors;
  for (Number* const number : {&errors.twist, &errors.moment, &errors.stick_radius}) {
    number->why_missing = reason;
  }
  return errors;
}

FieldErrorRecord make_field_error(const FieldError& error, const std::string& reason) {
  return {.l1 = number_or(error.l1, reason), .l2 = number_or(error.l2, reason), .max = number_or(error.max, reason)};
}

TractionErrorRecord make_traction_error(const TractionError& error, const std::string& reason) {
  return {.at_centres = make_field_error(error.at_centres, reason),
          .averaged = make_field_error(error.averaged, reason),
          .stick_edge = make_field_error(error.stick_edge, reason),
          .contact_edge = make_field_error(error.contact_edge, reason),
          .inside = make_field_error(error.inside, reason),
          .outside = make_field_error(error.outside, reason)};
}

std::size_t peak_bytes() {
  // Of this program: after a fork, ru_maxrss also holds the peak of the process that started it.
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    std::size_t kibibytes = 0;
    if (word == "VmHWM:" && status >> kibibytes) return kibibytes * 1024;
  }
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

}  // namespace slipstick::convergence
