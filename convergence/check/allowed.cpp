#include "convergence/check/verdict.hpp"
#include "solver/contact/fitted_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;

/// Error that a mesh may cause over that of the reference fields: they know the truth to a third of the mesh
/// error, and other discretisations have errors of the same size.
constexpr double kWholeMesh = 2.0;
/// Effect of rounding or noise over that of the random draw on which it was measured.
constexpr double kOtherDraws = 2.0;
/// Relative error of loads, times the number of contact cells n. A sum over cells of a field that ends like a
/// square root misses up to 4/pi^2 h^2/a^2 at the contact's edge (Poisson's summation, nearest images), about
/// 1/n with the stick area's edge; two such sums are compared.
constexpr double kQuadrature = 2.0;
/// The same of a bound that ends in a step, times n^(3/4): twice the spread of a sum over the cells whose
/// centres lie in a circle, 0.7 of the root of the radius in cells for 1 (Kendall 1948), and 3/2 of that for
/// r.
constexpr double kEndsInStep = 1.5;
/// Degrees between slip and traction that change no result noticeably.
constexpr double kUnseenAngle = 0.1;
/// Gap over energy that the mesh may cause where the field's cells are constant: there the iteration alone
/// leaves a gap. This one stands for tractions good to a few hundredths.
constexpr double kUnfinishedGap = 1e-3;
/// Relative: friction coefficients are not known to more digits.
constexpr double kFrictionDigits = 1e-3;
/// Standard deviations by which no cell of a contact is off by chance.
constexpr double kLargestDraw = 6.0;
/// Relative error of the pressure that a normal solver's tolerance of 1e-3 leaves in the mean,
constexpr double kNormalTolerance = 2e-3;
/// and that of pressure or traction in a single cell, over the largest one.
constexpr double kCellTolerance = 5e-3;

/// For each cell, a number made from the values of its neighbours, which `take` gets in ascending order.
template <typename Take>
ArrayXd of_neighbours(const solver::Grid& grid, const ArrayXd& values, const Take& take) {
  ArrayXd result(grid.cells());
  std::vector<double> around;
  for (Index cell = 0; cell < grid.cells(); ++cell) {
    around.clear();
    for (Index i = cell / grid.n2 - 1; i <= cell / grid.n2 + 1; ++i) {
      for (Index j = cell % grid.n2 - 1; j <= cell % grid.n2 + 1; ++j) {
        const Index other = i * grid.n2 + j;
        if (i >= 0 && i < grid.n1 && j >= 0 && j < grid.n2 && other != cell) around.push_back(values[other]);
      }
    }
    std::ranges::sort(around);
    result[cell] = take(around);
  }
  return result;
}

/// The error that each cell may have. The mesh error that right fields show may stand one cell further on;
/// and a cell may be off where half of its neighbours are, since the mean judges those.
ArrayXd allowed_in_cells(const solver::Grid& grid, double scale, const ArrayXd& deviation,
                         const ArrayXd& mesh, const ArrayXd& chance) {
  const auto largest = [](const std::vector<double>& around) { return around.back(); };
  const auto median = [](const std::vector<double>& around) { return around[around.size() / 2]; };
  return kCellTolerance * scale + chance +
         kWholeMesh * (mesh.max(of_neighbours(grid, mesh, largest)) + of_neighbours(grid, deviation, median));
}

/// Relative error of sums over the contact by rounding and noise.
double error_of_sums(const Examination& e) {
  const GivenContact& c = e.contact;
  return c.traction_rounding.sum() / solver::norms(c.traction).sum() +
         c.bound_rounding.sum() / c.friction_bound.sum() +
         kLargestDraw * std::sqrt(e.reference.noise_size.square().sum()) / c.friction_bound.sum();
}

/// The gap over energy that a relative error of the tractions may cause.
double gap_of_tolerance(const Examination& e, double tolerance) {
  const GivenContact& c = e.contact;
  const ArrayXd reach = solver::norms(e.state.slip) + solver::norms(c.displacement);
  return tolerance * (c.friction_bound * reach).sum() / c.energy();
}

/// What is the same with and without a tolerance.
Allowed allowed_anyway(const Examination& e) {
  const GivenContact& c = e.contact;
  const ReferenceOnGrid& y = e.reference;
  Allowed allowed{};
  allowed.discrete_gap = kIterationGap + kOtherDraws * y.rounding.gap;
  allowed.traction_cells =
      allowed_in_cells(c.grid, c.friction_bound.maxCoeff(), traction_deviation(e), y.mesh.tractions,
                       kLargestDraw * y.noise_size + kOtherDraws * (c.traction_rounding + c.bound_rounding));
  // A part of a cell may carry anything up to a bound that does not vanish at the edge.
  if (e.scene.friction.kind == solver::FrictionKind::tresca)
    allowed.traction_cells += c.friction_bound * (1.0 - y.regions.inner);
  if (y.pressure) {
    allowed.pressure_cells =
        allowed_in_cells(c.grid, y.pressure->values.maxCoeff(), y.pressure->deviation, y.mesh.pressures,
                         (kLargestDraw * y.noise_size + kOtherDraws * c.bound_rounding) / c.mean_friction());
  }
  return allowed;
}

}  // namespace

Allowed find_allowed(const Examination& e, std::optional<double> tolerance) {
  const ReferenceOnGrid& y = e.reference;
  constexpr double kDegreesInARadian = 180.0 / std::numbers::pi;
  Allowed allowed = allowed_anyway(e);
  if (tolerance) {
    allowed.normal = allowed.moment = allowed.force = allowed.pressure = allowed.motion = allowed.tractions =
        allowed.inside = allowed.friction = *tolerance;
    allowed.friction_bound = std::max(kFrictionDigits, *tolerance - kFrictionDigits);
    allowed.direction = kDegreesInARadian * *tolerance;
    allowed.gap = allowed.discrete_gap + gap_of_tolerance(e, *tolerance);
    return allowed;
  }
  const auto by_chance = [&](double Deviation::*part) {
    return kOtherDraws * (y.noise.*part + y.rounding.*part);
  };
  const auto cells = static_cast<double>((e.contact.pressure > 0.0).count());
  const bool step = e.scene.friction.kind == solver::FrictionKind::tresca;
  const double quadrature = kQuadrature / cells;
  const double of_moment = step ? kEndsInStep * std::pow(cells, -0.75) : quadrature;
  const double sums = error_of_sums(e);
  // A program that solves this grid's problem knows its own sums and its own twist.
  const bool discrete =
      e.constant_cells && keeps_friction_bound(e.contact) && e.deviation.gap <= allowed.discrete_gap;
  // Constant cells leave the motion open only as far as the iteration leaves the tractions open.
  const double off = e.deviation.tractions / y.mesh.deviation.tractions;
  const double unfinished = discrete ? 0.0 : e.constant_cells ? std::min(1.0, off) : 1.0;
  const auto load = [&](double measured, double of_sum) {
    return std::max(discrete ? 0.0 : kWholeMesh * measured, of_sum) + sums;
  };
  allowed.normal = load(y.mesh.loads.normal, quadrature);
  allowed.moment = solver::value_if<solver::Twist>(e.scene.steps.front().torsion)
                       ? std::max(kWholeMesh * y.mesh.deviation.moment, of_moment) + sums
                       : load(y.mesh.loads.moment, of_moment);
  allowed.force = load(y.mesh.loads.force, quadrature);
  allowed.pressure =
      kNormalTolerance + kWholeMesh * y.mesh.deviation.pressure +
      kOtherDraws * (e.contact.bound_rounding.sum() + y.noise_size.sum()) / e.contact.friction_bound.sum();
  allowed.motion =
      unfinished * kWholeMesh * y.mesh.deviation.motion + quadrature + by_chance(&Deviation::motion);
  allowed.tractions = kWholeMesh * y.mesh.deviation.tractions + by_chance(&Deviation::tractions);
  allowed.inside = kWholeMesh * y.mesh.deviation.inside + by_chance(&Deviation::inside);
  allowed.friction =
      kFrictionDigits + kWholeMesh * y.mesh.deviation.friction + by_chance(&Deviation::friction);
  allowed.friction_bound =
      std::max(kFrictionDigits, kWholeMesh * y.mesh.deviation.excess + by_chance(&Deviation::excess));
  allowed.direction =
      kUnseenAngle + kWholeMesh * y.mesh.direction + kDegreesInARadian * by_chance(&Deviation::tractions);
  allowed.gap = allowed.discrete_gap +
                std::min(kWholeMesh * y.mesh.deviation.gap, e.constant_cells ? kUnfinishedGap : INFINITY) +
                kOtherDraws * y.noise.gap;
  return allowed;
}

bool keeps_friction_bound(const GivenContact& c) {
  const ArrayXd beyond = solver::norms(c.traction) - (1.0 + solver::kOnCircle) * c.friction_bound -
                         c.traction_rounding - c.bound_rounding;
  return beyond.maxCoeff() <= kNextToNothing * solver::kOnCircle * c.friction_bound.maxCoeff();
}

double friction_excess(const Examination& e) {
  const GivenContact& c = e.contact;
  const ArrayXd beyond = solver::norms(c.traction) - c.friction_bound - c.traction_rounding -
                         c.bound_rounding - kLargestDraw * e.reference.noise_size;
  return (beyond / c.friction_bound.max(kNextToNothing * c.friction_bound.maxCoeff())).maxCoeff();
}

ArrayXd traction_deviation(const Examination& e) {
  return solver::norms(e.contact.traction - e.reference.right.traction);
}

}  // namespace slipstick::convergence
