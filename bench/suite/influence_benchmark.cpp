// Influence coefficients of the tangential kernel at all offsets of a grid, beside their error against
// Gauss-Legendre quadrature of the point loads over the cells.

#include <gsl/gsl_integration.h>

#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "bench/suite/suite.hpp"
#include "solver/elasticity/law/half_spaces.hpp"

namespace slipstick::bench {
namespace {

using solver::Component;
using solver::Index;

constexpr std::array kComponents{Component::k11, Component::k12, Component::k22};
/// Relative error of a coefficient, 1e-13, and as much for the quadrature.
constexpr double kAllowedCoefficientError = 2e-13;

solver::ElasticPair pair() { return solver::elastic_pair({2.0, 0.3}, {2.0, 0.3}); }

/// Displacements by a unit force at the origin (Johnson 1985, Eq. 3.75), for both bodies together.
std::array<double, 3> point_load(const solver::ElasticPair& bodies, double x, double y) {
  const double rho = std::hypot(x, y);
  const double direct = bodies.shear_compliance - bodies.poisson_compliance;
  const double turned = bodies.poisson_compliance / (rho * rho);
  const double factor = 0.5 / (std::numbers::pi * rho);
  return {factor * (direct + turned * x * x), factor * turned * x * y, factor * (direct + turned * y * y)};
}

/// The unit cell's coefficients at an offset of two cells or more, where so many points leave rounding alone.
std::array<double, 3> by_quadrature(const solver::ElasticPair& bodies, Index k1, Index k2) {
  constexpr std::size_t kPoints = 16;
  const std::unique_ptr<gsl_integration_glfixed_table, decltype(&gsl_integration_glfixed_table_free)> table(
      gsl_integration_glfixed_table_alloc(kPoints), gsl_integration_glfixed_table_free);
  const auto point = [&](double middle, std::size_t i) {
    std::pair<double, double> at;  // and its weight
    gsl_integration_glfixed_point(middle - 0.5, middle + 0.5, i, &at.first, &at.second, table.get());
    return at;
  };
  std::array<double, 3> integrals{};
  for (std::size_t i = 0; i < kPoints; ++i) {
    const auto [x, weight1] = point(static_cast<double>(k1), i);
    for (std::size_t j = 0; j < kPoints; ++j) {
      const auto [y, weight2] = point(static_cast<double>(k2), j);
      const auto load = point_load(bodies, x, y);
      for (std::size_t c = 0; c < load.size(); ++c) integrals[c] += weight1 * weight2 * load[c];
    }
  }
  return integrals;
}

/// The largest one at a few offsets near and far, relative to K11; where K12 is exactly zero included.
double error(const std::vector<std::vector<double>>& tables, const solver::ElasticPair& bodies, Index cells) {
  const Index last = cells - 1;
  double largest = 0.0;
  for (const auto& [k1, k2] : std::array<std::pair<Index, Index>, 6>{
           {{2, 0}, {0, 2}, {2, 1}, {last, 0}, {last / 2, last / 3 + 2}, {last, last}}}) {
    const auto expected = by_quadrature(bodies, k1, k2);
    for (std::size_t c = 0; c < expected.size(); ++c) {
      const double value = tables[c][static_cast<std::size_t>(k1 * cells + k2)];
      const double off = std::abs(value - expected[c]) / expected[0];
      if (!(off <= largest)) largest = off;
    }
  }
  return largest;
}

Prepared tangential(Index cells) {
  const auto tables = [bodies = pair(), cells] {
    return solver::HalfSpaces(bodies).influence_tables(kComponents, {cells, cells, 1.0, 1.0});
  };
  const double worst = error(tables(), pair(), cells);
  Prepared prepared;
  prepared.counters["error"] = worst;
  prepared.counters["coefficients_per_second"] =
      rate(static_cast<double>(kComponents.size()) * static_cast<double>(cells * cells));
  if (!(worst <= kAllowedCoefficientError)) prepared.invalid_reason = "disagrees with quadrature";
  prepared.timing = repeated([tables] { benchmark::DoNotOptimize(tables()); });
  return prepared;
}

}  // namespace

void add_influence_benchmarks(Suite& suite) {
  for (const Index cells : {8, 16, 32, 64, 128, 256, 512, 1024}) {
    suite.add("influence/tangential/cells:" + std::to_string(cells), [cells] { return tangential(cells); });
  }
}

}  // namespace slipstick::bench
