#pragma once

#include <memory>
#include <string>
#include <vector>

#include "analytic/axisymmetric.hpp"

namespace slipstick::analytic {

struct PressurePoint {
  double radius;
  double pressure;
};

/// A pressure known at some radii only, in consistent units. Between them Steffen's interpolation (1990):
/// piecewise cubic, monotone between any two points. Functions of the interpolant are good to 1e-13; how far
/// it is from the pressure meant shows in the difference to `coarse`, made of every second point: where p is
/// smooth the error is of third order and the difference some 7 times as large; where it ends like a square
/// root, of order 3/2 and not quite twice. Where the difference changes sign it says less, and nothing for a
/// front within the last intervals, where both are the same few points. Each has its own mean pressure for
/// p0: what is over p0 or over W includes the errors of these.
struct TabulatedProfile {
  std::unique_ptr<const Profile> profile;
  std::unique_ptr<const Profile> coarse;
  double radius;                ///< a, the last radius
  double mean_pressure;         ///< p0 = W/(pi a^2)
  double coarse_mean_pressure;  ///< p0 of `coarse`
};

/// `name` is for messages and for the profile. Throws std::invalid_argument, with the point and what is
/// allowed, unless: at least four points; radii finite, rising from 0; pressures finite and positive, at the
/// last point perhaps 0; and H decreasing, since else no circle sticks (the slip would begin inside: a
/// pressure that rises outwards too much).
TabulatedProfile tabulated_profile(const std::string& name, const std::vector<PressurePoint>& points);

/// From a CSV file: a radius and a pressure a line, perhaps under the header `radius,pressure`; empty lines
/// and lines that begin with # do not count. Throws as above with file and line, and for a file that cannot
/// be read.
TabulatedProfile read_tabulated_profile(const std::string& file);

}  // namespace slipstick::analytic
