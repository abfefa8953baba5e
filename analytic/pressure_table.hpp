#pragma once

#include <string>

#include "analytic/tabulated_pressure.hpp"

namespace slipstick::analytic {

/// From a CSV file: a radius and a pressure a line, perhaps under the header `radius,pressure`; empty lines
/// and lines that begin with # do not count. Throws as tabulated_profile() with file and line, and for a file
/// that cannot be read.
TabulatedProfile read_tabulated_profile(const std::string& file);

}  // namespace slipstick::analytic
