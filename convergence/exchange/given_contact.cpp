#include "convergence/exchange/given_contact.hpp"

#include <utility>

#include "solver/contact/certificate.hpp"
#include "solver/contact/fitted_motion.hpp"
#include "solver/grid/reduction.hpp"

namespace slipstick::convergence {

using Eigen::ArrayXd;
using solver::Grid;
using solver::Index;

ArrayXd rotation_about_origin(const Grid& grid, const std::array<double, 2>& centre) {
  ArrayXd rotation = solver::rotation_field(grid);
  rotation.head(grid.cells()) -= centre[1];
  rotation.tail(grid.cells()) += centre[0];
  return rotation;
}

GivenContact::GivenContact(const solver::Dimensionless& bodies, solver::Elasticity elastic,
                           const std::array<double, 2>& middle, ArrayXd p, ArrayXd q)
    : Dimensionless(bodies),
      elasticity(std::move(elastic)),
      centre(middle),
      pressure(std::move(p)),
      friction_bound(friction.bound(pressure)),
      traction(std::move(q)),
      bound_rounding(ArrayXd::Zero(pressure.size())),
      traction_rounding(ArrayXd::Zero(pressure.size())),
      rotation(rotation_about_origin(grid, centre)),
      elastic_displacement(elasticity.make(grid, solver::tangential_kernel())->applied(traction)) {
  displacement = elastic_displacement;
  if (pressure_coupling) displacement += pressure_displacement(*this, grid, pressure);
}

std::array<double, 2> GivenContact::force() const {
  const Index cells = pressure.size();
  return {traction.head(cells).sum(), traction.tail(cells).sum()};
}

ArrayXd pressure_displacement(const GivenContact& contact, const Grid& grid, const ArrayXd& pressure) {
  if (!contact.pressure_coupling) return {};
  return contact.elasticity.make(grid, solver::coupling_kernel())->applied(pressure);
}

RigidMotions rigid_motions(const GivenContact& contact, const KnownMotion& motion) {
  const Index cells = contact.pressure.size();
  RigidMotions motions{{}, ArrayXd::Zero(2 * cells)};
  for (std::size_t k = 0; k < 2; ++k) {
    ArrayXd translation = ArrayXd::Zero(2 * cells);
    translation.segment(static_cast<Index>(k) * cells, cells).setOnes();
    if (motion.displacement) {
      motions.imposed += (*motion.displacement)[k] * translation;
    } else if (motion.translates) {
      motions.free.push_back(translation);
    }
  }
  if (motion.twist) {
    motions.imposed += *motion.twist * contact.rotation;
  } else {
    motions.free.push_back(contact.rotation);
  }
  return motions;
}

State find_state(const GivenContact& c, KnownMotion motion) {
  // The gap is convex in the motion: of what half a turn about the origin leaves, the least has no translation.
  if (c.centre == std::array{0.0, 0.0} && is_half_turn_symmetric(c.grid, c.friction_bound) &&
      solver::turns_into_itself(c.traction) && solver::turns_into_itself(c.displacement))
    motion.translates = false;
  // Within the bound no gap is negative: the bound is raised to |q| where |q| exceeds it.
  const ArrayXd bound = c.friction_bound.max(solver::norms(c.traction) * (c.friction_bound > 0.0).cast<double>());
  const RigidMotions motions = rigid_motions(c, motion);
  solver::FittedMotion fitted = solver::fit_motion(c.displacement - motions.imposed, c.traction, bound, motions.free);
  const auto& found = fitted.coefficients;
  State state{.twist = motion.twist ? *motion.twist : found[found.size() - 1],
              .displacement = motion.displacement.value_or(std::array<double, 2>{}),
              .slip = std::move(fitted.slip),
              .gap = std::move(fitted.gap)};
  if (!motion.displacement && motion.translates) state.displacement = {found[0], found[1]};
  return state;
}

}  // namespace slipstick::convergence
