#include "solver/scene/roughness.hpp"

#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <random>
#include <tuple>

#include "solver/fft/fftw.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// A wavelength that is a cut-off but for rounding belongs to the waves.
constexpr double kCutOffRounding = 1e-9;
/// Relative to the greatest power: below it lies what transforms leave where there is none.
constexpr double kNoPower = 1e-20;

/// A wave with the wave vector 2 pi/period (i, j); of each pair of opposite vectors only one is kept.
struct Wave {
  Index i;
  Index j;
  Index square() const { return i * i + j * j; }
};

/// Whole waves in a period along an axis, at most.
Index most_waves(const Roughness& roughness) {
  return static_cast<Index>(roughness.period / roughness.shortest * (1.0 + kCutOffRounding));
}

/// From long ones to short ones.
std::vector<Wave> waves_of(const Roughness& roughness) {
  const Index most = most_waves(roughness);
  const double fewest = roughness.period / roughness.longest * (1.0 - kCutOffRounding);
  const double more = roughness.period / roughness.shortest * (1.0 + kCutOffRounding);
  std::vector<Wave> waves;
  for (Index i = 0; i <= most; ++i) {
    for (Index j = i == 0 ? 1 : -most; j <= most; ++j) {
      const Wave wave{i, j};
      const auto square = static_cast<double>(wave.square());
      if (square >= fewest * fewest && square <= more * more) waves.push_back(wave);
    }
  }
  std::sort(waves.begin(), waves.end(), [](const Wave& a, const Wave& b) {
    return std::tuple(a.square(), a.i, a.j) < std::tuple(b.square(), b.i, b.j);
  });
  return waves;
}

/// In [0, 2 pi), computed from the generator's bits, since the standard's distributions differ between platforms.
double draw_phase(std::mt19937_64& generator) {
  return 2.0 * std::numbers::pi * std::ldexp(static_cast<double>(generator() >> 11), -53);
}

/// Amplitude and phase of the waves: (i, j) at row i, column j + most_waves.
MatrixXcd amplitudes(const Roughness& roughness) {
  const Index most = most_waves(roughness);
  const double fundamental = 2.0 * std::numbers::pi / roughness.period;
  std::mt19937_64 generator(roughness.seed);
  MatrixXcd waves = MatrixXcd::Zero(most + 1, 2 * most + 1);
  double square_slope = 0.0;
  for (const Wave& wave : waves_of(roughness)) {
    const double number = fundamental * std::sqrt(static_cast<double>(wave.square()));
    const double amplitude = std::pow(number, -(1.0 + roughness.hurst));
    square_slope += 0.5 * amplitude * amplitude * number * number;
    waves(wave.i, wave.j + most) = std::polar(amplitude, draw_phase(generator));
  }
  return waves * (roughness.rms_slope / std::sqrt(square_slope));
}

/// exp(i k x) for each position x (rows) and each of `count` wave numbers from first * fundamental on.
MatrixXcd exponentials(const ArrayXd& positions, double fundamental, Index first, Index count) {
  return MatrixXcd::NullaryExpr(positions.size(), count, [&](Index row, Index column) {
    return std::polar(1.0, fundamental * static_cast<double>(first + column) * positions[row]);
  });
}

/// Least squares: how steeply y rises with x.
double slope_of(const ArrayXd& x, const ArrayXd& y) {
  const ArrayXd centred = x - x.mean();
  return (centred * y).sum() / centred.square().sum();
}

/// Squared modulus of each coefficient of a field's Fourier series over its period, n x (n/2 + 1).
ArrayXd series_power(const ArrayXd& field, int n) {
  const int half = n / 2 + 1;
  const auto samples = static_cast<std::size_t>(field.size());
  FftwBuffer in(samples);
  FftwBuffer out(2 * static_cast<std::size_t>(n) * static_cast<std::size_t>(half));
  const FftwPlan plan(fftw_plan_dft_r2c_2d(n, n, in.data(), out.complex(), FFTW_ESTIMATE));
  std::copy_n(field.data(), samples, in.data());
  fftw_execute_dft_r2c(plan.get(), in.data(), out.complex());
  const Eigen::Map<const ArrayXd, 0, Eigen::InnerStride<2>> real(out.data(), Index{n} * half);
  const Eigen::Map<const ArrayXd, 0, Eigen::InnerStride<2>> imaginary(out.data() + 1, Index{n} * half);
  return (real.square() + imaginary.square()) / std::pow(n, 4);
}

}  // namespace

ArrayXd roughness_heights(const Roughness& roughness, const Grid& grid) {
  const MatrixXcd waves = amplitudes(roughness);
  const double fundamental = 2.0 * std::numbers::pi / roughness.period;
  const Index most = most_waves(roughness);
  const ArrayXd x1 = ArrayXd::NullaryExpr(grid.n1, [&](Index i) { return grid.x1(i); });
  const ArrayXd x2 = ArrayXd::NullaryExpr(grid.n2, [&](Index j) { return grid.x2(j); });
  const MatrixXcd along_1 = exponentials(x1, fundamental, 0, waves.rows()) * waves;
  const MatrixXcd along_2 = exponentials(x2, fundamental, -most, waves.cols());
  ArrayXd heights(grid.cells());
  Eigen::Map<RowMajorMatrix> matrix(heights.data(), grid.n1, grid.n2);
  matrix.noalias() = along_1.real() * along_2.real().transpose();
  matrix.noalias() -= along_1.imag() * along_2.imag().transpose();
  return heights;
}

RoughnessSpectrum measure_spectrum(const Roughness& roughness) {
  const Index n = fast_length(2 * most_waves(roughness) + 2);
  const double spacing = roughness.period / static_cast<double>(n);
  const ArrayXd power = series_power(roughness_heights(roughness, {n, n, spacing, spacing}), static_cast<int>(n));
  const double fundamental = 2.0 * std::numbers::pi / roughness.period;

  struct Ring {
    double waves = 0.0;
    double power = 0.0;
    double number = 0.0;
  };
  std::map<long, Ring> rings;
  double square_height = 0.0;
  double square_slope = 0.0;
  const double least = kNoPower * power.maxCoeff();
  for (Index k = 0; k < power.size(); ++k) {
    if (!(power[k] > least)) continue;
    const Index i = k / (n / 2 + 1);
    const Index j = k % (n / 2 + 1);
    const auto n1 = static_cast<double>(std::min(i, n - i));
    const auto n2 = static_cast<double>(j);
    const double number = fundamental * std::hypot(n1, n2);
    const double images = j == 0 ? 1.0 : 2.0;  // the other half is this one's complex conjugate
    square_height += images * power[k];
    square_slope += images * power[k] * number * number;
    Ring& ring = rings[std::lround(std::hypot(n1, n2))];
    ring.waves += images;
    ring.power += images * power[k];
    ring.number += images * number;
  }

  if (rings.empty()) throw std::domain_error("a roughness without finite heights");
  RoughnessSpectrum spectrum{
      .rms_height = std::sqrt(square_height), .rms_slope = std::sqrt(square_slope), .hurst = 0.0, .rings = {}};
  ArrayXd log_wavelength(static_cast<Index>(rings.size()));
  ArrayXd log_power(log_wavelength.size());
  for (const auto& [radius, ring] : rings) {
    const auto row = static_cast<Index>(spectrum.rings.size());
    spectrum.rings.push_back({.wavelength = 2.0 * std::numbers::pi * ring.waves / ring.number,
                              .power = ring.power / ring.waves / (fundamental * fundamental)});
    log_wavelength[row] = std::log(spectrum.rings.back().wavelength);
    log_power[row] = std::log(spectrum.rings.back().power);
  }
  spectrum.hurst = 0.5 * slope_of(log_wavelength, log_power) - 1.0;
  return spectrum;
}

}  // namespace slipstick::solver
