#include "convergence/results/result.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>
#include <utility>

#include "convergence/oracle/errors.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/grid/communicator.hpp"
#include "solver/input/field_file.hpp"
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

/// What each rank held at most and what it has sent: all ranks ask at the same time.
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
  json["pressure_error"] = field_error_json(errors.pressure, reason);
  json["exact"] = exact_json(oracle);
}

const std::string kBroken = "the solve broke down, or there is no friction";
/// Of two sums over the same cells.
constexpr double kRounding = 1e-12;
const std::string kNoSlip = "nothing slips";

/// How far the loads are from what the contact can carry, and how it would slide.
Json limit_json(const solver::LimitLoad& limit) {
  Json json;
  set_number(json, "factor", limit.factor, "no load is imposed");
  if (!std::isfinite(limit.factor)) return json;
  if (limit.centre) {
    json["centre"] = *limit.centre;
  } else {
    const double size = std::hypot(limit.sliding.delta1, limit.sliding.delta2);
    json["direction"] = {limit.sliding.delta1 / size, limit.sliding.delta2 / size};
  }
  return json;
}

/// The contact's state: what every step of a history has.
void add_state(Json& json, const solver::Scene& scene, const Solution& solution) {
  const double a = solution.contact_radius;
  json["contact_cells"] = solution.contact_cells;
  json["stick_cells"] = solution.stick_cells;
  json["contact_radius"] = a;
  json["contact_radius_counted"] = solution.contact_radius_counted;
  set_number(json, "stick_radius", solution.stick_radius, "the solve broke down");
  if (!solution.stick_radius_note.empty()) json["stick_radius_note"] = solution.stick_radius_note;
  json["stick_radius_counted"] = solution.stick_radius_counted;
  set_number(json, "stick_ratio", solution.stick_radius / a, "no contact");
  json["friction"] = scene.friction;
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
  set_number(json, "moment_ratio", solution.moment / solution.moment_limit, "the limit moment is zero");
  set_number(json, "twist",
             solution.shear_modulus * a * a * solution.twist_angle / (scene.friction * solution.normal_load),
             "without friction the normalised twist has no scale");
  json["force"] = solution.force;
  json["displacement"] = solution.displacement;
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
  for (const Json& step : steps) {
    dissipated += step["dissipated"].is_number() ? step["dissipated"].get<double>() : NAN;
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
  result["steps"] = std::move(steps);
}

namespace {

/// A line a step, of long histories the last ones.
std::string steps_text(const Json& r) {
  constexpr std::size_t most = 24;
  const Json& steps = r["steps"];
  std::string text = fmt::format("  {:<16} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11}  {}\n", "step", "W (N)",
                                 "M (N m)", "|F| (N)", "twist (rad)", "|delta| (m)", "lost (J)", "gap");
  const std::size_t first = steps.size() > most ? steps.size() - most : 0;
  if (first > 0) text += fmt::format("  ({} steps before)\n", first);
  const auto size = [](const Json& pair) { return std::hypot(pair[0].get<double>(), pair[1].get<double>()); };
  for (std::size_t i = first; i < steps.size(); ++i) {
    const Json& step = steps[i];
    text += fmt::format("  {:<16} {:>11} {:>11} {:>11.4g} {:>11} {:>11.4g} {:>11}  {}\n",
                        step["name"].get<std::string>(), short_text(step["normal_load"]),
                        short_text(step["moment"]), size(step["force"]), short_text(step["twist_angle"]),
                        size(step["displacement"]), short_text(step["dissipated"]),
                        short_text(step["certificate"]["gap"]));
  }
  return text + text_line("history", fmt::format("{} steps, {} J lost, gap/energy at most {}, {} operator "
                                                 "applications, {} s",
                                                 steps.size(), number_text(r["history"]["dissipated"]),
                                                 number_text(r["history"]["worst_gap"]),
                                                 number_text(r["history"]["operator_applications"]),
                                                 number_text(r["history"]["seconds"])));
}

/// What the loads could rise to, and how the body would slide then.
std::string limit_text(const Json& r) {
  const Json& limit = r["limit"];
  if (!limit["factor"].is_number()) return "";
  const bool turns = limit.contains("centre");
  const Json& pair = limit[turns ? "centre" : "direction"];
  return text_line("limit", fmt::format("{} times these loads; it would slide {} ({}, {}){}",
                                        number_text(limit["factor"]), turns ? "turning about" : "along",
                                        short_text(pair[0]), short_text(pair[1]), turns ? " m" : ""));
}

/// What fields are off by, or why that is not known.
std::string exact_answer_text(const Json& r) {
  const Json& error = r["traction_error"];
  if (!error.is_object()) {
    return text_line("exact answer", "none: " + r["traction_error_reason"].get<std::string>());
  }
  if (error["l1"].is_number()) {
    return text_line("traction error", fmt::format("{} in L1, {} in L2 (relative)", number_text(error["l1"]),
                                                   number_text(error["l2"])));
  }
  if (r["exact"]["stick_ratio"].is_number()) return "";
  return text_line("exact answer", r["exact"]["stick_ratio_reason"].get<std::string>()) +
         text_line("pressure error",
                   fmt::format("{} in L1, {} in L2 (relative)", number_text(r["pressure_error"]["l1"]),
                               number_text(r["pressure_error"]["l2"])));
}

/// How pressure and shear were brought together.
std::string coupling_text(const Json& r) {
  if (!r.contains("turns")) return "";
  return text_line("full coupling",
                   fmt::format("{} turns of pressure and shear, complementarity gap {}",
                               r["turns"].get<int>(), number_text(r["pressure_complementarity"])));
}

std::string words_of(const Json& resolved) {
  const std::string number = resolved["number"];
  return number == "twist_angle" ? "twist" : number;
}

std::string unit_of(const Json& resolved) {
  const std::string number = resolved["number"];
  return number == "twist_angle" ? "rad" : number == "displacement" ? "m" : number == "moment" ? "N m" : "N";
}

/// What the mesh resolves, and how far the answer may be off.
std::string resolution_text(const Json& r) {
  const Json& resolved = r["resolved"];
  const bool open = resolved["absolute"] != 0.0;
  std::string text =
      text_line("resolved",
                fmt::format("stick area {:.3g} cells wide, slip area {:.3g}",
                            resolved["stick_width"].get<double>(), resolved["slip_width"].get<double>())) +
      text_line("uncertain", open ? fmt::format("{} by {} {} ({}): mesh {}, length of steps {}",
                                                words_of(resolved), short_text(resolved["absolute"]),
                                                unit_of(resolved), percent_text(resolved["uncertainty"]),
                                                short_text(resolved["mesh"]), short_text(resolved["path"]))
                                  : "by about " + percent_text(resolved["uncertainty"]));
  if (!resolved.contains("warning")) return text;
  return text + text_line("warning", resolved["warning"].get<std::string>());
}

/// How far rounding let the certificate go, where that is not as far as the tolerance.
std::string energy_text(const Json& r) {
  const Json& gap = r["certificate"]["gap"];
  const Json& energy = r["certificate"]["energy"];
  const Json& held = r["elastic_energy"];
  if (energy.is_number() && held.is_number() && energy > (1.0 + kRounding) * held.get<double>()) {
    return text_line("", fmt::format("over {} J, which a state before held: an error is absolute, and these "
                                     "tractions hold {} J",
                                     number_text(energy), number_text(held)));
  }
  if (r["status"] != "converged" || r["method"] == "paper" || !gap.is_number() || gap <= r["tolerance"])
    return "";
  return text_line("", fmt::format("rounding hides the rest of the gap; the energy is within {} of the least",
                                   number_text(r["certificate"]["energy_error"])));
}

}  // namespace

std::string solve_text(const Json& r) {
  std::string text =
      fmt::format("{}: {} x {} cells, pressure {}, operator {}, method {}\n", r["name"].get<std::string>(),
                  r["cells"][0].get<int>(), r["cells"][1].get<int>(), r["pressure"].get<std::string>(),
                  r["operator"].get<std::string>(), r["method"].get<std::string>());
  text += status_text(r) + state_text(r) + limit_text(r) + coupling_text(r);
  text += exact_answer_text(r);
  text += text_line("certificate",
                    fmt::format("gap/energy {}, moment off by {}, |q| above mu p by {}",
                                number_text(r["certificate"]["gap"]), number_text(r["certificate"]["moment"]),
                                number_text(r["certificate"]["friction_bound"])));
  text += energy_text(r);
  const Json& direction = r["slip_direction"];
  text += text_line("slip direction",
                    direction.value("mean_reason", "") == kNoSlip
                        ? kNoSlip
                        : fmt::format("{} degrees off in the mean, {} at most (Coulomb: 0)",
                                      number_text(direction["mean"]), number_text(direction["max"])));
  text += resolution_text(r);
  text += model_text(r);
  return r.contains("steps") ? text + steps_text(r) : text;
}

std::vector<solver::FieldColumn> solution_columns(const Solution& solution, const OracleAnswer& exact) {
  using solver::Index;
  const solver::Grid grid = solution.grid;
  const Index cells = grid.cells();
  std::vector<solver::FieldColumn> columns;
  const auto add = [&](const char* name, const auto& value) {
    columns.push_back({name, [value](Index first, Index last, double* values) {
                         for (Index cell = first; cell < last; ++cell) *values++ = value(cell);
                       }});
  };
  const auto add_kept = [&](const char* name, const Eigen::ArrayXd& field, Index start) {
    add(name, [&field, start](Index cell) { return field[start + cell]; });
  };
  add("x1", [grid](Index cell) { return grid.x1(cell / grid.n2); });
  add("x2", [grid](Index cell) { return grid.x2(cell % grid.n2); });
  add_kept("pressure", solution.pressure, 0);
  add_kept("q1", solution.traction, 0);
  add_kept("q2", solution.traction, cells);
  add_kept("slip1", solution.slip, 0);
  add_kept("slip2", solution.slip, cells);
  add_kept("stick", solution.stick, 0);
  add("dissipated", [&solution, cells](Index cell) {
    const double s1 = solution.slip[cell];
    const double s2 = solution.slip[cell + cells];
    return solution.friction * solution.pressure[cell] * std::sqrt(s1 * s1 + s2 * s2);
  });
  if (exact.oracle && exact.oracle->shear) {
    const auto fields = std::make_shared<const ExactFields>(exact_fields(*exact.oracle, grid));
    add("q1_exact", [fields](Index cell) { return fields->traction[cell]; });
    add("q2_exact", [fields, cells](Index cell) { return fields->traction[cells + cell]; });
  }
  return columns;
}

void write_solution_fields(const std::filesystem::path& file, const Solution& solution,
                           const OracleAnswer& exact) {
  solver::write_fields(file, solution.grid, solution_columns(solution, exact), solution.pressure);
}

Json profile_json(const solver::Solution& solution, const OracleAnswer& answer) {
  if (!answer.oracle || !answer.oracle->shear) return Json::array();
  const Oracle& oracle = *answer.oracle;
  const ExactFields exact = exact_fields(oracle, solution.grid);
  const double unit = 1.0 / (oracle.friction * oracle.reference_pressure);
  const Eigen::ArrayXd value = unit * solver::norms(solution.traction);
  const Eigen::ArrayXd exact_value = unit * solver::norms(exact.traction);
  const solver::Grid& grid = solution.grid;
  Json rows = Json::array();
  const auto add = [&](solver::Index i, solver::Index j) {
    const solver::Index cell = i * grid.n2 + j;
    const double radius = std::hypot(grid.x1(i), grid.x2(j)) / oracle.contact_radius;
    if (radius > 1.0) return;
    rows.push_back({{"radius", radius},
                    {"value", value[cell]},
                    {"exact", exact_value[cell]},
                    {"error", value[cell] - exact_value[cell]}});
  };
  for (solver::Index i = grid.n1 / 2; i < grid.n1; ++i) add(i, grid.n2 / 2);
  for (solver::Index i = grid.n1 / 2 + 1; i < grid.n1; ++i) add(i, i);
  return rows;
}

}  // namespace slipstick::convergence
