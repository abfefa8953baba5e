#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "analytic/axisymmetric.hpp"

namespace slipstick::analytic {

struct PressurePoint {
  double radius;
  double pressure;
};

/// Another pressure that the points of a table do not rule out, over its own mean.
struct Alternative {
  std::unique_ptr<const Profile> profile;
  double mean_pressure;
};

/// A pressure known at some radii only, in consistent units. Between them Steffen's interpolation (1990):
/// piecewise cubic, monotone between any two points. Functions of the interpolant are good to 1e-13; how far
/// they are from those of the pressure meant, interpolation_errors() estimates.
struct TabulatedProfile {
  std::unique_ptr<const Profile> profile;
  double radius;         ///< a, the last radius
  double mean_pressure;  ///< p0 = W/(pi a^2)
  /// For each stretch of the radius, pressures that differ from `profile` there alone: made of every second
  /// point, of points moved by what their neighbours fail to foretell, with another value on the axis or
  /// another law at the edge.
  std::vector<std::vector<Alternative>> alternatives;
};

/// `name` is for messages and for the profile. Throws std::invalid_argument, with the point and what is
/// allowed, unless: at least 16 points; radii finite, rising from 0; pressures finite and positive, at the
/// last point perhaps 0; and H decreasing, since else no circle sticks (the slip would begin inside: a
/// pressure that rises outwards too much).
TabulatedProfile tabulated_profile(const std::string& name, const std::vector<PressurePoint>& points);

/// What a message calls a point, by its index: a line of a file.
using PointPlace = std::function<std::string(std::size_t)>;

/// The same for points that have names of their own.
TabulatedProfile tabulated_profile(const std::string& name, std::vector<PressurePoint> points,
                                   const PointPlace& where);

/// How far numbers that come from a table may be from those of the pressure meant. `numbers` makes them from
/// a profile and its mean pressure (the same count each time). An estimate, no proof: of each number twice
/// the sum, over the stretches, of the largest change that an alternative there makes; sizes are added, so
/// that errors of opposite signs do not hide each other. It sees what the points show: noise and rounding of
/// the values, a kink, an edge like any power of the distance; not a feature between two points that shows at
/// none, nor a value that is wrong together with its neighbours. Throws what `numbers` throws.
std::vector<double> interpolation_errors(
    const TabulatedProfile& table,
    const std::function<std::vector<double>(const Profile&, double mean_pressure)>& numbers);

}  // namespace slipstick::analytic
