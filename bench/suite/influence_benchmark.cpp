// Influence coefficients of the tangential kernel at all offsets of a grid, with their error against
// Gauss-Legendre quadrature of the point loads over the cells.

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "analytic/gsl.hpp"
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

/// The unit cell's coefficients at an offset of two cells or more, where 16 points are exact to rounding.
double by_quadrature(const solver::ElasticPair& bodies, std::size_t component, double k1, double k2) {
  static const analytic::gsl::GaussRule rule(16);
  const auto over_x = [&](double y) {
    return rule([&](double x) { return point_load(bodies, x, y)[component]; }, k1 - 0.5, k1 + 0.5);
  };
  return rule(over_x, k2 - 0.5, k2 + 0.5);
}

/// The largest one at a few offsets near and far, relative to K11; where K12 is exactly zero included.
double error(const std::vector<std::vector<double>>& tables, const solver::ElasticPair& bodies, Index cells) {
  const Index last = cells - 1;
  double largest = 0.0;
  for (const auto& [k1, k2] : std::array<std::pair<Index, Index>, 6>{
           {{2, 0}, {0, 2}, {2, 1}, {last, 0}, {last / 2, last / 3 + 2}, {last, last}}}) {
    const auto expected = [&, x = static_cast<double>(k1), y = static_cast<double>(k2)](std::size_t c) {
      return by_quadrature(bodies, c, x, y);
    };
    for (std::size_t c = 0; c < kComponents.size(); ++c) {
      const double value = tables[c][static_cast<std::size_t>(k1 * cells + k2)];
      const double off = std::abs(value - expected(c)) / expected(0);
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
  const double coefficients = static_cast<double>(kComponents.size()) * static_cast<double>(cells * cells);
  return {.counters = {{"error", worst}, {"coefficients_per_second", rate(coefficients)}},
          .invalid_reason = worst <= kAllowedCoefficientError ? "" : "disagrees with quadrature",
          .timing = repeated([tables] { benchmark::DoNotOptimize(tables()); })};
}

}  // namespace

void add_influence_benchmarks(Suite& suite) {
  suite.add_sizes("influence/tangential", {8, 16, 32, 64, 128, 256, 512, 1024}, tangential);
}

}  // namespace slipstick::bench
