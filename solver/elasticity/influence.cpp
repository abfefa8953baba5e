#include "solver/elasticity/influence.hpp"

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <stdexcept>

#include "solver/elasticity/cell_integrals.hpp"
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

/// Of the second difference, along one axis, that is taken off a coefficient: a cell's mean of a field is the
/// value at its centre and so much of that.
constexpr double kSecondDifference = 1.0 / 24.0;

/// Of smooth cell tractions, from a table of constant ones that has one row and one column more.
std::vector<double> corrected(const std::vector<double>& constant, Parity sign, Index m1, Index m2) {
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

/// The same cell with the axes exchanged.
CellIntegrals exchanged(const CellIntegrals& c) { return {c.yy, c.xx, c.xy, c.y, c.x}; }

}  // namespace

ElasticPair elastic_pair(const HalfSpace& lower, const HalfSpace& upper) {
  const double lower_compliance = 1.0 / lower.shear_modulus;
  const double upper_compliance = 1.0 / upper.shear_modulus;
  return {
      .shear_compliance = lower_compliance + upper_compliance,
      .poisson_compliance = lower.poisson_ratio * lower_compliance + upper.poisson_ratio * upper_compliance,
      .normal_compliance =
          (1.0 - lower.poisson_ratio) * lower_compliance + (1.0 - upper.poisson_ratio) * upper_compliance,
      .mismatch = (1.0 - 2.0 * lower.poisson_ratio) * lower_compliance -
                  (1.0 - 2.0 * upper.poisson_ratio) * upper_compliance,
  };
}

double least_eigenvalue(const ElasticPair& pair, double h1, double h2) {
  constexpr double kMinOfSquareCells = 0.29;
  return kMinOfSquareCells * std::min(h1, h2) *
         std::min(pair.shear_compliance, pair.shear_compliance - pair.poisson_compliance);
}

Parity parity(Component component) {
  switch (component) {
    case Component::k12:
      return {-1, -1};
    case Component::k13:
      return {-1, 1};
    case Component::k23:
      return {1, -1};
    case Component::k11:
    case Component::k22:
    case Component::k33:
      return {1, 1};
  }
  throw std::logic_error("unknown component");
}

std::vector<std::vector<double>> influence_tables(std::span<const Component> components,
                                                  const ElasticPair& pair, double h1, double h2, Index m1,
                                                  Index m2, int threads) {
  if (pair.cell_traction == CellTraction::smooth) {
    ElasticPair constant = pair;
    constant.cell_traction = CellTraction::constant;
    auto smooth = influence_tables(components, constant, h1, h2, m1 + 1, m2 + 1, threads);
    for (std::size_t c = 0; c < components.size(); ++c) {
      smooth[c] = corrected(smooth[c], parity(components[c]), m1, m2);
    }
    return smooth;
  }
  std::vector<std::vector<double>> tables;
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
      integrate_row(rows[static_cast<std::size_t>(k1 - begin)], first / kLanes, static_cast<double>(k1) * h1,
                    0.0, h1, h2);
    }
    for (std::size_t c = 0; c < components.size(); ++c) {
      with_formula(components[c], pair, [&](const auto& formula) {
        for (Index k1 = begin; k1 < end; ++k1) {
          const CellRow& row = rows[static_cast<std::size_t>(k1 - begin)];
          for (Index k2 = first; k2 < m2; ++k2)
            tables[c][static_cast<std::size_t>(k1 * m2 + k2)] = formula(row[k2]);
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

std::vector<double> influence_coefficients(Component component, const ElasticPair& pair, double h1, double h2,
                                           Index m1, Index m2) {
  return influence_tables(std::span(&component, 1), pair, h1, h2, m1, m2).front();
}

}  // namespace slipstick::solver
