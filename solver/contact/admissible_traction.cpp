#include "solver/contact/admissible_traction.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "solver/contact/certificate.hpp"
#include "solver/newton/admissible.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr int kMaxSteps = 200;  // bisection from any bracket to neighbouring numbers takes some 60
constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

/// The moment of the projection of z + alpha t onto the discs as a function of alpha.
struct MomentCurve {
  const ArrayXd& z;
  const ArrayXd& bound;
  const ArrayXd& t;

  LoadsAlong<1> at(double alpha) const {
    return FrictionDiscs(bound).loads_along<1, ArrayXd>(z, {&t}, Eigen::Vector<double, 1>(alpha), {&t});
  }

  /// A step of this length turns every cell from wherever z has it, in the mean.
  double scale() const {
    const ArrayXd arm = norms(t);
    const ArrayXd contact = (bound > 0.0).cast<double>();
    return (contact * arm * (norms(z) + bound)).sum() / (contact * arm.square()).sum();
  }
};

/// The curve rises, but may be flat as far as rounding sees, so that Newton's step is limited by `reach`,
/// which grows until the answer is bracketed, and gives way to bisection where it does not halve the
/// imbalance.
double solve_for_moment(const MomentCurve& curve, double moment, double tolerance, double guess) {
  double low = -std::numeric_limits<double>::infinity();
  double high = -low;
  double reach = curve.scale();
  double last = high;
  double alpha = std::isfinite(guess) ? guess : 0.0;
  for (int step = 0; step < kMaxSteps; ++step) {
    const LoadsAlong<1> at = curve.at(alpha);
    const double missing = moment - at.load[0];
    if (std::isnan(missing)) return missing;
    if (std::abs(missing) <= tolerance) break;
    (missing > 0.0 ? low : high) = alpha;
    const bool bracketed = std::isfinite(low) && std::isfinite(high);
    double next = alpha + std::clamp(missing / at.slope(0, 0), -reach, reach);
    if (!bracketed) reach *= 2.0;
    if (bracketed && (std::abs(missing) > 0.5 * last || !(low < next && next < high))) {
      next = low + 0.5 * (high - low);
    }
    if (next == alpha) break;
    last = std::abs(missing);
    alpha = next;
  }
  return alpha;
}

}  // namespace

double project_with_moment(ArrayXd& traction, const ArrayXd& bound, const ArrayXd& rotation, double moment,
                           double guess) {
  const double limit = (bound * norms(rotation)).sum();
  if (!(std::abs(moment) < limit) && !(moment == 0.0 && limit == 0.0)) {
    throw std::invalid_argument(fmt::format(
        "moment {} cannot be carried within the friction bounds; allowed: below {}", moment, limit));
  }
  double alpha = 0.0;
  if (limit > 0.0) {
    alpha = solve_for_moment({traction, bound, rotation}, moment, 2.0 * kEpsilon * limit, guess);
    traction += alpha * rotation;
  }
  FrictionDiscs(bound).project(traction);
  return alpha;
}

}  // namespace slipstick::solver
