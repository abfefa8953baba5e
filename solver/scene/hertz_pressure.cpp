#include "solver/scene/hertz_pressure.hpp"

#include <gsl/gsl_sf_ellint.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "solver/scene/bracketed_root.hpp"

namespace slipstick::solver {
namespace {

using std::numbers::pi;

/// Integrals over the direction theta in [0, pi) of sin^2/A^(3/2) and cos^2/A^(3/2), where
/// A = cos^2/k^2 + sin^2 and k = a1/a2. Their ratio is R2/R1. As integrals over tan and cot of theta they
/// are Carlson's R_D, which loses no digits where the ellipse is nearly a circle.
struct Curvatures {
  double along_1;
  double along_2;
};
/// Bound of the axis ratio's square, within which Carlson's integral and its products stay in double precision.
constexpr double kMinSquare = 1e-180;

Curvatures direction_integrals(double axis_ratio) {
  const double square = axis_ratio * axis_ratio;
  // Said here: beyond them GSL's own handler would end the program.
  if (!(square > kMinSquare && square < 1.0 / kMinSquare)) {
    throw std::domain_error("radii of an ellipsoid whose ratio is beyond all bounds");
  }
  const auto carlson = [](double y, double z) { return gsl_sf_ellint_RD(0.0, y, z, GSL_PREC_DOUBLE); };
  return {2.0 / 3.0 * square * axis_ratio * carlson(1.0, square), 2.0 / 3.0 * carlson(1.0, 1.0 / square)};
}

/// The axis ratio a1/a2, found in its logarithm: the ratio of the curvatures is monotone.
double find_axis_ratio(double radius_ratio) {
  if (radius_ratio == 1.0) return 1.0;
  const double guess = std::log(radius_ratio) * 2.0 / 3.0;
  const auto excess = [&](double logarithm) {
    const Curvatures c = direction_integrals(std::exp(logarithm));
    return std::log(c.along_2 / c.along_1 / radius_ratio);
  };
  const double reach = std::abs(guess) + 1.0;
  return std::exp(bracketed_root(excess, guess - reach, guess + reach));
}

/// Volume under the unit hemisphere over [0, x] x [0, y], odd in x and in y; to the last bit the same with x
/// and y exchanged.
double cap_volume(double x, double y) {
  const double sign = std::copysign(1.0, x) * std::copysign(1.0, y);
  const double u = std::min({std::abs(x), std::abs(y), 1.0});
  const double v = std::min(std::max(std::abs(x), std::abs(y)), 1.0);
  const double square = 1.0 - u * u - v * v;
  if (square > 0.0) {
    const double z = std::sqrt(square);
    return sign / 6.0 *
           (2.0 * u * v * z + u * (3.0 - u * u) * std::atan2(v, z) + v * (3.0 - v * v) * std::atan2(u, z) -
            2.0 * std::atan2(u * v, z));
  }
  const auto beyond = [](double w) { return pi / 4.0 * (2.0 / 3.0 - w + w * w * w / 3.0); };
  return sign * (pi / 6.0 - beyond(u) - beyond(v));
}

}  // namespace

HertzContact hertz_contact(double load, double radius_1, double radius_2, double effective_modulus) {
  // The displacement is p0/(2 E*) times the integral over theta of (C + B^2/A')/sqrt(A'), where the pressure squared
  // along a line from (x1, x2) is p0^2 (C - 2 B r - A' r^2) and A' = A/a2^2. Its curvature along x1 is 1/R1.
  const double axis_ratio = find_axis_ratio(radius_1 / radius_2);
  const double along_1 = direction_integrals(axis_ratio).along_1;
  // 1/R1 = p0 a2 along_1/(E* a1^2) with p0 = 3 W/(2 pi a1 a2):
  const double semi_axis_1 = std::cbrt(1.5 * load * radius_1 * along_1 / (pi * effective_modulus));
  const double semi_axis_2 = semi_axis_1 / axis_ratio;
  return {semi_axis_1, semi_axis_2, 1.5 * load / (pi * semi_axis_1 * semi_axis_2)};
}

Eigen::ArrayXd hertz_at_centres(const HertzContact& contact, const Grid& grid) {
  // The sum first: at the edge the difference would show the order of its terms, and mirrors would be lost.
  const Eigen::ArrayXd square =
      1.0 - ((cell_x1(grid) / contact.semi_axis_1).square() + (cell_x2(grid) / contact.semi_axis_2).square());
  return contact.peak_pressure * square.max(0.0).sqrt();
}

/// Mirror images are the same to the last bit, though each is a difference of large numbers.
Eigen::ArrayXd hertz_cell_averages(const HertzContact& contact, const Grid& grid) {
  const double h1 = grid.h1 / contact.semi_axis_1;
  const double h2 = grid.h2 / contact.semi_axis_2;
  Eigen::ArrayXd pressure(grid.cells());
  for (Index i = 0; i < grid.n1; ++i) {
    const double x = std::abs(grid.x1(i)) / contact.semi_axis_1;
    for (Index j = 0; j < grid.n2; ++j) {
      const double y = std::abs(grid.x2(j)) / contact.semi_axis_2;
      const double volume = (cap_volume(x + 0.5 * h1, y + 0.5 * h2) + cap_volume(x - 0.5 * h1, y - 0.5 * h2)) -
                            (cap_volume(x - 0.5 * h1, y + 0.5 * h2) + cap_volume(x + 0.5 * h1, y - 0.5 * h2));
      // A cell outside the ellipse: what is left of the difference is rounding.
      const double nearest1 = std::max(x - 0.5 * h1, 0.0);
      const double nearest2 = std::max(y - 0.5 * h2, 0.0);
      const bool outside = nearest1 * nearest1 + nearest2 * nearest2 >= 1.0;
      pressure[i * grid.n2 + j] = outside ? 0.0 : contact.peak_pressure * std::max(volume, 0.0) / (h1 * h2);
    }
  }
  return pressure;
}

}  // namespace slipstick::solver
