#include "solver/contact/limit_load.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <vector>

#include "solver/contact/smoothed_friction.hpp"
#include "solver/contact/tangential_problem.hpp"

namespace slipstick::solver {
namespace {

using Eigen::Array2d;
using Eigen::ArrayXd;
using Eigen::Matrix;
using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Upper and lower bound of the factor agree to this, some units of rounding. They depend on the motion to
/// second order, so that the motion has about eight digits.
constexpr double kTolerance = 2e-15;

/// The root mean square of |v| is 1 at the start.
constexpr Smoothing kSmoothing{.first = 0.1, .least = 1e-15};

/// The contact's cells, lengths over its radius of gyration from its centroid, friction bounds over their sum. A motion
/// is (velocity of the centroid, rotation times radius of gyration), so that the mean square of |v| is |motion|^2.
struct Contact {
  ArrayXd x1, x2, bound;
  double total = 0.0;  ///< friction bound
  Array2d centroid = {0.0, 0.0};
  double length = 0.0;    ///< radius of gyration; of a single cell, which has none, its size
  double gyration = 1.0;  ///< radius of gyration over length
  double radius = 0.0;    ///< of the furthest cell, over length

  Contact(const Grid& grid, const ArrayXd& friction_bound) : total(friction_bound.sum()) {
    const Index count = (friction_bound > 0.0).count();
    x1.resize(count);
    x2.resize(count);
    bound.resize(count);
    for (Index cell = 0, k = 0; cell < grid.cells(); ++cell) {
      if (!(friction_bound[cell] > 0.0)) continue;
      x1[k] = grid.x1(cell / grid.n2);
      x2[k] = grid.x2(cell % grid.n2);
      bound[k++] = friction_bound[cell] / total;
    }
    length = std::sqrt(grid.cell_area());
    if (count > 0) scale();
  }

  /// From the origin's motion to the scaled one of the centroid.
  Matrix3d scaling() const {
    Matrix3d scaling;
    scaling << 1.0, 0.0, -centroid[1], 0.0, 1.0, centroid[0], 0.0, 0.0, length;
    return scaling;
  }

 private:
  /// Relative to the strongest cell first, so that rounding leaves no radius of gyration to a single one.
  void scale() {
    Index strongest = 0;
    bound.maxCoeff(&strongest);
    const Array2d start = {x1[strongest], x2[strongest]};
    const Array2d shift = {(bound * (x1 - start[0])).sum(), (bound * (x2 - start[1])).sum()};
    x1 = x1 - start[0] - shift[0];
    x2 = x2 - start[1] - shift[1];
    centroid = start + shift;
    const double radius_of_gyration = std::sqrt((bound * (x1.square() + x2.square())).sum());
    if (radius_of_gyration > 0.0) length = radius_of_gyration;
    gyration = radius_of_gyration / length;
    x1 /= length;
    x2 /= length;
    radius = std::sqrt((x1.square() + x2.square()).maxCoeff());
  }
};

/// Friction in a motion, smoothed: sum of bound sqrt(|v|^2 + s^2), its first derivatives (the resultants of
/// the tractions bound v/sqrt(|v|^2 + s^2)) and its second ones.
struct Friction {
  Vector3d motion;
  double work = 0.0;  ///< without smoothing
  double smoothed = 0.0;
  Vector3d resultant = Vector3d::Zero();
  Matrix3d stiffness = Matrix3d::Zero();
  Index slowest = 0;               ///< the cell with the least |v|
  Coefficients gradient = {};      ///< of the smoothed friction along the free directions,
  CoefficientMatrix hessian = {};  ///< and its second derivatives
};

Friction evaluate(const Contact& contact, const Vector3d& motion, double smoothing) {
  constexpr Index kBlock = 256;  // in cache, and summed on its own: rounding grows with the block only
  using Block = Eigen::Array<double, Eigen::Dynamic, 1, 0, kBlock, 1>;
  Friction sum;
  sum.motion = motion;
  double least = kInfinity;
  for (Index start = 0; start < contact.bound.size(); start += kBlock) {
    const Index size = std::min(kBlock, contact.bound.size() - start);
    const auto x1 = contact.x1.segment(start, size);
    const auto x2 = contact.x2.segment(start, size);
    const auto bound = contact.bound.segment(start, size);
    const Block v1 = motion[0] - motion[2] * x2;
    const Block v2 = motion[1] + motion[2] * x1;
    const Block square = v1.square() + v2.square();
    const Block speed = (square + smoothing * smoothing).sqrt();
    const Block weight = bound / speed;
    sum.work += (bound * square.sqrt()).sum();
    sum.smoothed += (bound * speed).sum();
    sum.resultant += Vector3d((weight * v1).sum(), (weight * v2).sum(), (weight * (x1 * v2 - x2 * v1)).sum());

    const Block curvature = weight / speed.square();
    const Block k11 = curvature * (v2.square() + smoothing * smoothing);
    const Block k12 = -curvature * v1 * v2;
    const Block k22 = curvature * (v1.square() + smoothing * smoothing);
    const Block k13 = x1 * k12 - x2 * k11;
    const Block k23 = x1 * k22 - x2 * k12;
    Matrix3d stiffness;
    stiffness << k11.sum(), k12.sum(), k13.sum(),  //
        0.0, k22.sum(), k23.sum(),                 //
        0.0, 0.0, (x1 * k23 - x2 * k13).sum();
    sum.stiffness += stiffness;
    Index slowest = 0;
    if (const double slowest_square = square.minCoeff(&slowest); slowest_square < least) {
      least = slowest_square;
      sum.slowest = start + slowest;
    }
  }
  sum.stiffness = Matrix3d(sum.stiffness.selfadjointView<Eigen::Upper>());
  return sum;
}

/// The motions in which the loads do unit work: base + directions z, z any vector; orthonormal.
struct Motions {
  Vector3d base;
  Matrix<double, 3, Eigen::Dynamic, 0, 3, 2> directions;
};

/// A lower bound of the least friction over all motions, by admissible tractions whose resultants do the work
/// q.v in this motion and q.v + r.(z' - z) in another one. The cell nearest to the kink of |v|, where the
/// smoothed law leaves the traction open, absorbs as much of r as it can. The rest is multiplied by the
/// largest possible distance of the minimiser: work >= bound |v|^2 / max |v| >=
/// gyration^2 |motion| / sqrt(1 + radius^2).
double lower_bound(const Contact& contact, const Friction& friction, const Motions& motions, double smoothing) {
  if (contact.bound.size() == 0) return 0.0;
  const Index k = friction.slowest;
  Matrix<double, 2, 3> velocity;
  velocity << 1.0, 0.0, -contact.x2[k], 0.0, 1.0, contact.x1[k];
  const Coefficients& residual = friction.gradient;
  const Vector2d v = velocity * friction.motion;
  const Vector2d traction = contact.bound[k] / std::hypot(v.norm(), smoothing) * v;
  const CoefficientMatrix balance = motions.directions.transpose() * velocity.transpose();
  Vector2d balanced = traction;
  if (residual.size() > 0) balanced -= least_solution(balance, residual);
  const Vector2d change = balanced * std::min(1.0, contact.bound[k] / balanced.norm()) - traction;

  const double left = (residual + balance * change).norm();
  const double work = friction.resultant.dot(friction.motion) + change.dot(v);
  if (left == 0.0) return work;
  const double furthest = friction.work * std::hypot(1.0, contact.radius) / (contact.gyration * contact.gyration);
  return std::max(0.0, work - left * (friction.motion.norm() + furthest));
}

struct Minimum {
  Vector3d motion;
  double work;     ///< the least friction found
  double carried;  ///< it is not less than this
};

/// The least friction over the motions.
Minimum least_friction(const Contact& contact, const Motions& motions) {
  Minimum best{motions.base, kInfinity, 0.0};
  const auto move = [&](const Friction& from, const Coefficients& step, double smoothing) {
    Friction to = evaluate(contact, from.motion + motions.directions * step, smoothing);
    to.gradient = motions.directions.transpose() * to.resultant;
    to.hessian = motions.directions.transpose() * to.stiffness * motions.directions;
    return to;
  };
  const auto is_least = [&](const Friction& at, double smoothing) {
    if (at.work < best.work) {
      best.work = at.work;
      best.motion = at.motion;
    }
    best.carried = std::max(best.carried, lower_bound(contact, at, motions, smoothing));
    return !(best.work - best.carried > kTolerance * best.work);
  };
  Friction start{.motion = motions.base};
  start.gradient = Coefficients::Zero(motions.directions.cols());
  minimise_smoothed(start, kSmoothing, move, is_least);
  best.carried = std::min(best.carried, best.work);
  return best;
}

void require_valid(const Grid& grid, const ArrayXd& friction_bound, const ImposedLoads& loads) {
  if (friction_bound.size() != grid.cells()) {
    throw std::invalid_argument(
        fmt::format("limit load: {} friction bounds on {} cells", friction_bound.size(), grid.cells()));
  }
  if (!(friction_bound >= 0.0).all() || !friction_bound.isFinite().all()) {
    throw std::invalid_argument("limit load: friction bound: allowed: finite, zero or positive");
  }
  if (grid.quadrant) throw std::invalid_argument("limit load: allowed: whole grids, no quadrants");
  for (const auto& load : loads) {
    if (load && !std::isfinite(*load)) throw std::invalid_argument("limit load: loads: allowed: finite");
  }
}

/// Radii of gyration beyond which the turning centre is lost in rounding: the motion is a translation.
constexpr double kFurthestCentre = 1e10;

std::optional<std::array<double, 2>> turning_centre(const Contact& contact, const Vector3d& motion) {
  const double speed = std::hypot(motion[0], motion[1]);
  if (!(speed < kFurthestCentre * std::abs(motion[2]))) return std::nullopt;
  const double scale = contact.length / motion[2];
  return std::array{contact.centroid[0] - scale * motion[1], contact.centroid[1] + scale * motion[0]};
}

}  // namespace

LimitLoad find_limit(const Grid& grid, const ArrayXd& friction_bound, const ImposedLoads& loads) {
  require_valid(grid, friction_bound, loads);
  std::vector<Index> imposed;
  for (Index k = 0; k < 3; ++k) {
    if (loads[static_cast<std::size_t>(k)]) imposed.push_back(k);
  }
  const auto m = static_cast<Index>(imposed.size());
  Coefficients load(m);
  for (Index k = 0; k < m; ++k) {
    load[k] = *loads[static_cast<std::size_t>(imposed[static_cast<std::size_t>(k)])];
  }
  if (load.isZero(0.0)) return {kInfinity, kInfinity, {}, std::nullopt};

  // Scaled motions with the imposed components zero are `basis` y; the loads' work in them is `work`.y.
  const Contact contact(grid, friction_bound);
  const auto [basis, triangle] = small_qr(contact.scaling()(Eigen::all, imposed));
  const Coefficients work = triangle.transpose().triangularView<Eigen::Lower>().solve(load);
  const double size = work.norm();
  const CoefficientMatrix split = orthonormal_basis(work);
  const Minimum minimum = least_friction(contact, {basis * work / size, basis * split.rightCols(m - 1)});

  Vector3d sliding = Vector3d::Zero();
  sliding(imposed) =
      Coefficients(triangle.triangularView<Eigen::Upper>().solve(basis.transpose() * minimum.motion)) / size;
  return {contact.total * minimum.work / size,
          contact.total * minimum.carried / size,
          {sliding[0], sliding[1], sliding[2]},
          turning_centre(contact, minimum.motion)};
}

double free_moment_limit(const Grid& grid, const ArrayXd& friction_bound) {
  // The sum is convex in c: half a turn that leaves the bounds leaves a least one at the origin.
  const bool at_origin = friction_bound.isFinite().all() && is_half_turn_symmetric(grid, friction_bound);
  return at_origin ? moment_limit(grid, friction_bound) : find_limit(grid, friction_bound, {0.0, 0.0, 1.0}).factor;
}

}  // namespace slipstick::solver
