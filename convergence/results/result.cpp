#include "convergence/results/result.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "convergence/oracle/errors.hpp"
#include "convergence/results/provenance.hpp"
#include "solver/mpi/communicator.hpp"
#include "solver/scene/roughness.hpp"

namespace slipstick::convergence {
namespace {

using solver::Solution;

Json safeguards_json(const solver::Safeguards& safeguards) {
  Json json{{"second_solves", safeguards.second_solves},
            {"halvings", safeguards.halvings},
            {"gradient_steps", safeguards.gradient_steps},
            {"breakdowns", safeguards.breakdowns}};
  if (!safeguards.breakdown.empty()) json["breakdown"] = safeguards.breakdown;
  return json;
}

/// The work on each grid, coarsest first.
Json grids_json(const std::vector<solver::GridWork>& grids) {
  Json rows = Json::array();
  for (const auto& [n1, n2, applications, iterations, gap] : grids) {
    rows.push_back({{"cells", {n1, n2}}, {"applications", applications}, {"iterations", iterations}});
    set_number(rows.back(), "stopped_at", gap, "the solve broke down");
  }
  return rows;
}

/// The largest memory and what was sent, rank by rank: all ranks ask at the same time.
Json ranks_json(const solver::Ranks& ranks) {
  const solver::Communicator::Sent sent = ranks.communicator().sent();
  const std::vector<double> peaks = ranks.of_each(static_cast<double>(peak_bytes()));
  return {{"number", ranks.number()},
          {"peak_bytes", peaks},
          {"sent_bytes", ranks.of_each(sent.bytes)},
          {"sent_messages", ranks.of_each(sent.messages)}};
}

const std::string kNoPeak = "the exact pressure has no finite peak";

void set_pair(Json& json, const std::string& key, const std::array<double, 2>& pair,
              const std::string& reason) {
  if (std::isfinite(pair[0]) && std::isfinite(pair[1])) {
    json[key] = pair;
  } else {
    set_missing(json, key, reason);
  }
}

Json exact_json(const Oracle& oracle) {
  Json json;
  const std::string unknown =
      oracle.only_normal.empty() ? "the exact solution does not say" : oracle.only_normal;
  set_number(json, "twist_angle", oracle.twist_angle, unknown);
  set_number(json, "twist", oracle.state.twist, unknown);
  set_number(json, "moment", oracle.moment, unknown);
  set_number(json, "moment_limit", oracle.moment_limit, unknown);
  set_pair(json, "force", oracle.force, unknown);
  set_pair(json, "displacement", oracle.displacement, unknown);
  set_number(json, "stick_radius", oracle.stick_radius, unknown);
  set_number(json, "stick_ratio", oracle.state.stick_ratio, unknown);
  set_number(json, "contact_radius", oracle.contact_radius, unknown);
  set_pair(json, "semi_axes", {oracle.longer_semi_axis(), oracle.shorter_semi_axis()}, unknown);
  set_number(json, "peak_pressure", oracle.peak_pressure, kNoPeak);
  set_number(json, "approach", oracle.approach, unknown);
  set_number(json, "dissipated", oracle.dissipated, unknown);
  json["relative_uncertainty"] = oracle.relative_uncertainty;
  return json;
}

void add_errors(Json& json, const Solution& solution, const OracleAnswer& exact) {
  if (!exact.oracle) {
    for (const char* key : {"twist_error", "moment_error", "stick_radius_error", "traction_error"}) {
      set_number(json, key, NAN, exact.reason);
    }
    return;
  }
  const Oracle& oracle = *exact.oracle;
  const Errors errors = compare(solution, oracle);
  const std::string reason = "the exact value is zero or not known, or the result is not a number";
  const std::string& of_friction = oracle.only_normal.empty() ? reason : oracle.only_normal;
  set_number(json, "twist_error", errors.twist, of_friction);
  set_number(json, "moment_error", errors.moment, reason);
  set_number(json, "moment_limit_error", errors.moment_limit, reason);
  set_number(json, "displacement_error", errors.displacement, of_friction);
  set_number(json, "stick_radius_error", errors.stick_radius, of_friction);
  set_number(json, "stick_ratio_error", errors.stick_ratio, of_friction);
  set_number(json, "stick_radius_counted_error", errors.stick_radius_counted, of_friction);
  set_number(json, "contact_radius_error", errors.contact_radius, reason);
  set_number(json, "peak_pressure_error", errors.peak_pressure,
             std::isfinite(oracle.peak_pressure) ? reason : kNoPeak);
  set_number(json, "dissipated_error", errors.dissipated, of_friction);
  json["traction_error"] = traction_error_json(errors.traction, of_friction);
  json["traction_error"]["sharpened"] = field_error_json(errors.sharpened, of_friction);
  if (!errors.kept.empty()) json["traction_error"]["sharpened"]["kept"] = errors.kept;
  json["pressure_error"] = field_error_json(errors.pressure, reason);
  json["exact"] = exact_json(oracle);
}

const std::string kBroken = "the solve broke down, or there is no friction";

/// How far the loads are from what the contact can carry, and how it would slide.
Json limit_json(const solver::LimitLoad& limit) {
  Json json;
  set_number(json, "factor", limit.factor, std::isnan(limit.factor) ? kBroken : "no load is imposed");
  if (!std::isfinite(limit.factor)) return json;
  if (limit.centre) {
    json["centre"] = *limit.centre;
  } else {
    const double size = std::hypot(limit.sliding.delta1, limit.sliding.delta2);
    json["direction"] = {limit.sliding.delta1 / size, limit.sliding.delta2 / size};
  }
  return json;
}

Json area_json(const solver::CountedArea& area) {
  return {{"counted", area.counted}, {"corrected", area.corrected}, {"uncertainty", area.uncertainty}};
}

/// A twist is taken for a mistake above 15 times the elastic twist, where the moment is within 1e-4 of its
/// limit. No contact out of 120 that were twisted to 0.02 to 0.999 of the limit was there.
constexpr double kFarBeyondElastic = 15.0;
constexpr double kNextToLimit = 1e-4;

/// A twist that was hardly meant in rad. While nothing slips, twist times moment is twice the elastic energy.
void add_load_warning(Json& json, const Solution& solution) {
  const auto imposed = solver::value_if<solver::Twist>(solution.loads.torsion);
  const double a = solution.contact_radius;
  const double normalised = solution.shear_modulus * a * a / solution.friction_force;
  const double times = std::abs(solution.twist_angle * solution.moment) / (2.0 * solution.elastic_energy);
  const bool slides = std::abs(solution.moment) > (1.0 - kNextToLimit) * solution.moment_limit;
  if (!imposed || !slides || !(times > kFarBeyondElastic)) return;
  json["load_warning"] = fmt::format(
      "all slides: the imposed twist of {:.6g} rad is {:.3g} times the one that the bodies take up by "
      "deforming; {}.twist is in rad, while a result's twist is G a^2 phi/(mu W), of which {:.6g} is {:.6g} "
      "rad",
      *imposed, times, solution.loads.key, *imposed, *imposed / normalised);
}

/// The contact's state: what every step of a history has.
void add_state(Json& json, const solver::Scene& scene, const Solution& solution) {
  const double a = solution.contact_radius;
  json["contact_cells"] = solution.contact_cells;
  json["stick_cells"] = solution.stick_cells;
  json["contact_area"] = area_json(solution.contact_area);
  json["stick_area"] = area_json(solution.stick_area);
  json["contact_radius"] = a;
  json["contact_radius_counted"] = solution.contact_radius_counted;
  set_number(json, "stick_radius", solution.stick_radius, "the solve broke down");
  if (!solution.stick_radius_note.empty()) json["stick_radius_note"] = solution.stick_radius_note;
  json["stick_radius_counted"] = solution.stick_radius_counted;
  set_number(json, "stick_ratio", solution.stick_radius / a, "no contact");
  add_friction(json, scene.friction, solution.friction_force);
  json["normal_load"] = solution.normal_load;
  json["peak_pressure"] = solution.peak_pressure;
  if (scene.pressure == solver::PressureModel::solved) {
    json["approach"] = solution.approach;
  } else {
    set_number(json, "approach", NAN, "the normal contact was not solved");
  }
  set_number(json, "twist_angle", solution.twist_angle, "the solve broke down");
  set_number(json, "moment", solution.moment, "the solve broke down");
  json["moment_limit"] = solution.moment_limit;
  set_number(json, "moment_ratio", solution.moment / solution.moment_limit,
             solution.moment_limit > 0.0 ? "the solve broke down" : "the limit moment is zero");
  set_number(json, "twist", solution.shear_modulus * a * a * solution.twist_angle / solution.friction_force,
             "without friction the normalised twist has no scale");
  add_load_warning(json, solution);
  set_pair(json, "force", solution.force, "the solve broke down");
  set_pair(json, "displacement", solution.displacement, "the solve broke down");
  json["limit"] = limit_json(solution.limit);
  set_number(json, "elastic_energy", solution.elastic_energy, "the solve broke down");
  set_number(json, "dissipated", solution.dissipated, "the solve broke down");
  set_number(json, "work", solution.work, "the solve broke down");
}

void add_counts(Json& json, const solver::Scene& scene, const Solution& solution) {
  json["iterations"] = solution.iterations;
  json["operator_applications"] = solution.operator_applications;
  json["pressure_applications"] = solution.pressure_applications;
  if (scene.coupling == solver::Coupling::full) json["turns"] = solution.turns;
}

void add_seconds(Json& json, const solver::Seconds& seconds) {
  json["seconds"] = {{"setup", seconds.setup},
                     {"pressure", seconds.pressure},
                     {"traction", seconds.traction},
                     {"total", seconds.total}};
}

void add_status(Json& json, const Solution& solution) {
  json["status"] = solution.status == solver::Status::converged ? "converged" : "not_converged";
  if (!solution.message.empty()) json["message"] = solution.message;
}

/// Spectra of the random surfaces, measured on what was generated.
void add_roughness(Json& json, const std::vector<solver::Surface>& surfaces) {
  for (const solver::Surface& surface : surfaces) {
    if (surface.shape != solver::Shape::roughness) continue;
    const solver::RoughnessSpectrum spectrum = measure_spectrum(surface.roughness);
    Json rings = Json::array();
    for (const auto& [wavelength, power] : spectrum.rings) {
      rings.push_back({{"wavelength", wavelength}, {"power", power}});
    }
    json["roughness"].push_back({{"rms_height", spectrum.rms_height},
                                 {"rms_slope", spectrum.rms_slope},
                                 {"hurst", spectrum.hurst},
                                 {"spectrum", rings}});
  }
}

}  // namespace

Json step_result(const solver::Scene& scene, const Solution& solution, const OracleAnswer& exact) {
  Json json;
  json["name"] = solution.loads.name;
  json["cycle"] = solution.cycle;
  add_status(json, solution);
  add_state(json, scene, solution);
  add_counts(json, scene, solution);
  json["certificate"] = certificate_json(solution.certificate, kBroken);
  set_number(json["certificate"], "energy", solution.certificate.energy, kBroken);
  json["resolved"] = resolution_json(solution.resolution);
  add_errors(json, solution, exact);
  add_seconds(json, solution.seconds);
  return json;
}

Json solve_result(const solver::Scene& scene, const Solution& solution, const OracleAnswer& exact) {
  const solver::Grid& grid = solution.grid;
  Json json;
  json["name"] = scene.name;
  add_status(json, solution);
  json["method"] = to_string(scene.method);
  json["operator"] = to_string(scene.op);
  json["cell_traction"] = to_string(scene.cell_traction);
  json["pressure"] = to_string(scene.pressure);
  json["model"] = model_json(solution.left_out);
  json["cells"] = {grid.n1, grid.n2};
  json["cell_size"] = {grid.h1, grid.h2};
  add_roughness(json, scene.surfaces);
  add_state(json, scene, solution);
  add_counts(json, scene, solution);
  json["grids"] = grids_json(solution.grids);
  json["safeguards"] = safeguards_json(solution.safeguards);
  json["pressure_iterations"] = solution.pressure_iterations;
  json["pressure_complementarity"] = solution.pressure_complementarity;
  json["tolerance"] = scene.tolerance;
  set_number(json, "change", solution.change, "the solve broke down");
  json["certificate"] = certificate_json(solution.certificate, kBroken);
  set_number(json["certificate"], "energy", solution.certificate.energy, kBroken);
  json["resolved"] = resolution_json(solution.resolution);
  const std::string& no_direction = solution.status == solver::Status::converged ? kNoSlip : kBroken;
  set_number(json["slip_direction"], "mean", solution.slip_direction.mean, no_direction);
  set_number(json["slip_direction"], "max", solution.slip_direction.max, no_direction);
  add_errors(json, solution, exact);
  if (!has_history(scene)) set_number(json, "dissipated_total", solution.dissipated, kBroken);
  add_seconds(json, solution.seconds);
  json["solver_bytes"] = solution.bytes;
  json["predicted_bytes"] = solution.predicted_bytes;
  json["peak_bytes"] = peak_bytes();
  json["provenance"] = provenance(solution.threads);
  if (grid.ranks.several()) json["ranks"] = ranks_json(grid.ranks);
  return json;
}

bool has_history(const solver::Scene& scene) { return scene.steps.size() > 1 || scene.cycles > 1; }

void add_steps(Json& result, Json steps) {
  double dissipated = 0.0;
  double applications = 0.0;
  double seconds = 0.0;
  double worst = 0.0;
  for (Json& step : steps) {
    dissipated += step["dissipated"].is_number() ? step["dissipated"].get<double>() : NAN;
    set_number(step, "dissipated_total", dissipated, kBroken);
    applications += step["operator_applications"].get<double>();
    seconds += step["seconds"]["total"].get<double>();
    const Json& gap = step["certificate"]["gap"];
    worst = std::max(worst, gap.is_number() ? gap.get<double>() : INFINITY);
  }
  Json& history = result["history"];
  history["steps"] = steps.size();
  set_number(history, "dissipated", dissipated, kBroken);
  set_number(history, "worst_gap", worst, kBroken);
  history["operator_applications"] = applications;
  history["seconds"] = seconds;
  if (result.contains("dissipated")) set_number(result, "dissipated_total", dissipated, kBroken);
  result["steps"] = std::move(steps);
}

}  // namespace slipstick::convergence
