#include "solver/stresses/subsurface_stresses.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <stdexcept>

namespace slipstick::solver {
namespace {

const Grid& whole(const Grid& grid) {
  if (grid.quadrant || grid.ranks.several()) throw std::invalid_argument("stresses need a whole grid, on one rank");
  return grid;
}

/// The tractions on a body, which point along x3, x1 and x2.
std::array<Eigen::ArrayXd, kTractions> tractions_on(Body body, const SolutionFields& fields) {
  const double sign = body == Body::lower ? 1.0 : -1.0;
  const Index cells = fields.grid.cells();
  return {fields.pressure, sign * fields.traction.head(cells), sign * fields.traction.tail(cells)};
}

/// A corner of cells, and the second difference of the tractions about it: a kernel's sum over the cells is
/// the sum of these times its corner function.
struct LoadedCorner {
  double x1;
  double x2;
  std::array<double, kTractions> traction{};
};

std::vector<LoadedCorner> loaded_corners(const SolutionFields& fields, Body body) {
  const Grid& grid = whole(fields.grid);
  const auto tractions = tractions_on(body, fields);
  std::vector<LoadedCorner> corners;
  for (Index i = 0; i <= grid.n1; ++i) {
    for (Index j = 0; j <= grid.n2; ++j) {
      LoadedCorner corner{grid.x1(0) + (static_cast<double>(i) - 0.5) * grid.h1,
                          grid.x2(0) + (static_cast<double>(j) - 0.5) * grid.h2};
      bool loaded = false;
      for (std::size_t b = 0; b < kTractions; ++b) {
        const auto at = [&](Index k, Index l) {
          return k < 0 || l < 0 || k >= grid.n1 || l >= grid.n2 ? 0.0 : tractions[b][k * grid.n2 + l];
        };
        corner.traction[b] = at(i - 1, j - 1) - at(i, j - 1) - at(i - 1, j) + at(i, j);
        loaded = loaded || corner.traction[b] != 0.0;
      }
      if (loaded) corners.push_back(corner);
    }
  }
  return corners;
}

}  // namespace

std::vector<PointStresses> stresses_at(const SolutionFields& fields, double poisson, Body body,
                                       const std::vector<std::array<double, 3>>& points) {
  const std::vector<LoadedCorner> corners = loaded_corners(fields, body);
  std::vector<PointStresses> all;
  all.reserve(points.size());
  for (const auto& [x1, x2, depth] : points) {
    if (!(depth > 0.0)) throw std::domain_error("stresses are computed at depths above zero");
    PointStresses& sum = all.emplace_back();
    for (const LoadedCorner& corner : corners) {
      const KernelValues values = corner_function(x1 - corner.x1, x2 - corner.x2, depth, poisson);
      for (std::size_t k = 0; k < kStressKernels; ++k) {
        for (std::size_t u = 0; u < stress_kernels[k].count; ++u) {
          const auto& [traction, stress] = stress_kernels[k].influences[u];
          (traction == 0 ? sum.by_pressure : sum.by_shear)[stress] += corner.traction[traction] * values[k];
        }
      }
    }
  }
  return all;
}

SubsurfaceStresses::SubsurfaceStresses(const SolutionFields& fields, double poisson, Body body, int threads)
    : grid_(whole(fields.grid)), poisson_(poisson), transform_(grid_, 1, threads) {
  const Index cells = grid_.cells();
  const auto given = tractions_on(body, fields);
  const std::size_t size = count(transform_.columns() * length());
  for (std::size_t b = 0; b < kTractions; ++b) {
    if ((given[b] == 0.0).all()) continue;
    tractions_[b].resize(size);
    transform_.forward_rows({given[b].data(), count(cells)});
    transform_.through_columns(1, 0, [&](Index column, const PaddedTransform::Spectrum& spectrum) {
      Complex* const to = tractions_[b].data() + column * length();
      std::copy_n(spectrum.even[0], length() / 2, to);
      std::copy_n(spectrum.odd[0], length() / 2, to + length() / 2);
    });
  }
  for (auto& stress : stresses_) stress.resize(size);
}

/// The offsets are i, j >= 0; values are halved on the axes, where a quadrant's images coincide. A kernel is
/// a second difference of its corner function at half cells.
auto SubsurfaceStresses::quadrants(double depth) const -> std::array<Field, kStressKernels> {
  std::array<Field, kStressKernels> result;
  for (Field& field : result) field.resize(count(grid_.cells()));
  const auto corners = [&](Index i) {
    std::vector<KernelValues> row;
    const double x1 = (static_cast<double>(i) - 0.5) * grid_.h1;
    for (Index j = 0; j <= grid_.n2; ++j)
      row.push_back(corner_function(x1, (static_cast<double>(j) - 0.5) * grid_.h2, depth, poisson_));
    return row;
  };
  const double scale = 1.0 / static_cast<double>(transform_.padded1() * transform_.padded2());
  auto before = corners(0);
  for (Index i = 0; i < grid_.n1; ++i) {
    const auto after = corners(i + 1);
    for (Index j = 0; j < grid_.n2; ++j) {
      const double half = scale * (i == 0 ? 0.5 : 1.0) * (j == 0 ? 0.5 : 1.0);
      const auto at = count(j);
      for (std::size_t k = 0; k < kStressKernels; ++k) {
        const double first = before[at + 1][k] - before[at][k];
        result[k][count(i * grid_.n2 + j)] = half * (after[at + 1][k] - after[at][k] - first);
      }
    }
    before = after;
  }
  return result;
}

/// Adds a kernel's product with its tractions to the spectra of its stresses. With Q the quadrant's spectrum,
/// the kernel's is 2 Re or 2 i Im of Q(k1, k2) +- Q(-k1, k2).
void SubsurfaceStresses::add(std::size_t kernel, Field& quadrant) {
  const auto& [influences, uses, parity] = stress_kernels[kernel];
  if (tractions_[influences[0].traction].empty() && tractions_[influences[1].traction].empty()) return;
  transform_.forward_rows(quadrant);
  const Index m = length() / 2;
  const double sign = parity.x1;
  const bool real = parity.x1 == parity.x2;
  transform_.through_columns(1, 0, [&](Index column, const PaddedTransform::Spectrum& spectrum) {
    for (const bool odd : {false, true}) {
      const Complex* const q = odd ? spectrum.odd[0] : spectrum.even[0];
      const auto start = column * length() + (odd ? m : 0);
      for (std::size_t u = 0; u < uses; ++u) {
        const auto& traction = tractions_[influences[u].traction];
        if (traction.empty()) continue;
        const Complex* const from = traction.data() + start;
        Complex* const to = stresses_[influences[u].stress].data() + start;
        for (Index k = 0; k < m; ++k) {
          const Complex sum = q[k] + sign * q[odd ? m - 1 - k : (k == 0 ? 0 : m - k)];
          to[k] += real ? 2.0 * sum.real() * from[k] : 2.0 * sum.imag() * Complex(-from[k].imag(), from[k].real());
        }
      }
    }
  });
}

StressPlane SubsurfaceStresses::at(double depth) {
  if (!(depth > 0.0)) throw std::domain_error("stresses are computed at depths above zero");
  for (auto& stress : stresses_) std::fill(stress.begin(), stress.end(), Complex());
  auto fields = quadrants(depth);
  for (std::size_t kernel = 0; kernel < kStressKernels; ++kernel) add(kernel, fields[kernel]);
  StressPlane plane{depth, {}};
  for (std::size_t a = 0; a < kStresses; ++a) {
    transform_.through_columns(0, 1, [&](Index column, const PaddedTransform::Spectrum& spectrum) {
      const Complex* const from = stresses_[a].data() + column * length();
      std::copy_n(from, length() / 2, spectrum.even[0]);
      std::copy_n(from + length() / 2, length() / 2, spectrum.odd[0]);
    });
    plane.stress[a].resize(grid_.cells());
    transform_.backward_rows({plane.stress[a].data(), count(grid_.cells())});
  }
  return plane;
}

Eigen::Vector3d principal_stresses(const std::array<double, kStresses>& s) {
  Eigen::Matrix3d tensor;
  tensor << s[k11], s[k12], s[k13], s[k12], s[k22], s[k23], s[k13], s[k23], s[k33];
  return tensor.selfadjointView<Eigen::Lower>().eigenvalues();
}

/// Principal stresses are found only where they can be the largest: Tresca's number is at most 2/sqrt(3) of
/// von Mises', and the largest principal stress exceeds the mean by at most 2/3 of it.
void LargestStresses::include(const StressPlane& plane, const Grid& grid) {
  const auto keep = [&](Place& largest, double value, Index cell) {
    if (!(value <= largest.value) && !std::isnan(largest.value))  // NaN is kept
      largest = {value, {grid.x1(cell / grid.n2), grid.x2(cell % grid.n2), plane.depth}};
  };
  for (Index cell = 0; cell < grid.cells(); ++cell) {
    std::array<double, kStresses> s;
    for (std::size_t a = 0; a < kStresses; ++a) s[a] = plane.stress[a][cell];
    const double equivalent = solver::von_mises(s);
    keep(von_mises, equivalent, cell);
    const double mean = (s[k11] + s[k22] + s[k33]) / 3.0;
    if (1.155 * equivalent < tresca.value && mean + 0.667 * equivalent < tension.value) continue;
    const Eigen::Vector3d principal = principal_stresses(s);
    keep(tresca, principal[2] - principal[0], cell);
    keep(tension, principal[2], cell);
  }
}

}  // namespace slipstick::solver
