#pragma once

#include <functional>
#include <vector>

#include "analytic/tabulated_pressure.hpp"

namespace slipstick::analytic {

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
