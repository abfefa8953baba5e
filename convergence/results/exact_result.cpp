#include "convergence/results/exact_result.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "convergence/results/provenance.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/within_double.hpp"

namespace slipstick::convergence {
namespace {

/// The load, as the scene names it.
std::string load_text(const solver::Step& step) {
  const solver::TorsionLoad& load = step.torsion;
  if (step.force != std::array<double, 2>{}) {
    return fmt::format("{}.force = [{}, {}] N", step.key, step.force[0], step.force[1]);
  }
  if (const auto moment = solver::value_if<solver::Moment>(load)) {
    return fmt::format("{}.moment = {} N m", step.key, *moment);
  }
  if (const auto twist = solver::value_if<solver::Twist>(load)) {
    return fmt::format("{}.twist = {} rad", step.key, *twist);
  }
  return fmt::format("{}.moment_ratio = {}", step.key, std::get<solver::MomentRatio>(load).value);
}

/// The pressure's tangential displacement of dissimilar materials would change the answer; the scene may ask
/// that it be left out.
std::vector<solver::Omission> omissions(const solver::Scene& scene) {
  std::vector<solver::Omission> left_out = scene.left_out;
  left_out.push_back({"the grid", "the scene is axisymmetric: the exact solution answers"});
  if (scene.coupling == solver::Coupling::none) {
    left_out.push_back({"K13, K23", "contact.coupling = \"none\""});
  }
  return left_out;
}

/// Null under each of these keys, for one reason.
void set_all_missing(Json& json, const std::vector<std::string>& keys, const std::string& reason) {
  for (const std::string& key : keys) set_missing(json, key, reason);
}

Oracle find_required_oracle(const solver::Scene& scene) {
  const std::unique_ptr<ExactHistory> history = exact_history(scene);
  const std::string file = scene.source.string();
  OracleAnswer exact;
  const std::size_t steps = scene.steps.size() * static_cast<std::size_t>(scene.cycles);
  for (std::size_t k = 0; k < steps; ++k) {
    const solver::Step step = solver::step_of(scene, k);
    exact = history->advance(step);
    if (exact.oracle && exact.oracle->only_normal.empty()) continue;
    if (exact.out_of_range) {
      throw solver::InputError(file, fmt::format("{}: {}", load_text(step), exact.reason));
    }
    throw solver::InputError(
        file, "solver.model", "\"exact\"",
        fmt::format("auto, full ({})", exact.oracle ? exact.oracle->only_normal : exact.reason));
  }
  return *exact.oracle;
}

}  // namespace

Oracle require_oracle(const solver::Scene& scene) {
  return solver::within_double(scene, [&] { return find_required_oracle(scene); });
}

Json exact_result(const solver::Scene& scene, const Oracle& oracle, double seconds) {
  Json json;
  json["name"] = scene.name;
  json["status"] = "converged";
  json["method"] = "exact";
  json["profile"] = oracle.profile->name();
  json["model"] = model_json(omissions(scene));
  set_all_missing(
      json, {"operator", "cells", "cell_size", "contact_cells", "stick_cells", "contact_area", "stick_area"},
      "the exact solution needs no grid");
  const std::string unknown = "the exact solution does not say";
  set_number(json, "contact_radius", oracle.contact_radius, unknown);
  set_number(json, "stick_radius", oracle.stick_radius, unknown);
  set_all_missing(json, {"contact_radius_counted", "stick_radius_counted"}, "there are no cells to count");
  json["stick_ratio"] = oracle.state.stick_ratio;
  add_friction(json, scene.friction, oracle.friction_force);
  json["normal_load"] = *scene.steps.back().normal;
  set_number(json, "peak_pressure", oracle.peak_pressure,
             std::isinf(oracle.peak_pressure) ? "infinite" : unknown);
  set_number(json, "approach", oracle.approach, unknown);
  json["twist_angle"] = oracle.twist_angle;
  json["moment"] = oracle.moment;
  set_number(json, "moment_limit", oracle.moment_limit, unknown);
  json["moment_ratio"] = oracle.state.moment_ratio;
  json["twist"] = oracle.state.twist;
  json["force"] = oracle.force;
  json["displacement"] = oracle.displacement;
  set_number(json, "dissipated", oracle.dissipated, unknown);
  json["iterations"] = 0;
  json["operator_applications"] = 0;
  set_all_missing(json, {"certificate", "slip_direction"},
                  "nothing to certify: the exact solution meets Coulomb's law everywhere");
  set_all_missing(json, {"twist_error", "moment_error", "stick_radius_error", "traction_error"},
                  "this is the exact answer");
  json["seconds"] = {{"total", seconds}};
  json["peak_bytes"] = peak_bytes();
  json["provenance"] = provenance(1);
  return json;
}

}  // namespace slipstick::convergence
