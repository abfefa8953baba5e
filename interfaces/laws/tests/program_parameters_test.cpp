// What other programs' parameters mean, by sums over the contact.

#include <gtest/gtest.h>

#include <numbers>

#include "convergence/laws/contact_law.hpp"
#include "interfaces/laws/program_parameters.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::laws {
namespace {

/// Pressure E (depth)/R over the sphere's shallow cap.
TEST(ProgramParameters, DrakesSphereCarriesTheLoadAndTheExactLimit) {
  const ContactLaw law = convergence::make_contact_law(
      convergence::law_contact(solver::read_scene(SLIPSTICK_SCENES "/paper.toml")), {.limit_loads = 3});
  const DrakeHydroelastic drake = drake_hydroelastic(law).value();
  const double sphere = 0.018;
  const double a = drake.contact_radius;
  double load = 0.0;
  double limit = 0.0;
  constexpr int kRings = 100000;
  for (int i = 0; i < kRings; ++i) {
    const double r = a * (i + 0.5) / kRings;
    const double ring = 2.0 * std::numbers::pi * r * a / kRings;
    const double p = drake.modulus * (a * a - r * r) / (2.0 * sphere) / sphere;
    load += p * ring;
    limit += drake.mu_dynamic * p * r * ring;
  }
  EXPECT_NEAR(load, 1000.0, 1e-5);
  EXPECT_NEAR(limit / law.limit_moment(), 1.0, 1e-8);
}

}  // namespace
}  // namespace slipstick::laws
