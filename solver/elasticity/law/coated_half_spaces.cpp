#include "solver/elasticity/law/coated_half_spaces.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "solver/cache/solve_cache.hpp"
#include "solver/elasticity/law/cell_integrals.hpp"
#include "solver/grid/threads.hpp"

namespace slipstick::solver {
namespace {

constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// Orders of Bessel's function in the radial functions: of K33; the mean of K11 and K22; half their
/// difference along x1, which turns with twice the angle; K13 and K23 along the offset.
constexpr std::array kBesselOrders{0, 0, 2, 1};

/// Cells are divided until their distance from the singularities, two thicknesses away from the surface, is
/// at least kMinOffset sides. Then at most kMaxPoints Gauss points leave kRuleError.
constexpr double kMinOffset = 1.75;
constexpr std::size_t kMaxPoints = 10;
constexpr double kRuleError = 1e-14;

/// n points leave (4 offset - 2)^(-2n) of a coefficient that itself falls like 1/offset (Trefethen, SIAM
/// Review 50, 2008, theorem 4.5).
const GaussRule& rule_for(double offset) {
  static const std::vector<GaussRule> rules = [] {
    std::vector<GaussRule> made;
    for (std::size_t n = 1; n <= kMaxPoints; ++n) made.push_back(make_gauss_rule(static_cast<int>(n)));
    return made;
  }();
  const double gained = (4.0 * offset - 2.0) * (4.0 * offset - 2.0);
  std::size_t points = 1;
  for (double left = 1.0 / (offset * gained); left > kRuleError && points < kMaxPoints; left /= gained) ++points;
  return rules[points - 1];
}

using CellSums = std::array<double, 6>;  // of K11, K12, K22, K13, K23, K33, the order of Component

/// Adds what the bases add to the cell h1 x h2 centred at offset (x, y), lengths in units of the thinner layer.
void add_cell(CellSums& sums, const HankelTable& table, double x, double y, double h1, double h2) {
  const double reach = std::sqrt(x * x + y * y + 4.0);
  if (std::max(h1, h2) * kMinOffset > reach) {
    const double d1 = h1 >= h2 ? 0.25 * h1 : 0.0;
    const double d2 = h1 >= h2 ? 0.0 : 0.25 * h2;
    for (const double side : {-1.0, 1.0})
      add_cell(sums, table, x + side * d1, y + side * d2, h1 - 2.0 * d1, h2 - 2.0 * d2);
    return;
  }
  const GaussRule& rule1 = rule_for(reach / h1);
  const GaussRule& rule2 = rule_for(reach / h2);
  for (std::size_t i = 0; i < rule1.node.size(); ++i) {
    for (std::size_t j = 0; j < rule2.node.size(); ++j) {
      const double u = x + h1 * rule1.node[i];
      const double v = y + h2 * rule2.node[j];
      const double r = std::sqrt(u * u + v * v);
      // At r = 0 what has a direction is zero.
      const double n1 = r > 0.0 ? u / r : 0.0;
      const double n2 = r > 0.0 ? v / r : 0.0;
      const HankelTable::Values f = h1 * h2 * rule1.weight[i] * rule2.weight[j] * table.at(r);
      const double turned = f[2] * (n1 * n1 - n2 * n2);
      const CellSums point{f[1] + turned, 2.0 * f[2] * n1 * n2, f[1] - turned, f[3] * n1, f[3] * n2, f[0]};
      for (std::size_t c = 0; c < sums.size(); ++c) sums[c] += point[c];
    }
  }
}

/// Adds what the bases add to tables. A cell of a square grid whose mirror about the diagonal is in the grid
/// writes that too.
void add_bases(Tables& tables, std::span<const Component> components, const Grid& offsets, double thickness,
               const HankelTable& table, int threads) {
  const double h1 = offsets.h1 / thickness;
  const double h2 = offsets.h2 / thickness;
  const auto write = [&](Index k1, Index k2, const CellSums& sums) {
    for (std::size_t c = 0; c < components.size(); ++c)
      tables[c][static_cast<std::size_t>(k1 * offsets.n2 + k2)] +=
          thickness * sums[static_cast<std::size_t>(components[c])];
  };
  const auto add_row = [&](Index k1) {
    const bool mirrored = h1 == h2 && k1 < offsets.n2;
    for (Index k2 = mirrored ? k1 : 0; k2 < offsets.n2; ++k2) {
      CellSums s{};
      add_cell(s, table, static_cast<double>(k1) * h1, static_cast<double>(k2) * h2, h1, h2);
      // Odd: exactly zero on the axes.
      if (k1 == 0) s[1] = s[3] = 0.0;
      if (k2 == 0) s[1] = s[4] = 0.0;
      write(k1, k2, s);
      if (mirrored && k1 < k2 && k2 < offsets.n1) write(k2, k1, {s[2], s[1], s[0], s[4], s[3], s[5]});
    }
  };
  // From both ends in turn, so that threads share the triangle evenly.
  in_parts(threads, offsets.n1, [&](int, Index begin, Index end) {
    for (Index i = begin; i < end; ++i) add_row(i % 2 == 0 ? i / 2 : offsets.n1 - 1 - i / 2);
  });
}

/// Sampled wave numbers: ratio of neighbours, between which the compliance is smooth, and their count from
/// 100 over the thinner layer's thickness down to far below its scale.
constexpr double kWaveRatio = 1.25, kLargestWave = 100.0;
constexpr int kWaves = 150;
/// Bodies differ by more than this part of their compliance: data have twelve digits.
constexpr double kAlike = 1e-12;

}  // namespace

CoatedHalfSpaces::CoatedHalfSpaces(const CoatedBody& lower, const CoatedBody& upper, CellTraction cell_traction)
    : lower_(lower),
      upper_(upper),
      layers_(elastic_pair(lower.surface, upper.surface)),
      cell_traction_(cell_traction),
      thickness_(std::min(lower.thickness, upper.thickness)),
      couples_(layers_.couples()) {
  if (std::isinf(thickness_)) return;
  double wave = kLargestWave / thickness_;
  for (int i = 0; i < kWaves; ++i, wave /= kWaveRatio) {
    const WaveCompliance pair = compliance(wave);
    couples_ = couples_ || std::abs(pair.coupling) > kAlike * pair.across;
  }
  radial_ = HankelTable::of(kBesselOrders, [this](double x) { return beyond_layers(x); });
}

WaveCompliance CoatedHalfSpaces::compliance(double wave_number) const {
  const WaveCompliance lower = wave_compliance(lower_, wave_number);
  const WaveCompliance upper = wave_compliance(upper_, wave_number);
  return {lower.across + upper.across, lower.along + upper.along, lower.normal + upper.normal,
          lower.coupling - upper.coupling};
}

/// A tangential symbol T (I - n n^T) + L n n^T is the mean of T and L and, towards twice the angle of n, half
/// of L - T; the transforms turn the sign of that, and of the coupling.
HankelTable::Values CoatedHalfSpaces::beyond_layers(double x) const {
  const WaveCompliance whole = compliance(x / thickness_);
  const WaveCompliance layers = compliance(kInfinite);
  const double across = whole.across - layers.across;
  const double along = whole.along - layers.along;
  constexpr double kOverTwoPi = 0.5 / std::numbers::pi;
  return {kOverTwoPi * (whole.normal - layers.normal), 0.5 * kOverTwoPi * (across + along),
          0.5 * kOverTwoPi * (across - along), kOverTwoPi * (layers.coupling - whole.coupling)};
}

Tables CoatedHalfSpaces::influence_tables(std::span<const Component> components, const Grid& offsets,
                                          int threads) const {
  return tables_of(cell_traction_, components, offsets, [&](const Grid& grid) {
    Tables tables = layers_.influence_tables(components, grid, threads);
    if (radial_) add_bases(tables, components, grid, thickness_, *radial_, threads);
    return tables;
  });
}

void CoatedHalfSpaces::inverse_symbols(bool tangential, double h1, double h2, std::span<const PlaneWave> waves,
                                       std::span<Symbol> inverses) const {
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const auto [xi1, xi2, length] = waves[i];
    const double modulus = length / sharpening(cell_traction_, xi1 * h1, xi2 * h2);
    const WaveCompliance pair = compliance(length);
    if (!tangential) {
      inverses[i] = {modulus / pair.normal, 0.0, 0.0};
      continue;
    }
    const double across = modulus / pair.across;
    const double excess = modulus / pair.along - across;
    const double n1 = xi1 / length;
    const double n2 = xi2 / length;
    inverses[i] = {across + excess * n1 * n1, excess * n1 * n2, across + excess * n2 * n2};
  }
}

double CoatedHalfSpaces::least_eigenvalue(double h1, double h2) const {
  constexpr double kEigenvalueOfWave = 0.9;
  double least = kInfinite;
  double wave = std::numbers::pi * std::hypot(1.0 / h1, 1.0 / h2);
  for (int i = 0; i < kWaves; ++i, wave /= kWaveRatio) {
    const WaveCompliance pair = compliance(wave);
    least = std::min(least, std::min(pair.across, pair.along) / wave);
  }
  return kEigenvalueOfWave * least;
}

void CoatedHalfSpaces::add_to(CacheKey& key) const {
  for (const CoatedBody* const body : {&lower_, &upper_}) {
    key.add(body->surface.shear_modulus).add(body->surface.poisson_ratio).add(body->thickness);
    key.add(body->base.shear_modulus).add(body->base.poisson_ratio);
  }
  key.add(cell_traction_);
}

}  // namespace slipstick::solver
