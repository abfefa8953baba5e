#include "solver/elasticity/law/half_spaces.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_integration.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>

#include "solver/elasticity/law/cell_integrals.hpp"
#include "solver/elasticity/law/tests/components.hpp"

namespace slipstick::solver {
namespace {

using std::numbers::pi;

/// h2/h1 of the cells under test.
constexpr std::array kAspects{1.0, 2.0, 0.3, 5.0};
constexpr HalfSpace kLower{1.0, 0.3};
constexpr HalfSpace kUpper{2.5, 0.1};
constexpr double kRigid = std::numeric_limits<double>::infinity();

/// The adaptive quadrature asks for a relative error of 1e-13 in each of two dimensions.
constexpr double kQuadrature = 1e-12;
/// A few roundings.
constexpr double kRounding = 1e-15;

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

/// Adaptive Gauss-Kronrod quadrature of any callable.
template <typename Function>
double integrate(const Function& f, double low, double high) {
  constexpr std::size_t kIntervals = 200;
  constexpr double kRelative = 1e-13;
  const std::unique_ptr<gsl_integration_workspace, decltype(&gsl_integration_workspace_free)> workspace(
      gsl_integration_workspace_alloc(kIntervals), gsl_integration_workspace_free);
  gsl_function function{[](double x, void* callable) { return (*static_cast<const Function*>(callable))(x); },
                        const_cast<Function*>(&f)};
  double result = 0.0;
  double error = 0.0;
  // The status may say that rounding keeps the error bound above 1e-13: the comparison judges the result
  // itself.
  gsl_integration_qag(&function, low, high, 0.0, kRelative, kIntervals, GSL_INTEG_GAUSS61, workspace.get(),
                      &result, &error);
  return result;
}

/// Displacement at the origin of a cell's traction, the cell away from the origin.
double integrate_cell(Component component, double x, double y, double h1, double h2) {
  return integrate(
      [&](double u) {
        return integrate([&](double v) { return pair_point_load(component, u, v); }, y - 0.5 * h2,
                         y + 0.5 * h2);
      },
      x - 0.5 * h1, x + 0.5 * h1);
}

/// The cell under the origin: all kernels go like 1/rho, so that in polar coordinates only the distance to
/// the cell's edge is left of the radial integral.
double integrate_self_cell(Component component, double h1, double h2) {
  const double corner = std::atan2(h2, h1);
  const auto along = [&](double theta) {
    const double c = std::cos(theta);
    const double s = std::sin(theta);
    const double edge = std::min(0.5 * h1 / std::abs(c), 0.5 * h2 / std::abs(s));
    return pair_point_load(component, c, s) * edge;
  };
  const std::array corners{-corner, corner, pi - corner, pi + corner, 2.0 * pi - corner};
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < corners.size(); ++i) sum += integrate(along, corners[i], corners[i + 1]);
  return sum;
}

class Influence : public testing::Test {
 protected:
  Influence() : handler_(gsl_set_error_handler_off()) {}
  ~Influence() override { gsl_set_error_handler(handler_); }

 private:
  gsl_error_handler_t* handler_;
};

double coefficient(Component component, const ElasticPair& pair, double h1, double h2, Index k1, Index k2) {
  return HalfSpaces(pair).influence_coefficients(component, {k1 + 1, k2 + 1, h1, h2}).back();
}

TEST_F(Influence, OfNearbyCellsEqualsAdaptiveQuadratureOfThePointLoads) {
  const ElasticPair pair = elastic_pair(kLower, kUpper);
  double worst = 0.0;
  for (const double aspect : kAspects) {
    for (const Component component : kComponents) {
      for (Index k1 = 0; k1 < 5; ++k1) {
        for (Index k2 = 0; k2 < 5; ++k2) {
          const double x = static_cast<double>(k1);
          const double y = static_cast<double>(k2) * aspect;
          const Parity sign = parity(component);
          const bool vanishes = (k1 == 0 && sign.x1 < 0) || (k2 == 0 && sign.x2 < 0);
          const double computed = coefficient(component, pair, 1.0, aspect, k1, k2);
          if (vanishes) {
            EXPECT_EQ(computed, 0.0);
            continue;
          }
          const double expected = k1 == 0 && k2 == 0 ? integrate_self_cell(component, 1.0, aspect)
                                                     : integrate_cell(component, x, y, 1.0, aspect);
          EXPECT_LE(std::abs(computed / expected - 1.0), kQuadrature)
              << "component " << static_cast<int>(component) << " cell (" << k1 << ", " << k2
              << "), h2/h1 = " << aspect;
          worst = std::max(worst, std::abs(computed / expected - 1.0));
        }
      }
    }
  }
  RecordProperty("worst_relative_error", std::to_string(worst * 1e15) + "e-15");
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
Quad log_arctan(Quad x, Quad y) {
  return (y == 0 ? 0 : y * logq(x * x + y * y) / 2) + (x == 0 ? 0 : x * atanq(y / x));
}

std::array<double, 5> exact_integrals(double x, double y, double h1, double h2) {
  const auto of = [&](const auto& f) { return static_cast<double>(corner_difference(f, x, y, h1, h2)); };
  return {of(y_asinh), of([](Quad u, Quad v) { return y_asinh(v, u); }),
          of([](Quad u, Quad v) { return -sqrtq(u * u + v * v); }), of(log_arctan),
          of([](Quad u, Quad v) { return log_arctan(v, u); })};
}

std::array<double, 5> as_array(const CellIntegrals& c) { return {c.xx, c.yy, c.xy, c.x, c.y}; }
constexpr std::array<Parity, 5> kIntegralParity{Parity{1, 1}, {1, 1}, {-1, -1}, {-1, 1}, {1, -1}};

/// Largest relative error of the five integrals, of the first two relative to their sum; those that are odd
/// across an axis on which the cell lies must be 0.
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
  double worst = 0.0;
  std::pair<Index, Index> where;
  const auto offsets = sweep_offsets();
  for (const Index k1 : offsets) {
    for (const Index k2 : offsets) {
      const double error =
          worst_error(static_cast<double>(k1), static_cast<double>(k2) * aspect, 1.0, aspect);
      ASSERT_LE(error, kPromised) << "cell (" << k1 << ", " << k2 << ")";
      if (error > worst) {
        worst = error;
        where = {k1, k2};
      }
    }
  }
  RecordProperty("worst_relative_error", std::to_string(worst * 1e15) + "e-15");
  RecordProperty("worst_cell", std::to_string(where.first) + " " + std::to_string(where.second));
}

/// The coefficients that the integrals compose, for the extremes of Poisson's ratio too.
TEST_P(FarCells, GiveCoefficientsAsAccurate) {
  const double aspect = GetParam();
  const auto relative_error = [](double computed, double expected) {
    return std::abs(computed / expected - 1.0);
  };
  double worst = 0.0;
  for (const double nu : {-0.9, 0.0, 0.3, 0.5}) {
    const ElasticPair pair = elastic_pair({1.0 / (2.0 * pi), nu}, {kRigid, 0.0});  // 1/(2 pi G) = 1
    for (const auto& cell : {std::pair<Index, Index>{0, 0},
                             {0, 3},
                             {3, 0},
                             {2, 2},
                             {0, 310},
                             {310, 0},
                             {97, 5},
                             {0, 2048},
                             {2048, 0}}) {
      const Index k1 = cell.first;
      const Index k2 = cell.second;
      const auto exact =
          exact_integrals(static_cast<double>(k1), static_cast<double>(k2) * aspect, 1.0, aspect);
      const auto error = [&](Component component, double expected) {
        return relative_error(coefficient(component, pair, 1.0, aspect, k1, k2), expected);
      };
      const std::array errors{error(Component::k11, exact[0] + (1.0 - nu) * exact[1]),
                              error(Component::k22, exact[1] + (1.0 - nu) * exact[0]),
                              error(Component::k33, (1.0 - nu) * (exact[0] + exact[1]))};
      for (const double value : errors) {
        ASSERT_LE(value, kPromised) << "cell (" << k1 << ", " << k2 << "), nu " << nu;
        worst = std::max(worst, value);
      }
    }
  }
  RecordProperty("worst_relative_error", std::to_string(worst * 1e15) + "e-15");
}

INSTANTIATE_TEST_SUITE_P(Aspects, FarCells, testing::Values(1.0, 2.0, 0.3, 5.0, 1.4, 0.7, 1.499, 1.0 / 37.0));

TEST_F(Influence, DoesNotDependOnTheUnitOfLength) {
  for (const double unit : {1e-9, 1e-3, 1.0, 1e6}) {
    for (const double aspect : kAspects) {
      for (const double k1 : {0.0, 1.0, 2.0, 3.0, 100.0}) {
        for (const double k2 : {0.0, 1.0, 2.0, 3.0, 100.0}) {
          EXPECT_LE(worst_error(k1 * unit, k2 * unit * aspect, unit, unit * aspect), kPromised)
              << "cells of " << unit << ", offset (" << k1 << ", " << k2 << "), h2/h1 = " << aspect;
        }
      }
    }
  }
}

TEST_F(Influence, IsEvenOrOddInEachCoordinate) {
  for (const double aspect : kAspects) {
    for (const double x : {1.0, 2.0, 3.0, 57.0}) {
      for (const double y : {aspect, 2.0 * aspect, 3.0 * aspect, 57.0 * aspect}) {
        const auto reference = as_array(cell_integrals(x, y, 1.0, aspect));
        for (const double sign1 : {1.0, -1.0}) {
          for (const double sign2 : {1.0, -1.0}) {
            const auto mirrored = as_array(cell_integrals(sign1 * x, sign2 * y, 1.0, aspect));
            for (std::size_t i = 0; i < mirrored.size(); ++i) {
              const double sign =
                  (kIntegralParity[i].x1 < 0 ? sign1 : 1.0) * (kIntegralParity[i].x2 < 0 ? sign2 : 1.0);
              EXPECT_NEAR(mirrored[i], sign * reference[i], kPromised * std::abs(reference[i]));
            }
          }
        }
      }
    }
  }
}

/// Tested on the point loads themselves, so that the table cannot be wrong together with the coefficients.
TEST_F(Influence, ParityIsThatOfThePointLoads) {
  for (const Component component : kComponents) {
    const double reference = pair_point_load(component, 0.8, 0.3);
    EXPECT_DOUBLE_EQ(pair_point_load(component, -0.8, 0.3), parity(component).x1 * reference);
    EXPECT_DOUBLE_EQ(pair_point_load(component, 0.8, -0.3), parity(component).x2 * reference);
  }
  EXPECT_EQ(parity(Component::k12).x1, -1);
  EXPECT_EQ(parity(Component::k12).x2, -1);
}

void expect_coefficients(const ElasticPair& pair, double factor, const ElasticPair& reference,
                         double coupling_factor) {
  for (const Component component : kComponents) {
    const bool coupling = component == Component::k13 || component == Component::k23;
    const auto computed = HalfSpaces(pair).influence_coefficients(component, {6, 5, 1.0, 1.3});
    const auto expected = HalfSpaces(reference).influence_coefficients(component, {6, 5, 1.0, 1.3});
    for (std::size_t i = 0; i < computed.size(); ++i) {
      EXPECT_NEAR(computed[i], (coupling ? coupling_factor : factor) * expected[i],
                  kRounding * std::abs(expected[0] + 1));
    }
  }
}

TEST_F(Influence, ExchangeOfTheBodiesTurnsOnlyTheCoupling) {
  expect_coefficients(elastic_pair(kUpper, kLower), 1.0, elastic_pair(kLower, kUpper), -1.0);
  EXPECT_NE(elastic_pair(kUpper, kLower).mismatch, 0.0);
}

TEST_F(Influence, OfEqualBodiesIsTwiceThatOfOneAndHasNoCoupling) {
  const ElasticPair one = elastic_pair(kLower, {kRigid, 0.0});
  expect_coefficients(elastic_pair(kLower, kLower), 2.0, one, 0.0);
  EXPECT_EQ(elastic_pair(kLower, kLower).mismatch, 0.0);
}

TEST_F(Influence, OfIncompressibleOrProportionateBodiesHasNoCoupling) {
  EXPECT_EQ(elastic_pair({1.0, 0.5}, {7.0, 0.5}).mismatch, 0.0);
  // Dundurs' beta vanishes where (1 - 2 nu)/G agree: 0.5/1 = 1/2.
  EXPECT_EQ(elastic_pair({1.0, 0.25}, {2.0, 0.0}).mismatch, 0.0);
}

TEST_F(Influence, OfARigidBodyIsThatOfTheOtherAlone) {
  for (const double poisson_of_rigid : {0.0, 0.2, 0.5}) {
    const ElasticPair pair = elastic_pair(kLower, {kRigid, poisson_of_rigid});
    for (const Component component : kComponents) {
      const double computed = coefficient(component, pair, 1.0, 1.0, 200, 100);
      EXPECT_NEAR(computed / point_load(component, kLower, 200.0, 100.0), 1.0, 1e-4);  // (1/200)^2
    }
  }
}

/// Love (1929): the mean displacement under a uniformly loaded square, at its centre.
TEST_F(Influence, OfASquareOnItselfIsLoves) {
  const double h = 0.7;
  const HalfSpace body{3.0, 0.3};
  const ElasticPair pair = elastic_pair(body, {kRigid, 0.0});
  const double expected = (1.0 - 0.3) / (2.0 * pi * 3.0) * 4.0 * h * std::log(1.0 + std::numbers::sqrt2);
  EXPECT_NEAR(coefficient(Component::k33, pair, h, h, 0, 0) / expected, 1.0, 4.0 * kRounding);
}

TEST_F(Influence, EffectiveModuliAreThoseOfTheLiterature) {
  const ElasticPair pair = elastic_pair(kLower, kUpper);
  const auto plane_strain = [](const HalfSpace& body) {  // (1 - nu^2)/E with E = 2 G (1 + nu)
    return (1.0 - body.poisson_ratio * body.poisson_ratio) /
           (2.0 * body.shear_modulus * (1.0 + body.poisson_ratio));
  };
  EXPECT_DOUBLE_EQ(pair.effective_modulus(), 1.0 / (plane_strain(kLower) + plane_strain(kUpper)));
  EXPECT_DOUBLE_EQ(pair.shear_modulus(), 1.0 / (1.0 / kLower.shear_modulus + 1.0 / kUpper.shear_modulus));
}

}  // namespace
}  // namespace slipstick::solver
