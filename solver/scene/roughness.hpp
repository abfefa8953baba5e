#pragma once

#include <Eigen/Core>
#include <vector>

#include "solver/grid/grid.hpp"
#include "solver/scene/surface.hpp"

namespace slipstick::solver {

/// Waves that fit into a period along one axis, period/shortest, are at most this many: a megapixel of them.
constexpr double kMaxWaves = 1024.0;

/// Heights at cell centres, in the unit of the roughness and of the grid: the same surface on every mesh and platform.
/// Phases are drawn from long waves to short ones, so that a smaller `shortest` adds waves to those that are there.
Eigen::ArrayXd roughness_heights(const Roughness& roughness, const Grid& grid);

/// Power per wave vector, averaged over a ring of wave vectors one fundamental one wide: its integral over
/// all wave vectors is the mean square height.
struct SpectrumRing {
  double wavelength;  ///< of the mean wave number
  double power;       ///< unit^4
};

/// Properties of a surface of waves, measured from its heights over one period.
struct RoughnessSpectrum {
  double rms_height;
  double rms_slope;
  double hurst;                     ///< from the slope of power over wavelength, both as logarithms
  std::vector<SpectrumRing> rings;  ///< from long waves to short ones; empty rings are omitted
};
RoughnessSpectrum measure_spectrum(const Roughness& roughness);

}  // namespace slipstick::solver
