#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <vector>

#include "solver/fft/padded_transform.hpp"
#include "solver/solution.hpp"
#include "solver/stresses/cell_stress.hpp"

namespace slipstick::solver {

/// One of the two bodies in contact. The tractions of a solution act on the lower body as they stand, on the
/// upper one with the opposite sign; the pressure presses into both.
enum class Body { lower, upper };

/// Stresses below the centres of the grid's cells, Pa; tension is positive. The axes x1 and x2 are the
/// grid's, x3 points into the body.
struct StressPlane {
  double depth;                                  ///< m, along x3
  std::array<Eigen::ArrayXd, kStresses> stress;  ///< n1*n2 values each: 11, 22, 33, 12, 13, 23
};

/// Stresses in one of two homogeneous elastic half-spaces under the tractions of a solution, which are taken
/// as constant over each cell: exact for such tractions, up to rounding. Two-dimensional convolution with the
/// closed influence coefficients of a cell (Love 1929, Cerruti), as by Liu and Wang (2002), "Studying contact
/// stress fields caused by surface tractions with a discrete convolution and fast Fourier transform
/// algorithm". Memory: 12 spectra of padded fields and 15 fields.
class SubsurfaceStresses {
 public:
  /// Throws std::invalid_argument for a grid that is a quadrant or that several ranks share.
  SubsurfaceStresses(const SolutionFields& fields, double poisson, Body body, int threads = 1);
  /// Throws std::domain_error unless depth > 0, m.
  StressPlane at(double depth);

 private:
  using Complex = std::complex<double>;
  using Field = std::vector<double>;

  std::array<Field, kStressKernels> quadrants(double depth) const;
  void add(std::size_t kernel, Field& quadrant);
  Index length() const { return transform_.padded1(); }  ///< numbers of a column's spectrum

  Grid grid_;
  double poisson_;
  PaddedTransform transform_;
  std::array<std::vector<Complex>, kTractions> tractions_;  ///< spectra, column by column; empty: zero
  std::array<std::vector<Complex>, kStresses> stresses_;
};

/// The stresses at one point, Pa, by the pressure and by the shear tractions.
struct PointStresses {
  std::array<double, kStresses> by_pressure{};
  std::array<double, kStresses> by_shear{};
};

/// As SubsurfaceStresses, at any points (x1, x2, depth above zero; m) and on one thread: a sum over the
/// corners of all cells that carry tractions. Both parts are linear in Poisson's ratio.
std::vector<PointStresses> stresses_at(const SolutionFields& fields, double poisson, Body body,
                                       const std::vector<std::array<double, 3>>& points);

/// Von Mises' stress of a tensor, or of a plane's.
template <typename Number>
Number von_mises(const std::array<Number, kStresses>& s) {
  const Number d1 = s[k11] - s[k22];
  const Number d2 = s[k22] - s[k33];
  const Number d3 = s[k33] - s[k11];
  const Number shear = s[k12] * s[k12] + s[k13] * s[k13] + s[k23] * s[k23];
  using std::sqrt;
  return sqrt(0.5 * (d1 * d1 + d2 * d2 + d3 * d3) + 3.0 * shear);
}

/// In ascending order.
Eigen::Vector3d principal_stresses(const std::array<double, kStresses>& s);

/// The largest numbers that criteria of yield and fracture compare with a strength, Pa, and where: x1, x2 and
/// depth, m. The first of equal ones is kept.
struct LargestStresses {
  struct Place {
    double value = -std::numeric_limits<double>::infinity();
    std::array<double, 3> at{};
  };
  Place von_mises;  ///< equivalent tensile stress
  Place tresca;     ///< largest less smallest principal stress
  Place tension;    ///< largest principal stress; negative: all are compressive

  void include(const StressPlane& plane, const Grid& grid);
};

}  // namespace slipstick::solver
