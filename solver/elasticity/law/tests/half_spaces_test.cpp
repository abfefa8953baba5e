#include "solver/elasticity/law/half_spaces.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "solver/elasticity/law/cell_integrals.hpp"

namespace slipstick::solver {
namespace {

using std::numbers::pi;

constexpr HalfSpace kLower{1.0, 0.3};
constexpr HalfSpace kUpper{2.5, 0.1};
constexpr double kRigid = std::numeric_limits<double>::infinity();

/// A few roundings.
constexpr double kRounding = 1e-15;
/// The relative error that cell_integrals() promises.
constexpr double kPromised = 1e-13;

/// Displacement of one half-space at (x, y) from a unit force at the origin: Cerruti and Boussinesq (Johnson
/// 1985, Eqs. 3.75 and 3.18), with the pressure's tangential displacement pointing to the force.
double point_load(Component component, const HalfSpace& body, double x, double y) {
  const double rho = std::hypot(x, y);
  const double nu = body.poisson_ratio;
  const double factor = 1.0 / (2.0 * pi * body.shear_modulus);
  switch (component) {
    case Component::k11:
      return factor * ((1.0 - nu) / rho + nu * x * x / (rho * rho * rho));
    case Component::k22:
      return factor * ((1.0 - nu) / rho + nu * y * y / (rho * rho * rho));
    case Component::k12:
      return factor * nu * x * y / (rho * rho * rho);
    case Component::k13:
      return -0.5 * factor * (1.0 - 2.0 * nu) * x / (rho * rho);
    case Component::k23:
      return -0.5 * factor * (1.0 - 2.0 * nu) * y / (rho * rho);
    case Component::k33:
      return factor * (1.0 - nu) / rho;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

/// The same for a pair of bodies: the upper one's displacement is subtracted, and the traction on it is the
/// opposite one along the surface; the pressure pushes both bodies apart alike.
double pair_point_load(Component component, double x, double y) {
  const double opposite = component == Component::k13 || component == Component::k23 ? -1.0 : 1.0;
  return point_load(component, kLower, x, y) + opposite * point_load(component, kUpper, x, y);
}

double coefficient(Component component, const ElasticPair& pair, double h1, double h2, Index k1, Index k2) {
  return HalfSpaces(pair).influence_coefficients(component, {k1 + 1, k2 + 1, h1, h2}).back();
}

// --- quadruple precision ---

__extension__ typedef __float128 Quad;  // NOLINT(modernize-use-using): __extension__ needs the declaration

// Functions of libquadmath. Its header stands where only GCC finds it.
extern "C" {
Quad asinhq(Quad x);
Quad atanq(Quad x);
Quad fabsq(Quad x);
Quad logq(Quad x);
Quad sqrtq(Quad x);
}

/// Love's closed form. At 8,192 cells it cancels about 1e9 of the 1e34 that quadruple precision has.
template <typename Function>
Quad corner_difference(const Function& f, Quad x, Quad y, Quad h1, Quad h2) {
  const Quad half = static_cast<Quad>(0.5);
  return f(x + half * h1, y + half * h2) - f(x - half * h1, y + half * h2) - f(x + half * h1, y - half * h2) +
         f(x - half * h1, y - half * h2);
}

/// d2/dxdy of it is x^2/rho^3.
Quad y_asinh(Quad x, Quad y) { return y == 0 ? 0 : y * asinhq(x / fabsq(y)); }
/// d2/dxdy of it is x/rho^2.
Quad log_arctan(Quad x, Quad y) { return (y == 0 ? 0 : y * logq(x * x + y * y) / 2) + (x == 0 ? 0 : x * atanq(y / x)); }

std::array<double, 5> exact_integrals(double x, double y, double h1, double h2) {
  const auto of = [&](const auto& f) { return static_cast<double>(corner_difference(f, x, y, h1, h2)); };
  return {of(y_asinh), of([](Quad u, Quad v) { return y_asinh(v, u); }),
          of([](Quad u, Quad v) { return -sqrtq(u * u + v * v); }), of(log_arctan),
          of([](Quad u, Quad v) { return log_arctan(v, u); })};
}

std::array<double, 5> as_array(const CellIntegrals& c) { return {c.xx, c.yy, c.xy, c.x, c.y}; }
constexpr std::array<Parity, 5> kIntegralParity{Parity{1, 1}, {1, 1}, {-1, -1}, {-1, 1}, {1, -1}};

/// Largest relative error of the five integrals, of the first two relative to their sum. Integrals that are
/// odd across an axis on which the cell lies must be 0.
double worst_error(double x, double y, double h1, double h2) {
  const auto computed = as_array(cell_integrals(x, y, h1, h2));
  const auto exact = exact_integrals(x, y, h1, h2);
  double worst = 0.0;
  for (std::size_t i = 0; i < computed.size(); ++i) {
    const bool vanishes = (x == 0.0 && kIntegralParity[i].x1 < 0) || (y == 0.0 && kIntegralParity[i].x2 < 0);
    const double scale = vanishes ? 1.0 : i < 2 ? exact[0] + exact[1] : std::abs(exact[i]);
    const double error = std::abs(computed[i] - (vanishes ? 0.0 : exact[i])) / scale;
    worst = error <= worst ? worst : error;  // keeps NaN
  }
  return worst;
}

/// Every offset 0..40, where the closed form gives way to quadrature, then fewer, up to 8,192.
std::vector<Index> sweep_offsets() {
  std::vector<Index> offsets;
  for (Index k = 0; k <= 40; ++k) offsets.push_back(k);
  for (Index k = 47; k < 8192; k += k * 37 / 100) offsets.push_back(k);
  offsets.push_back(8192);
  return offsets;
}

class FarCells : public testing::TestWithParam<double> {};

TEST_P(FarCells, AgreeWithQuadruplePrecisionUpTo8192Cells) {
  const double aspect = GetParam();
  const auto offsets = sweep_offsets();
  for (const Index k1 : offsets) {
    for (const Index k2 : offsets) {
      const double error = worst_error(static_cast<double>(k1), static_cast<double>(k2) * aspect, 1.0, aspect);
      ASSERT_LE(error, kPromised) << "cell (" << k1 << ", " << k2 << ")";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Aspects, FarCells, testing::Values(1.0, 2.0, 0.3, 5.0, 1.4, 0.7, 1.499, 1.0 / 37.0));

/// Tested on the point loads themselves, so that the table cannot be wrong together with the coefficients.
TEST(Influence, ParityIsThatOfThePointLoads) {
  for (const Component component : kAllComponents) {
    const double reference = pair_point_load(component, 0.8, 0.3);
    EXPECT_DOUBLE_EQ(pair_point_load(component, -0.8, 0.3), parity(component).x1 * reference);
    EXPECT_DOUBLE_EQ(pair_point_load(component, 0.8, -0.3), parity(component).x2 * reference);
  }
  EXPECT_EQ(parity(Component::k12).x1, -1);
  EXPECT_EQ(parity(Component::k12).x2, -1);
}

void expect_coefficients(const ElasticPair& pair, double factor, const ElasticPair& reference, double coupling_factor) {
  for (const Component component : kAllComponents) {
    const bool coupling = component == Component::k13 || component == Component::k23;
    const auto computed = HalfSpaces(pair).influence_coefficients(component, {6, 5, 1.0, 1.3});
    const auto expected = HalfSpaces(reference).influence_coefficients(component, {6, 5, 1.0, 1.3});
    for (std::size_t i = 0; i < computed.size(); ++i) {
      EXPECT_NEAR(computed[i], (coupling ? coupling_factor : factor) * expected[i],
                  kRounding * std::abs(expected[0] + 1));
    }
  }
}

TEST(Influence, ExchangeOfTheBodiesTurnsOnlyTheCoupling) {
  expect_coefficients(elastic_pair(kUpper, kLower), 1.0, elastic_pair(kLower, kUpper), -1.0);
  EXPECT_NE(elastic_pair(kUpper, kLower).mismatch, 0.0);
}

TEST(Influence, OfEqualBodiesIsTwiceThatOfOneAndHasNoCoupling) {
  const ElasticPair one = elastic_pair(kLower, {kRigid, 0.0});
  expect_coefficients(elastic_pair(kLower, kLower), 2.0, one, 0.0);
  EXPECT_EQ(elastic_pair(kLower, kLower).mismatch, 0.0);
}

TEST(Influence, OfIncompressibleOrProportionateBodiesHasNoCoupling) {
  EXPECT_EQ(elastic_pair({1.0, 0.5}, {7.0, 0.5}).mismatch, 0.0);
  // Dundurs' beta vanishes where (1 - 2 nu)/G agree: 0.5/1 = 1/2.
  EXPECT_EQ(elastic_pair({1.0, 0.25}, {2.0, 0.0}).mismatch, 0.0);
}

/// Far off a cell's traction is a point load, up to (1/200)^2.
TEST(Influence, OfAFarCellIsThatOfAPointLoad) {
  const ElasticPair both = elastic_pair(kLower, kUpper);
  for (const Component component : kAllComponents) {
    EXPECT_NEAR(coefficient(component, both, 1.0, 1.0, 200, 100) / pair_point_load(component, 200.0, 100.0), 1.0, 1e-4);
    for (const double poisson_of_rigid : {0.0, 0.2, 0.5}) {
      const ElasticPair one = elastic_pair(kLower, {kRigid, poisson_of_rigid});
      EXPECT_NEAR(coefficient(component, one, 1.0, 1.0, 200, 100) / point_load(component, kLower, 200.0, 100.0), 1.0,
                  1e-4);
    }
  }
}

TEST(Influence, EffectiveModuliAreThoseOfTheLiterature) {
  const ElasticPair pair = elastic_pair(kLower, kUpper);
  const auto plane_strain = [](const HalfSpace& body) {  // (1 - nu^2)/E with E = 2 G (1 + nu)
    return (1.0 - body.poisson_ratio * body.poisson_ratio) / (2.0 * body.shear_modulus * (1.0 + body.poisson_ratio));
  };
  EXPECT_DOUBLE_EQ(pair.effective_modulus(), 1.0 / (plane_strain(kLower) + plane_strain(kUpper)));
  EXPECT_DOUBLE_EQ(pair.shear_modulus(), 1.0 / (1.0 / kLower.shear_modulus + 1.0 / kUpper.shear_modulus));
}

/// Each component composed of the cell integrals (Johnson 1985, section 3.6), in kAllComponents' order.
std::array<double, 6> composed(const ElasticPair& pair, const CellIntegrals& c) {
  const double half = 0.5 / std::numbers::pi;
  const double shear = half * pair.shear_compliance;
  const double poisson = half * pair.poisson_compliance;
  return {shear * c.xx + (shear - poisson) * c.yy, poisson * c.xy,
          shear * c.yy + (shear - poisson) * c.xx, -0.5 * half * pair.mismatch * c.x,
          -0.5 * half * pair.mismatch * c.y,       half * pair.normal_compliance * (c.xx + c.yy)};
}

/// Tables of any shape: square cells are mirrored about the diagonal in groups of rows, and one group may
/// cross it; threads share the rows, and no value may be written by two of them.
TEST(InfluenceTables, HoldTheIntegralsOfEachOffsetOnAnyNumberOfThreads) {
  const ElasticPair pair = elastic_pair({1.0, 0.3}, {2.5, 0.1});
  const HalfSpaces law(pair);
  for (const double aspect : {1.0, 0.3}) {
    for (const auto& [m1, m2] :
         {std::pair<Index, Index>{1, 1}, {3, 21}, {21, 3}, {17, 17}, {24, 24}, {77, 21}, {61, 61}, {93, 42}}) {
      const Grid offsets{m1, m2, 1.0, aspect};
      const auto tables = law.influence_tables(kAllComponents, offsets, 1);
      ASSERT_EQ(tables.size(), kAllComponents.size());
      for (Index k = 0; k < m1 * m2; ++k) {
        const auto expected = composed(
            pair, cell_integrals(static_cast<double>(k / m2), static_cast<double>(k % m2) * aspect, 1.0, aspect));
        for (std::size_t i = 0; i < tables.size(); ++i) {
          ASSERT_NEAR(tables[i][static_cast<std::size_t>(k)], expected[i], kPromised * std::abs(expected[i]));
        }
      }
      for (int round = 0; round < 5; ++round) {
        for (const int threads : {2, 3, 5})
          EXPECT_EQ(law.influence_tables(kAllComponents, offsets, threads), tables) << m1 << " x " << m2;
      }
    }
  }
}

/// Displacement at the middle of the traction exp(-r^2), given on cells of h by aspect h.
double middle_of_gaussian(Component component, const HalfSpaces& law, double h, double aspect) {
  const auto m1 = static_cast<Index>(6.5 / h);
  const auto m2 = static_cast<Index>(6.5 / (h * aspect));
  const auto table = law.influence_coefficients(component, {m1, m2, h, h * aspect});
  double sum = 0.0;
  for (Index k1 = 0; k1 < m1; ++k1) {
    for (Index k2 = 0; k2 < m2; ++k2) {
      const double x = h * static_cast<double>(k1);
      const double y = h * aspect * static_cast<double>(k2);
      const double images = (k1 > 0 ? 2.0 : 1.0) * (k2 > 0 ? 2.0 : 1.0);
      sum += images * std::exp(-x * x - y * y) * table[static_cast<std::size_t>(k1 * m2 + k2)];
    }
  }
  return sum;
}

/// 1/rho integrates to pi^(3/2), and both x^2/rho^3 and y^2/rho^3 to half of it.
TEST(CellTractions, AreRightToTheSecondOrderAndSmoothOnesToTheThird) {
  const ElasticPair pair = elastic_pair({1.0, 0.3}, {2.5, 0.1});
  const double potential = 0.5 * std::sqrt(std::numbers::pi);
  const double shear = (pair.shear_compliance - 0.5 * pair.poisson_compliance) * potential;
  for (const double aspect : {1.0, 0.7}) {
    for (const auto& [component, exact] : {std::pair{Component::k11, shear},
                                           {Component::k22, shear},
                                           {Component::k33, pair.normal_compliance * potential}}) {
      const auto error = [&, exact = exact, component = component](CellTraction traction, double h) {
        return std::abs(middle_of_gaussian(component, HalfSpaces(pair, traction), h, aspect) / exact - 1.0);
      };
      const double order_of_constant =
          std::log2(error(CellTraction::constant, 0.1) / error(CellTraction::constant, 0.05));
      EXPECT_NEAR(order_of_constant, 2.0, 0.1);
      EXPECT_GE(error(CellTraction::smooth, 0.1) / error(CellTraction::smooth, 0.05), 7.0);
      EXPECT_LE(error(CellTraction::smooth, 0.05), 0.1 * error(CellTraction::constant, 0.05));
    }
  }
}

}  // namespace
}  // namespace slipstick::solver
