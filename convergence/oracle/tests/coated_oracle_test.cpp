#include <gtest/gtest.h>

#include <algorithm>

#include "analytic/layered/layered_pair.hpp"
#include "convergence/oracle/errors.hpp"
#include "convergence/oracle/law_contact.hpp"
#include "convergence/oracle/tests/histories.hpp"
#include "solver/elasticity/law/layer_symbol.hpp"
#include "solver/input/input_error.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

solver::Scene coated(const std::vector<std::string>& overrides = {}) {
  return solver::read_scene(SLIPSTICK_SCENES "/coated_sphere.toml", overrides);
}

TEST(CoatedOracle, IsThatOfHalfSpacesWhereTheLayerIsLikeItsBase) {
  for (const char* shape : {"sphere", "flat_punch"}) {
    solver::Scene scene = coated({std::string("upper.shape=") + shape, "load.moment_ratio=0.9"});
    scene.surfaces.front().radius = 0.001;
    scene.lower.young_modulus = scene.lower.coating->young_modulus;
    scene.lower.poisson_ratio = scene.lower.coating->poisson_ratio;
    const Oracle layered = *find_oracle(scene).oracle;
    scene.lower.coating.reset();
    const Oracle plain = *find_oracle(scene).oracle;
    EXPECT_LE(layered.relative_uncertainty, 1e-11) << shape;
    for (double Oracle::*const number :
         {&Oracle::contact_radius, &Oracle::moment, &Oracle::twist_angle, &Oracle::stick_radius, &Oracle::dissipated}) {
      EXPECT_NEAR(layered.*number / plain.*number, 1.0, 1e-11) << shape;
    }
    EXPECT_NEAR(layered.normal.approach / plain.normal.approach, 1.0, 1e-11) << shape;
    EXPECT_NEAR(layered.friction.moment_limit / plain.friction.moment_limit, 1.0, 1e-11) << shape;
    for (const double part : {0.2, 0.5, 0.9}) {
      const double radius = part * plain.contact_radius;
      EXPECT_NEAR(layered.pressure(radius) / plain.pressure(radius), 1.0, 1e-11) << shape;
      EXPECT_NEAR(layered.traction(radius) / plain.traction(radius), 1.0, 1e-11) << shape;
    }
  }
}

/// The exact side's compliances under waves, against the solver's, which are compared with Navier's
/// equations and derived apart.
TEST(CoatedOracle, MovesUnderWavesAsTheSolverHasIt) {
  using analytic::layered::Body;
  const Body other{{4, 0.3}, analytic::layered::Coat{0.7, {1, 0.2}}};
  for (const double base : {1e-3, 0.2, 1.0, 7.0, 1e3, std::numeric_limits<double>::infinity()}) {
    for (const double nu : {0.0, 0.3, 0.5}) {
      for (const double k : {0.02, 0.4, 1.5, 6.0}) {
        const analytic::layered::Pair pair({{1, nu}, analytic::layered::Coat{1.0, {base, 0.5 - nu}}}, other);
        const auto first = solver::wave_compliance({{1, nu}, 1.0, {base, 0.5 - nu}}, k);
        const auto second = solver::wave_compliance({{4, 0.3}, 0.7, {1, 0.2}}, k);
        EXPECT_NEAR((1 + pair.normal_excess(k)) * 2 / pair.effective_modulus() / (first.normal + second.normal), 1.0,
                    1e-12)
            << base << ' ' << nu << ' ' << k;
        EXPECT_NEAR((1 + pair.torsional_excess(k)) / pair.shear_modulus() / (first.across + second.across), 1.0, 1e-13)
            << base << ' ' << k;
      }
    }
  }
}

TEST(CoatedOracle, CarriesItsLoads) {
  const Oracle oracle = *find_oracle(coated()).oracle;
  const CarriedLoads carried = loads_carried_by(oracle);
  EXPECT_NEAR(carried.load / 1000.0, 1.0, 1e-6);
  EXPECT_NEAR(carried.moment / (0.5 * oracle.friction.moment_limit), 1.0, 1e-6);
}

/// The largest error of twists, over the largest twist, and of the limit moment in a history on `cells` cells.
double largest_error(solver::Scene scene, int cells) {
  scene.grid.cells = {cells, cells};
  auto history = exact_history(scene);
  double largest = 0.0;
  double twist = 0.0;
  const auto compare_step = [&](const solver::Solution& solution) {
    const Oracle oracle = *history.advance(solution.loads).oracle;
    const Errors errors = compare(solution, oracle);
    twist = std::max(twist, std::abs(oracle.twist_angle));
    largest = std::max({largest, std::abs(errors.twist * oracle.twist_angle / twist), std::abs(errors.moment_limit)});
  };
  solver::solve(scene, {.observer = {.step = compare_step}});
  return largest;
}

/// The solver knows nothing of these integral equations; either side is wrong where they part.
TEST(CoatedOracle, IsWhatTheSolverTendsTo) {
  for (const double modulus : {30e9, 500e9}) {
    solver::Scene scene = twisted(coated(), {0.9, -0.4, 0.6});
    scene.lower.coating->young_modulus = modulus;
    const double fine = largest_error(scene, 192);
    EXPECT_LE(fine, 1e-4) << modulus;
    EXPECT_GE(largest_error(scene, 48) / fine, 4.0) << modulus;  // order 1
  }
}

TEST(CoatedOracle, HasNoLaw) { EXPECT_THROW(law_contact(coated()), solver::InputError); }

}  // namespace
}  // namespace slipstick::convergence
