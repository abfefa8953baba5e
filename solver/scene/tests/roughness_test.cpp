#include "solver/scene/roughness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "solver/tests/limits.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using std::numbers::pi;

Roughness rough() {
  return {.seed = 7, .hurst = 0.8, .longest = 2.5, .shortest = 0.3, .rms_slope = 0.1, .period = 10.0};
}

/// n x n cells over one period.
Grid over_a_period(const Roughness& roughness, Index n) {
  const double h = roughness.period / static_cast<double>(n);
  return {n, n, h, h};
}

/// Sums of some hundred waves, each with a phase of up to 2 pi 33 in its argument.
constexpr double kHeightRounding = 1e3 * kEpsilon;

/// The waves between a period and half of it, one by one: as many as one can write down.
TEST(Roughness, IsASumOfWaves) {
  const Roughness roughness{.seed = 3, .hurst = 0.4, .longest = 2.0, .shortest = 1.0, .rms_slope = 0.05, .period = 2.0};
  const std::vector<std::array<double, 2>> waves{{0, 1}, {1, 0}, {1, -1}, {1, 1}, {0, 2}, {2, 0}};
  std::mt19937_64 generator(3);
  const Grid grid{5, 4, 0.31, 0.17};
  ArrayXd expected = ArrayXd::Zero(grid.cells());
  double mean_square_slope = 0.0;
  for (const auto& [i, j] : waves) {
    const double number = pi * std::hypot(i, j);
    const double amplitude = std::pow(number, -1.4);
    const double phase = 2.0 * pi * static_cast<double>(generator() / 2048) / 0x1p53;
    expected += amplitude * (pi * i * cell_x1(grid) + pi * j * cell_x2(grid) + phase).cos();
    mean_square_slope += 0.5 * amplitude * amplitude * number * number;
  }
  expected *= 0.05 / std::sqrt(mean_square_slope);
  EXPECT_LE((roughness_heights(roughness, grid) - expected).abs().maxCoeff(), 100.0 * kEpsilon);
}

/// Parseval's identity, and differences of heights: centred ones of a wave k are off by (k h)^2/6.
TEST(Roughness, HasTheSlopeAskedFor) {
  const Roughness roughness = rough();
  const RoughnessSpectrum spectrum = measure_spectrum(roughness);
  EXPECT_NEAR(spectrum.rms_slope / roughness.rms_slope, 1.0, kHeightRounding);

  constexpr Index n = 400;
  const Grid grid = over_a_period(roughness, n);
  const ArrayXd z = roughness_heights(roughness, grid);
  EXPECT_NEAR(z.mean(), 0.0, kHeightRounding * spectrum.rms_height);
  EXPECT_NEAR(std::sqrt(z.square().mean()) / spectrum.rms_height, 1.0, kHeightRounding);
  double square_slope = 0.0;
  for (Index i = 0; i < n; ++i) {
    for (Index j = 0; j < n; ++j) {
      const auto at = [&](Index a, Index b) { return z[(a + n) % n * n + (b + n) % n]; };
      square_slope += std::pow(at(i + 1, j) - at(i - 1, j), 2.0) + std::pow(at(i, j + 1) - at(i, j - 1), 2.0);
    }
  }
  const double rms = std::sqrt(square_slope) / static_cast<double>(n) / (2.0 * grid.h1);
  const double shortest = 2.0 * pi * grid.h1 / roughness.shortest;
  EXPECT_LE(rms / roughness.rms_slope, 1.0);
  EXPECT_GE(rms / roughness.rms_slope, 1.0 - shortest * shortest / 6.0);
}

/// Power falls by |k|^(-2 (1 + hurst)) between the cut-offs. A ring's mean power is above that at its mean
/// wave number by p (p + 1)/2 times the relative variance of wave numbers in it, at most 1/(12 * 4^2) in the
/// narrowest: less than 0.04, against a fall by 2^(2 (1 + hurst) * 3) over three octaves.
TEST(Roughness, HasTheSpectrumAskedFor) {
  for (const double hurst : {0.3, 0.8, 1.0}) {
    Roughness roughness = rough();
    roughness.hurst = hurst;
    const RoughnessSpectrum spectrum = measure_spectrum(roughness);
    EXPECT_NEAR(spectrum.hurst, hurst, 0.5 * 0.04 / std::log(8.0));
    EXPECT_NEAR(spectrum.rings.front().wavelength, roughness.longest, 0.1 * roughness.longest);
    EXPECT_LE(spectrum.rings.front().wavelength, roughness.longest);
    EXPECT_NEAR(spectrum.rings.back().wavelength, roughness.shortest, 0.1 * roughness.shortest);
    EXPECT_GE(spectrum.rings.back().wavelength, roughness.shortest);
    // The rings' power over all wave vectors is the mean square height: rings of width 2 pi/period.
    const double width = 2.0 * pi / roughness.period;
    double square_height = 0.0;
    for (const SpectrumRing& ring : spectrum.rings) {
      square_height += ring.power * 2.0 * pi * (2.0 * pi / ring.wavelength) * width;
    }
    EXPECT_NEAR(square_height / (spectrum.rms_height * spectrum.rms_height), 1.0, 0.1)
        << "the outermost rings are not full";
  }
}

/// Waves are orthogonal over a period: what the finer surface has of the coarser one is its long waves.
TEST(Roughness, KeepsItsLongWavesWhereShorterOnesAreAdded) {
  Roughness roughness = rough();
  const Grid grid = over_a_period(roughness, 80);
  const ArrayXd long_waves = roughness_heights(roughness, grid);
  const double long_power = measure_spectrum(roughness).rings.front().power;
  roughness.shortest *= 0.9;
  const ArrayXd all = roughness_heights(roughness, grid);
  const double share = (all * long_waves).sum() / long_waves.square().sum();
  EXPECT_LT(share, 1.0);  // the slope is shared with the short ones
  EXPECT_NEAR(share * share * long_power / measure_spectrum(roughness).rings.front().power, 1.0, 1e-9);
}

/// A cut-off is the same whatever the unit of length: 1/3 of a period, here and in units a third as long.
TEST(Roughness, ScalesWithItsUnit) {
  Roughness roughness = rough();
  roughness.longest = roughness.period / 3.0;
  const Grid grid = over_a_period(roughness, 20);
  const ArrayXd heights = roughness_heights(roughness, grid);
  for (double* const length : {&roughness.longest, &roughness.shortest, &roughness.period}) *length *= 3.0;
  const ArrayXd scaled = roughness_heights(roughness, over_a_period(roughness, 20));
  EXPECT_LE((scaled - 3.0 * heights).abs().maxCoeff(), kHeightRounding * scaled.abs().maxCoeff());
}

}  // namespace
}  // namespace slipstick::solver
