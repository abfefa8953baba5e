#include "convergence/results/exact_result.hpp"

#include <fmt/core.h>

#include <cmath>
#include <memory>

#include "convergence/results/make_record.hpp"
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
  if (scene.contact.coupling == solver::Coupling::none) {
    left_out.push_back({"K13, K23", "contact.coupling = \"none\""});
  }
  return left_out;
}

Oracle find_required_oracle(const solver::Scene& scene) {
  ExactHistory history = exact_history(scene);
  const std::string file = scene.source.string();
  OracleAnswer exact;
  const std::size_t steps = scene.steps.size() * static_cast<std::size_t>(scene.cycles);
  for (std::size_t k = 0; k < steps; ++k) {
    const solver::Step step = solver::step_of(scene, k);
    exact = history.advance(step);
    if (exact.oracle && exact.oracle->only_normal.empty()) continue;
    if (exact.out_of_range) {
      throw solver::InputError(file, fmt::format("{}: {}", load_text(step), exact.reason));
    }
    throw solver::InputError(file, "solver.model", "\"exact\"",
                             fmt::format("auto, full ({})", exact.oracle ? exact.oracle->only_normal : exact.reason));
  }
  return *exact.oracle;
}

}  // namespace

Oracle require_oracle(const solver::Scene& scene) {
  return solver::within_double(scene, [&] { return find_required_oracle(scene); });
}

SolveRecord exact_record(const solver::Scene& scene, const Oracle& oracle, double seconds) {
  const auto known = [](double value) { return number_or(value, "the exact solution does not say"); };
  SolveRecord record;
  record.status = RunStatus::converged;
  record.name = scene.name;
  record.problem = {.method = "exact", .profile = oracle.normal.profile->name(), .left_out = omissions(scene)};
  EndRecord& end = record.end;
  end.contact = {.contact_radius = known(oracle.contact_radius),
                 .stick_radius = known(oracle.stick_radius),
                 .stick_ratio = {oracle.state.stick_ratio},
                 .normal_load = {*scene.steps.back().normal},
                 .peak_pressure = std::isinf(oracle.normal.peak_pressure) ? Number{.why_missing = "infinite"}
                                                                          : known(oracle.normal.peak_pressure),
                 .approach = known(oracle.normal.approach)};
  end.friction = make_friction(scene.contact.friction, oracle.friction.force);
  end.loads = {.twist_angle = {oracle.twist_angle},
               .moment = {oracle.moment},
               .moment_limit = known(oracle.friction.moment_limit),
               .moment_ratio = {oracle.state.moment_ratio},
               .twist = {oracle.state.twist},
               .force = {.values = oracle.force},
               .displacement = {.values = oracle.displacement}};
  end.energy.dissipated = known(oracle.dissipated);
  end.errors = no_errors("this is the exact answer");
  end.work.seconds.total = seconds;
  record.memory.peak_bytes = peak_bytes();
  record.provenance = provenance(1);
  record.warnings = doubts_about(scene, record);
  return record;
}

}  // namespace slipstick::convergence
