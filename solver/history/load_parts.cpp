#include "solver/history/load_parts.hpp"

#include <type_traits>

namespace slipstick::solver {
namespace {

double between(double from, double to, double part) { return from + part * (to - from); }

/// The load that the contact carries, or its twist, as a load of this kind.
TorsionLoad as_load(const TorsionLoad& kind, const StepEnd& at) {
  if (std::holds_alternative<Twist>(kind)) return Twist{at.twist};
  if (std::holds_alternative<Moment>(kind)) return Moment{at.moment};
  return MomentRatio{at.moment_limit > 0.0 ? at.moment / at.moment_limit : 0.0};
}

/// The step with its tangential loads interpolated: `part` of the way from those before.
Step interpolate_loads(const Step& step, const StepEnd& before, double part) {
  Step at = step;
  at.torsion = std::visit(
      [&](const auto& to) -> TorsionLoad {
        using Kind = std::remove_cvref_t<decltype(to)>;
        return Kind{between(std::get<Kind>(as_load(step.torsion, before)).value, to.value, part)};
      },
      step.torsion);
  for (std::size_t i = 0; i < 2; ++i) {
    if (step.displacement) {
      (*at.displacement)[i] = between(before.displacement[i], (*step.displacement)[i], part);
    } else {
      at.force[i] = between(before.force[i], step.force[i], part);
    }
  }
  return at;
}

}  // namespace

std::vector<Step> parts_of(const Scene& scene, const Step& step, const Step* previous,
                           const StepEnd& before) {
  const int parts = scene.solver.substeps;
  const bool presses = previous != nullptr && previous->normal && previous->normal != step.normal;
  const int pressing = presses ? parts / 2 : 0;
  std::vector<Step> loads;
  for (int k = 1; k <= pressing; ++k) {
    loads.push_back(interpolate_loads(step, before, 0.0));
    loads.back().normal = between(*previous->normal, *step.normal, static_cast<double>(k) / pressing);
  }
  for (int k = pressing + 1; k < parts; ++k) {
    loads.push_back(interpolate_loads(step, before, static_cast<double>(k - pressing) / (parts - pressing)));
  }
  loads.push_back(step);
  return loads;
}

}  // namespace slipstick::solver
