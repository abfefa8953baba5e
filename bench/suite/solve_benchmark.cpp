// Whole solves of the paper's scene, beside the errors that they buy: by each method; and in turn with
// another way to the same answer, time over time (nothing left out of the model, double precision, another
// tolerance, four bare padded transforms).

#include <cmath>
#include <string>

#include "bench/suite/checked_solve.hpp"
#include "bench/suite/suite.hpp"
#include "bench/timing/four_transforms.hpp"
#include "bench/timing/side_by_side.hpp"

namespace slipstick::bench {
namespace {

using solver::Index;
using solver::Method;
using solver::Scene;

/// Cells along a side, and the moment in thousandths of its limit.
struct Load {
  Index cells;
  int permille;

  Scene scene() const { return paper_scene(cells, 1e-3 * permille); }
  std::string name() const {
    return "/cells:" + std::to_string(cells) + "/permille:" + std::to_string(permille);
  }
};

Scene with_symmetry(Scene scene) {
  scene.model = solver::ModelChoice::automatic;
  return scene;
}

Scene with_method(Scene scene, Method method, double tolerance) {
  scene.method = method;
  scene.tolerance = tolerance;
  return scene;
}

double seconds_of(const Scene& scene) {
  return seconds([&] { benchmark::DoNotOptimize(solver::solve(scene)); });
}

Prepared whole_solve(const Scene& scene) {
  const CheckedSolution checked = solve_and_check(scene);
  return {.counters = counters(checked),
          .invalid_reason = checked.invalid_reason,
          .timing = repeated([scene] { benchmark::DoNotOptimize(solver::solve(scene)); })};
}

Prepared over_transforms(const Load& load) {
  Prepared prepared = whole_solve(load.scene());
  if (!prepared.invalid_reason.empty()) return prepared;
  FourTransforms transforms(load.cells);
  const SideBySide times =
      side_by_side([&] { return seconds_of(load.scene()); }, [&] { return seconds(transforms); });
  prepared.counters["over_four_transforms"] = times.ratio;
  return prepared;
}

/// The errors and the work shown are those of the scene; `other` is checked as well.
Prepared over(const Scene& scene, const Scene& other) {
  Prepared prepared = whole_solve(scene);
  const CheckedSolution standard = solve_and_check(other);
  if (prepared.invalid_reason.empty()) prepared.invalid_reason = standard.invalid_reason;
  if (!prepared.invalid_reason.empty()) return prepared;
  show_ratio(prepared, side_by_side([&] { return seconds_of(scene); }, [&] { return seconds_of(other); }));
  prepared.counters["ratio_of_bytes"] = prepared.counters["bytes"] / standard.solution.bytes;
  return prepared;
}

Prepared symmetric_over_full(const Load& load) { return over(with_symmetry(load.scene()), load.scene()); }

Prepared tolerance_over_8_digits(const Load& load, int digits) {
  Scene scene = with_symmetry(load.scene());
  scene.tolerance = std::pow(10.0, -digits);
  return over(scene, with_symmetry(load.scene()));
}

/// Each method to the tolerance that scenes commonly ask of it: a gap, or the change of Eq. (26).
void add_methods(Suite& suite) {
  constexpr double kPaperTolerance = 1e-5;
  constexpr double kGap = 1e-8;
  for (const Index cells : {64, 128, 256, 512, 1024}) {
    for (const int permille : {500, 900, 990}) {
      const Load load{cells, permille};
      const auto add = [&](const std::string& method, const Scene& scene) {
        suite.add("solve/" + method + load.name(), [scene] { return whole_solve(scene); });
      };
      add("coulomb", with_symmetry(load.scene()));
      if (permille == 990 || cells > 256) continue;
      add("paper", with_method(with_symmetry(load.scene()), Method::paper, kPaperTolerance));
      add("projected_gradient", with_method(with_symmetry(load.scene()), Method::projected_gradient, kGap));
    }
  }
  for (const Index cells : {64, 128, 256, 512}) {
    const Load load{cells, 900};
    suite.add("solve/coulomb_full" + load.name(), [load] { return over_transforms(load); });
  }
}

/// What is telling runs by default.
std::string prefix(const Load& load, Index telling_cells) {
  return load.cells == telling_cells && load.permille == 900 ? "" : "long/";
}

}  // namespace

void add_solve_benchmarks(Suite& suite) {
  add_methods(suite);
  for (const Index cells : {128, 256, 512}) {
    for (const int permille : {500, 900, 990}) {
      const Load load{cells, permille};
      suite.add(prefix(load, 256) + "paired/symmetric_over_full" + load.name(),
                [load] { return symmetric_over_full(load); });
    }
  }
  for (const int digits : {4, 6, 10, 12}) {
    const Load load{256, 900};
    suite.add("paired/tolerance_over_8_digits" + load.name() + "/digits:" + std::to_string(digits),
              [load, digits] { return tolerance_over_8_digits(load, digits); });
  }
}

}  // namespace slipstick::bench
