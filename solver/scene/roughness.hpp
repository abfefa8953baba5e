#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "solver/grid/grid.hpp"

namespace slipstick::solver {

/// An isotropic self-affine random surface: plane waves whose wave vectors are whole multiples of 2 pi/period
/// along x1 and x2, of power proportional to |k|^(-2 (1 + hurst)) between two wavelengths, and of random
/// phase. Lengths in m, or any one unit.
struct Roughness {
  std::uint64_t seed = 0;
  double hurst = 0.0;      ///< above 0, at most 1
  double longest = 0.0;    ///< wavelength
  double shortest = 0.0;   ///< wavelength, at most half the longest: so there are waves between the two
  double rms_slope = 0.0;  ///< of the gradient's length, over a period
  double period = 0.0;     ///< at least the longest wavelength
};

/// Waves that fit into a period along one axis, period/shortest, are at most this many: a megapixel of them.
constexpr double kMostWaves = 1024.0;

/// Heights at cell centres, in the unit of the roughness and of the grid: the same surface on every mesh and
/// platform. Phases are drawn from long waves to short ones, so that a smaller `shortest` adds waves to those
/// that are there.
Eigen::ArrayXd roughness_heights(const Roughness& roughness, const Grid& grid);

/// Power per wave vector, averaged over a ring of wave vectors one fundamental one wide: its integral over
/// all wave vectors is the mean square height.
struct SpectrumRing {
  double wavelength;  ///< of the mean wave number
  double power;       ///< unit^4
};

/// What a surface of waves is, measured from its heights over one period.
struct RoughnessSpectrum {
  double rms_height;
  double rms_slope;
  double hurst;                     ///< from the slope of power over wavelength, both as logarithms
  std::vector<SpectrumRing> rings;  ///< from long waves to short ones, those that are there
};
RoughnessSpectrum measure_spectrum(const Roughness& roughness);

}  // namespace slipstick::solver
