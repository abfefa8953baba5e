// Where the two sides meet: numerical answers against exact ones, along histories of loads and of one.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "analytic/tangential_history.hpp"
#include "convergence/oracle/errors.hpp"
#include "convergence/oracle/tests/histories.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

using solver::Index;
using solver::Scene;
using solver::Solution;

struct State {
  Solution solution;
  Oracle exact;
  Errors errors;
};

/// Each step with its exact answer.
std::vector<State> follow(const Scene& scene) {
  ExactHistory history = exact_history(scene);
  std::vector<State> states;
  solver::SolveOptions options;
  options.observer.step = [&](const Solution& solution) {
    EXPECT_EQ(solution.status, solver::Status::converged) << solution.message;
    const OracleAnswer answer = history.advance(solution.loads);
    if (!answer.oracle) throw std::runtime_error(answer.reason);
    states.push_back({solution, *answer.oracle, compare(solution, *answer.oracle)});
  };
  solver::solve(scene, options);
  if (states.size() != scene.steps.size()) throw std::runtime_error("the history stopped");
  return states;
}

Scene on_cells(Scene scene, Index cells) {
  scene.grid.cells = {cells, cells};
  return scene;
}

double size(const std::array<double, 2>& vector) { return std::hypot(vector[0], vector[1]); }

/// The error of the twist or the displacement, whichever the scene has.
double motion_error(const Errors& errors) {
  return std::isfinite(errors.twist) ? std::abs(errors.twist) : errors.displacement;
}
double motion(const Oracle& oracle) {
  return oracle.moment != 0.0 || oracle.twist_angle != 0.0 ? std::abs(oracle.twist_angle) : size(oracle.displacement);
}

// The promised accuracy of first loading at 128 cells, with the pressure solved on the same grid.
constexpr double kMotionAt128 = 2e-4;
constexpr double kStepTractionAt128 = 1e-2;  // L1
// Twist, displacement and energy are off by the gap of either answer, 1e-8 of its energy; tractions by its root, and in
// L2 by some six times that: waves of a cell's length are 30 to 60 times softer than the contact.
constexpr double kMotionToGap = 1e-6;
constexpr double kTractionToGap = 1e-3;

const Scene& steel() {
  static const Scene scene = example("paper");
  return scene;
}
const Scene& plain() {
  static const Scene scene = without_contraction(example("paper"));
  return scene;
}

/// Forces one after another under 1000 N.
Scene forced(const std::vector<double>& forces) {
  std::vector<Push> pushes;
  for (const double force : forces) pushes.push_back({1000.0, force});
  return pushed(plain(), pushes);
}

/// Absolute errors stay as in first loading, though the answers become smaller: residual states, loops
/// within loops.
void expect_errors_of_first_loading(const Scene& scene, double cells_to_the_radius) {
  const std::vector<State> states = follow(on_cells(scene, 128));
  EXPECT_LE(motion_error(states.front().errors), kMotionAt128);
  const double largest = motion(states.front().exact);
  const double first_lost = states.front().exact.dissipated;
  for (const auto& [solution, exact, errors] : states) {
    // Two or three branches of first loading, enlarged twice.
    EXPECT_LE(motion_error(errors) * motion(exact), 5.0 * kMotionAt128 * largest);
    EXPECT_LE(std::abs(errors.dissipated) * exact.dissipated, 5.0 * kMotionAt128 * first_lost);
    EXPECT_LE(errors.traction.at_centres.l1, kStepTractionAt128);
    EXPECT_LE(std::abs(errors.stick_radius) * exact.stick_radius, 0.5 * exact.contact_radius / cells_to_the_radius);
  }
}

TEST(HistoryComparison, SmallCyclesInALargeOne) {
  expect_errors_of_first_loading(twisted(steel(), {0.8, -0.8, 0.3, -0.2, 0.25}), 62);
  expect_errors_of_first_loading(forced({80.0, -80.0, 30.0, -20.0, 25.0}), 62);
}

/// A closed loop leaves no trace: after 0.3, -0.2 and back, the state is the one before; then on to
/// 0.8 as if there had been no loop.
TEST(HistoryComparison, AClosedLoopIsForgotten) {
  for (const Scene& scene :
       {twisted(steel(), {0.8, -0.8, 0.3, -0.2, 0.3, 0.8}), forced({80.0, -80.0, 30.0, -20.0, 30.0, 80.0})}) {
    const std::vector<State> states = follow(on_cells(scene, 64));
    for (const auto& [before, after] : {std::pair(2, 4), std::pair(0, 5)}) {
      const Solution& a = states[before].solution;
      const Solution& b = states[after].solution;
      const double scale = std::abs(states[0].solution.twist_angle) + size(states[0].solution.displacement);
      EXPECT_NEAR(b.twist_angle, a.twist_angle, kMotionToGap * scale);
      EXPECT_NEAR(b.displacement[0], a.displacement[0], kMotionToGap * scale);
      const Eigen::ArrayXd& q = a.traction;
      EXPECT_LE((b.traction - q).matrix().norm(), kTractionToGap * q.matrix().norm());
    }
  }
}

// ------------------------------------------------------------------ normal loads that change

/// Steps from one push held after first loading to another, along a straight line.
Scene straight(const Push& from, const Push& to, int steps) {
  std::vector<Push> pushes{from};
  for (int i = 1; i <= steps; ++i) {
    const double part = static_cast<double>(i) / steps;
    pushes.push_back({std::lerp(from.normal, to.normal, part), std::lerp(from.force, to.force, part)});
  }
  return on_cells(pushed(plain(), pushes), 64);
}

/// J, after the first push.
double lost(const std::vector<State>& states) {
  double sum = 0.0;
  for (std::size_t i = 1; i < states.size(); ++i) sum += states[i].solution.dissipated;
  return sum;
}

/// The theory along the straight line, in the scene's units: 1000 N, mu = 0.1, 210 GPa twice.
struct Exact {
  double displacement;  ///< m
  double lost;          ///< J, after the first push
};
Exact exact_straight(const Push& from, const Push& to) {
  const double contact_radius = find_oracle(pushed(plain(), {{1000.0, 0.0}})).oracle->contact_radius;
  const double length = 100.0 / (210e9 / 4.0 * contact_radius);
  analytic::tangential::TangentialHistory history;
  history.load_to(from.normal / 1000.0, 0.0);
  history.load_to(from.normal / 1000.0, from.force / 100.0);
  const double before = history.state().dissipated;
  history.load_to(to.normal / 1000.0, to.force / 100.0);
  return {history.state().displacement * length, (history.state().dissipated - before) * 100.0 * length};
}

double displacement_of(const Solution& solution) {
  return 0.6 * solution.displacement[0] + 0.8 * solution.displacement[1];
}

struct Path {
  Push from;
  Push to;
};

/// The same tractions end a path in one step or in four where its slip advances without turning: wherever the
/// normal load falls or stays, and where it rises more slowly than |F|/mu changes, or without a change of F.
TEST(HistoryComparison, OneStepIsEnoughWhereSlipAdvances) {
  for (const auto& [from, to] : {
           Path{{1000, 50}, {1000, -50}},  // constant
           Path{{1000, 50}, {1500, 50}},   // rising: the ring of slip is locked in
           Path{{1000, 50}, {1500, 120}},  // rising, the force faster
           Path{{1000, 50}, {1500, -50}},
           Path{{1000, 50}, {700, 50}},  // falling: more and more slips
           Path{{1000, 50}, {700, 35}},
           Path{{1000, 30}, {700, 50}},
           Path{{1000, 50}, {700, 10}},  // falling, the force faster
           Path{{1000, 50}, {700, -30}},
       }) {
    const Solution in_one = follow(straight(from, to, 1)).back().solution;
    const Solution in_four = follow(straight(from, to, 4)).back().solution;
    const double exact = exact_straight(from, to).displacement;
    // Residual states carry the mesh error of the branches that they are left from, 6e-5.
    const double most = std::max(std::abs(exact), exact_straight({1000, 0}, from).displacement);
    EXPECT_NEAR(displacement_of(in_one), exact, 2e-4 * most) << to.normal << ' ' << to.force;
    EXPECT_NEAR(displacement_of(in_one), displacement_of(in_four), kMotionToGap * most);
    const Eigen::ArrayXd& q = in_one.traction;
    EXPECT_LE((in_four.traction - q).matrix().norm(), kTractionToGap * q.matrix().norm());
  }
}

/// A rising normal load that outruns the force sticks throughout; a step that brings it first, then the force, slips at
/// the edge. The error is of first order in the size of the steps; the answer is the exact one of the staircase.
TEST(HistoryComparison, AForceThatRisesWithItsNormalLoadNeedsSmallSteps) {
  for (const auto& [from, to] :
       {Path{{1000, 50}, {1500, 80}}, Path{{1000, 50}, {1500, 20}}, Path{{100, 0}, {1000, 50}}}) {
    const double exact = exact_straight(from, to).displacement;
    const auto error = [&](int steps) {
      return std::abs(displacement_of(follow(straight(from, to, steps)).back().solution) / exact - 1.0);
    };
    const double of_two = error(2);
    const double of_eight = error(8);
    EXPECT_GT(of_two, 20.0 * kMotionAt128);  // far more than the mesh's
    EXPECT_NEAR(std::log(of_two / of_eight) / std::log(4.0), 1.0, 0.15);
    const std::vector<State> staircase = follow(straight(from, to, 2));
    EXPECT_LE(staircase.back().errors.displacement, 2e-4);
  }
}

/// A step's slip counts against the friction at its end: too little on the way down, too much on the way up,
/// of first order in the size of the steps.
TEST(HistoryComparison, EnergyLostUnderAChangingNormalLoadNeedsSmallSteps) {
  for (const auto& [from, to] : {Path{{1000, 50}, {700, 50}}, Path{{1000, 50}, {1500, 120}}}) {
    const double exact = exact_straight(from, to).lost;
    const double of_two = lost(follow(straight(from, to, 2))) / exact - 1.0;
    const double of_eight = lost(follow(straight(from, to, 8))) / exact - 1.0;
    EXPECT_EQ(std::signbit(of_two), to.normal < from.normal);
    EXPECT_NEAR(std::log(of_two / of_eight) / std::log(4.0), 1.0, 0.15);
  }
}

// ------------------------------------------------------------------ dissimilar bodies pressed together

/// Against a rigid body, nu = 0: beta = 1/2. mu = 0.2986 is Spence's.
Scene against_rigid(solver::Coupling coupling) {
  Scene scene = without_contraction(example("paper"));
  scene.upper = {.young_modulus = INFINITY, .poisson_ratio = 0.0};
  scene.contact.friction.coefficient = 0.2986;
  scene.contact.coupling = coupling;
  return twisted(scene, {0.0});
}

/// The last step's error of the stick ratio, by counting cells: the slip of one small step is no smooth
/// function of the distance from the front. Each step brings as many times the load of the one before.
double stick_ratio_error(Scene sphere, int steps) {
  sphere = twisted(sphere, std::vector<double>(steps, 0.0));
  for (int i = 0; i < steps; ++i) {
    sphere.steps[i].normal = 1000.0 * std::pow(2.0, -6.0 * (steps - 1 - i) / steps);
  }
  const State last = follow(sphere).back();
  const double ratio = last.solution.stick_radius_counted / last.solution.contact_radius;
  return std::abs(ratio / last.exact.state.stick_ratio - 1.0);
}

/// A sphere's contact grows, and the answer depends on how: in more and more steps the stick ratio tends to
/// the punch's, with an error of first order in the steps.
TEST(HistoryComparison, SpherePressedOnAnotherMaterialInSteps) {
  const Scene goodman = on_cells(against_rigid(solver::Coupling::pressure), 64);
  EXPECT_NEAR(std::log(stick_ratio_error(goodman, 2) / stick_ratio_error(goodman, 16)) / std::log(8.0), 1.0, 0.15);
  const Scene spence = on_cells(against_rigid(solver::Coupling::full), 48);
  EXPECT_NEAR(std::log(stick_ratio_error(spence, 2) / stick_ratio_error(spence, 8)) / std::log(4.0), 1.0, 0.15);
}

// ------------------------------------------------------------------ one load

/// Between a sphere and a flat punch. Twist about h^2, pressure about h^1.5 in L1 for its steep edge,
/// over a factor 4 in h; half an order is left for the staircase of contact and stick area.
TEST(Comparison, AFlatBodyFallsWithTheMesh) {
  Scene body = example("rounded_punch");
  body.surfaces = {{.shape = solver::Shape::power, .exponent = 4.0, .coefficient = 1e8}};
  const Errors coarse = follow(on_cells(body, 32)).front().errors;
  const Errors fine = follow(on_cells(body, 128)).front().errors;
  EXPECT_LE(std::abs(fine.twist), std::abs(coarse.twist) * std::pow(4.0, -1.5));
  EXPECT_LE(fine.pressure.l1, coarse.pressure.l1 * std::pow(4.0, -1.0));
  EXPECT_LE(std::abs(fine.twist), kMotionAt128);
  EXPECT_LE(fine.traction.at_centres.l1, kStepTractionAt128);
  EXPECT_LE(std::abs(fine.stick_radius), 5e-3);   // half a cell of 60 to the radius
  EXPECT_LE(std::abs(fine.peak_pressure), 1e-3);  // h^2, at a peak that a cell may miss by half of it
}

/// A solution that is the exact one but for a part of one number shows that part, along either axis.
TEST(Comparison, SeesEachComponentOfADisplacement) {
  const Scene mindlin = example("mindlin", {"grid.cells=[24,24]", "load.force=[30.0, 40.0]"});
  const Oracle oracle = *find_oracle(mindlin).oracle;
  Solution solution = solver::solve(mindlin);
  solution.displacement = oracle.displacement;
  EXPECT_EQ(compare(solution, oracle).displacement, 0.0);
  const double length = std::hypot(oracle.displacement[0], oracle.displacement[1]);
  for (const std::size_t along : {0, 1}) {
    solution.displacement = oracle.displacement;
    solution.displacement[along] += 1e-3 * length;
    EXPECT_NEAR(compare(solution, oracle).displacement, 1e-3, 1e-12) << along;
  }
}

/// A cell that is no number is the worst of all, wherever it stands.
TEST(Comparison, ANumberThatIsNoneIsNotSkipped) {
  const Scene paper = example("paper", {"grid.cells=[16,16]"});
  const Oracle oracle = *find_oracle(paper).oracle;
  const Solution solution = solver::solve(paper);
  for (const Eigen::Index cell : {8 * 16 + 8, 4 * 16 + 8, 8 * 16 + 12}) {
    Solution bad = solution;
    bad.pressure[cell] = std::numeric_limits<double>::quiet_NaN();
    const FieldError pressure = compare(bad, oracle).pressure;
    for (const double error : {pressure.l1, pressure.l2, pressure.max}) EXPECT_TRUE(std::isnan(error)) << cell;
    for (const Eigen::Index component : {0, 256}) {
      bad = solution;
      bad.traction[component + cell] = std::numeric_limits<double>::quiet_NaN();
      const TractionError traction = compare(bad, oracle).traction;
      EXPECT_TRUE(std::isnan(traction.at_centres.max)) << cell;
      EXPECT_TRUE(std::isnan(traction.averaged.max)) << cell;
    }
  }
}

// The exact peak is infinite, and so is a cone's pressure in a cell at the axis.
TEST(Comparison, LeavesOutWhatIsInfinite) {
  for (const char* name : {"cone", "flat_punch"}) {
    const Errors errors = follow(on_cells(example(name, {"load.moment_ratio=0.5"}), 33)).front().errors;
    EXPECT_TRUE(std::isnan(errors.peak_pressure)) << name;
    for (const FieldError& field : {errors.pressure, errors.traction.at_centres}) {
      for (const double error : {field.l1, field.l2, field.max}) EXPECT_TRUE(std::isfinite(error)) << name;
    }
  }
}

}  // namespace
}  // namespace slipstick::convergence
