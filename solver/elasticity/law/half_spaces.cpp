#include "solver/elasticity/law/half_spaces.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <stdexcept>

#include "solver/cache/solve_cache.hpp"
#include "solver/elasticity/law/cell_integrals.hpp"
#include "solver/grid/threads.hpp"

namespace slipstick::solver {
namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

/// The component as a function of the cell integrals, given to `use`: one loop for each formula.
template <typename Use>
void with_formula(Component component, const ElasticPair& pair, const Use& use) {
  const double shear = pair.shear_compliance / kTwoPi;
  const double transverse = shear - pair.poisson_compliance / kTwoPi;
  const double poisson = pair.poisson_compliance / kTwoPi;
  const double normal = pair.normal_compliance / kTwoPi;
  const double mismatch = pair.mismatch / (2.0 * kTwoPi);
  switch (component) {
    case Component::k11:
      return use([=](const CellIntegrals& c) { return shear * c.xx + transverse * c.yy; });
    case Component::k12:
      return use([=](const CellIntegrals& c) { return poisson * c.xy; });
    case Component::k22:
      return use([=](const CellIntegrals& c) { return shear * c.yy + transverse * c.xx; });
    case Component::k13:
      return use([=](const CellIntegrals& c) { return -mismatch * c.x; });
    case Component::k23:
      return use([=](const CellIntegrals& c) { return -mismatch * c.y; });
    case Component::k33:
      return use([=](const CellIntegrals& c) { return normal * (c.xx + c.yy); });
  }
  throw std::logic_error("unknown component");
}

/// A cell's mean of a field is the value at its centre and this part of the second differences.
constexpr double kSecondDifference = 1.0 / 24.0;

/// The same cell with the axes exchanged.
CellIntegrals exchanged(const CellIntegrals& c) { return {c.yy, c.xx, c.xy, c.y, c.x}; }

/// The table of smooth cell tractions, m1 x m2, from one of constant ones. sign: the parity of its component.
std::vector<double> smooth_table(const std::vector<double>& constant, Parity sign, Index m1, Index m2) {
  const auto at = [&](Index k1, Index k2) {
    const int factor = (k1 < 0 ? sign.x1 : 1) * (k2 < 0 ? sign.x2 : 1);
    return factor * constant[static_cast<std::size_t>(std::abs(k1) * (m2 + 1) + std::abs(k2))];
  };
  std::vector<double> smooth;
  smooth.reserve(static_cast<std::size_t>(m1 * m2));
  for (Index k1 = 0; k1 < m1; ++k1) {
    for (Index k2 = 0; k2 < m2; ++k2) {
      const double around = at(k1 + 1, k2) + at(k1 - 1, k2) + at(k1, k2 + 1) + at(k1, k2 - 1);
      smooth.push_back(at(k1, k2) - kSecondDifference * (around - 4.0 * at(k1, k2)));
    }
  }
  return smooth;
}

}  // namespace

Tables tables_of(CellTraction cell_traction, std::span<const Component> components, const Grid& offsets,
                 const std::function<Tables(const Grid&)>& constant) {
  if (cell_traction == CellTraction::constant) return constant(offsets);
  Tables tables = constant({offsets.n1 + 1, offsets.n2 + 1, offsets.h1, offsets.h2});
  for (std::size_t c = 0; c < components.size(); ++c) {
    tables[c] = smooth_table(tables[c], parity(components[c]), offsets.n1, offsets.n2);
  }
  return tables;
}

double sharpening(CellTraction cell_traction, double phase1, double phase2) {
  if (cell_traction == CellTraction::constant) return 1.0;
  const double s1 = std::sin(0.5 * phase1);
  const double s2 = std::sin(0.5 * phase2);
  return 1.0 + (s1 * s1 + s2 * s2) / 6.0;
}

ElasticPair elastic_pair(const HalfSpace& lower, const HalfSpace& upper) {
  const double lower_compliance = 1.0 / lower.shear_modulus;
  const double upper_compliance = 1.0 / upper.shear_modulus;
  return {
      .shear_compliance = lower_compliance + upper_compliance,
      .poisson_compliance = lower.poisson_ratio * lower_compliance + upper.poisson_ratio * upper_compliance,
      .normal_compliance =
          (1.0 - lower.poisson_ratio) * lower_compliance + (1.0 - upper.poisson_ratio) * upper_compliance,
      .mismatch =
          (1.0 - 2.0 * lower.poisson_ratio) * lower_compliance - (1.0 - 2.0 * upper.poisson_ratio) * upper_compliance,
  };
}

Tables HalfSpaces::influence_tables(std::span<const Component> components, const Grid& offsets, int threads) const {
  return tables_of(cell_traction_, components, offsets,
                   [&](const Grid& grid) { return tables_of_constant(components, grid, threads); });
}

Tables HalfSpaces::tables_of_constant(std::span<const Component> components, const Grid& offsets, int threads) const {
  const Index m1 = offsets.n1;
  const Index m2 = offsets.n2;
  const double h1 = offsets.h1;
  const double h2 = offsets.h2;
  Tables tables;
  for (std::size_t c = 0; c < components.size(); ++c) tables.emplace_back(static_cast<std::size_t>(m1 * m2));
  // Rows are integrated in groups, so that mirrored ones are written by whole cache lines.
  constexpr Index kGroup = 8;
  // Square cells: what lies below the diagonal mirrors what lies above, in whole groups, so that no value is
  // written by two of them.
  const Index mirrored = h1 == h2 ? std::min(m1, m2) / kGroup * kGroup : 0;
  const auto set_rows = [&](std::vector<CellRow>& rows, Index begin) {
    const Index end = std::min(begin + static_cast<Index>(rows.size()), m1);
    const Index first = end <= mirrored ? begin : 0;
    for (Index k1 = begin; k1 < end; ++k1) {
      integrate_row(rows[static_cast<std::size_t>(k1 - begin)], first / kLanes, static_cast<double>(k1) * h1, 0.0, h1,
                    h2);
    }
    for (std::size_t c = 0; c < components.size(); ++c) {
      with_formula(components[c], pair_, [&](const auto& formula) {
        for (Index k1 = begin; k1 < end; ++k1) {
          const CellRow& row = rows[static_cast<std::size_t>(k1 - begin)];
          for (Index k2 = first; k2 < m2; ++k2) tables[c][static_cast<std::size_t>(k1 * m2 + k2)] = formula(row[k2]);
        }
        for (Index k2 = end; k2 < mirrored; ++k2) {
          double* const to = tables[c].data() + k2 * m2;
          for (Index k1 = begin; k1 < end; ++k1)
            to[k1] = formula(exchanged(rows[static_cast<std::size_t>(k1 - begin)][k2]));
        }
      });
    }
  };
  // From both ends, so that threads share the triangle evenly.
  const Index groups = (m1 + kGroup - 1) / kGroup;
  in_parts(threads, (groups + 1) / 2, [&](int, Index begin, Index end) {
    std::vector<CellRow> rows(kGroup, CellRow(m2));
    for (Index group = begin; group < end; ++group) {
      set_rows(rows, group * kGroup);
      if (group != groups - 1 - group) set_rows(rows, (groups - 1 - group) * kGroup);
    }
  });
  return tables;
}

void HalfSpaces::inverse_symbols(bool tangential, double h1, double h2, std::span<const PlaneWave> waves,
                                 std::span<Symbol> inverses) const {
  const double shear = pair_.shear_compliance;
  const double poisson = pair_.poisson_compliance;
  for (std::size_t i = 0; i < waves.size(); ++i) {
    const auto [xi1, xi2, length] = waves[i];
    const double modulus = length / sharpening(cell_traction_, xi1 * h1, xi2 * h2);
    if (!tangential) {
      inverses[i] = {modulus / pair_.normal_compliance, 0.0, 0.0};
      continue;
    }
    const double transverse = modulus / shear;
    const double n1 = xi1 / length;
    const double n2 = xi2 / length;
    const double excess = transverse * poisson / (shear - poisson);
    inverses[i] = {transverse + excess * n1 * n1, excess * n1 * n2, transverse + excess * n2 * n2};
  }
}

double HalfSpaces::least_eigenvalue(double h1, double h2) const {
  constexpr double kMinOfSquareCells = 0.29;  // times h/G; computed, 0.2903, and rounded down
  return kMinOfSquareCells * std::min(h1, h2) *
         std::min(pair_.shear_compliance, pair_.shear_compliance - pair_.poisson_compliance);
}

void HalfSpaces::add_to(CacheKey& key) const {
  key.add(pair_.shear_compliance).add(pair_.poisson_compliance).add(pair_.normal_compliance);
  key.add(pair_.mismatch).add(cell_traction_);
}

}  // namespace slipstick::solver
