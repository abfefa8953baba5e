#pragma once

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

/// A pressure between points, over its own mean.
struct InterpolatedPressure {
  std::unique_ptr<const Profile> profile;
  double mean_pressure;
};

/// A pressure known at some radii only, in consistent units. Between them Steffen's interpolation (1990):
/// piecewise cubic, monotone between any two points. Functions of the interpolant are good to 1e-13;
/// interpolation_errors() estimates the error by interpolation.
struct TabulatedProfile {
  std::unique_ptr<const Profile> profile;
  double radius;                      ///< a, the last radius
  double mean_pressure;               ///< p0 = W/(pi a^2)
  std::vector<PressurePoint> points;  ///< lengths over a, pressures over the largest
  double largest_pressure;
};

/// `name` is for messages and for the profile; messages name the points by `places`, lines of a file, or else by
/// their number. Throws std::invalid_argument, with the point and the allowed range, unless: at least 16 points;
/// radii finite, rising from 0; pressures finite and positive, at the last point perhaps 0; and H decreasing, since
/// else no circle sticks (the slip would begin inside: a pressure that rises outwards too much).
TabulatedProfile tabulated_profile(const std::string& name, std::vector<PressurePoint> points,
                                   std::vector<std::string> places = {});

/// The same from a CSV file: a radius and a pressure a line, perhaps under the header
/// `radius,pressure`; empty lines and lines that begin with # do not count. Throws with file and line, and
/// for a file that cannot be read.
TabulatedProfile read_tabulated_profile(const std::string& file);

/// The interpolant of points whose radii end at 1; `name` is the profile's.
InterpolatedPressure interpolate(const std::string& name, std::vector<PressurePoint> points);

/// The interpolated pressure itself, at a radius between two points.
double interpolated_pressure(const std::vector<PressurePoint>& points, double radius);

/// Estimated errors of numbers that are computed from a table of pressures. `numbers` makes them from
/// a profile and its mean pressure, the same count each time. An estimate, no proof: of each number twice the
/// sum, over stretches of the radius, of the largest change that another reading of the points there makes.
/// The readings: every second point, points moved by their difference from their neighbours' prediction, with
/// another value on the axis or another law at the edge. Sizes are added, so that errors of opposite signs do
/// not hide each other. The estimate sees what the points show: noise and rounding of the values, a kink, an
/// edge like any power of the distance. It does not see a feature between two points that shows at none, nor
/// a value that is wrong together with its neighbours. Throws what `numbers` throws.
std::vector<double> interpolation_errors(
    const TabulatedProfile& table,
    const std::function<std::vector<double>(const Profile&, double mean_pressure)>& numbers);

}  // namespace slipstick::analytic
