#include "solver/elasticity/law/coated_half_spaces.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>

#include "solver/cache/solve_cache.hpp"
#include "solver/elasticity/direct.hpp"
#include "solver/elasticity/law/cell_integrals.hpp"
#include "solver/elasticity/law/rescaled_law.hpp"
#include "solver/elasticity/law/winkler_layer.hpp"

namespace slipstick::solver {
namespace {

constexpr CoatedBody kRigidBody{{std::numeric_limits<double>::infinity(), 0.0}};
constexpr HalfSpace kSoft{1.0, 0.3};
constexpr HalfSpace kHard{5.0, 0.2};

/// Layers much softer and harder than the base, incompressible, of negative Poisson's ratio, on a rigid base.
std::vector<CoatedBody> hostile(double thickness) {
  const HalfSpace rigid = kRigidBody.surface;
  return {
      {{5.0, 0.3}, thickness, {2.0, 0.2}},   {{0.1, 0.5}, thickness, {2.0, 0.5}}, {kSoft, thickness, rigid},
      {{1.0, 0.5}, thickness, rigid},        {{1e4, 0.0}, thickness, {1.0, 0.2}}, {{1.0, -0.9}, thickness, {1e4, -0.9}},
      {{1.001, 0.1}, thickness, {1.0, 0.5}}, {{20.0, 0.1}, thickness, kSoft}};
}

using Real = long double;
using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// Displacements along a wave of number 1 over i and into the body, shear traction, pressure at depth z, by
/// the gradient of psi = exp(s z - shift) or Papkovich's and Neuber's solution with psi along the depth.
Eigen::Matrix<Real, 4, 1> wave(const HalfSpace& body, Real s, bool second, Real z, Real shift) {
  const Real psi = std::exp(s * z - shift);
  const Real c = 4.0L - 4.0L * static_cast<Real>(body.poisson_ratio);
  const Real u = second ? z : 1.0L;
  const Real w = second ? 1.0L + s * z - c : s;
  const Real du = second ? 1.0L + s * z : s;
  const Real dw = second ? 2.0L * s + z - c * s : 1.0L;
  const Real volume = second ? (c - 4.0L) * s : 0.0L;  // the divergence's part of the pressure
  const Real compliance = 1.0L / static_cast<Real>(body.shear_modulus);
  return Eigen::Matrix<Real, 4, 1>(u * compliance, w * compliance, -(du + w), -(volume + 2.0L * dw)) * psi;
}

/// In extended precision: amplitudes of four waves of the layer and two of the base follow from the surface and the
/// interface. Shear waves: the base's compliance, carried through the layer as along a transmission line.
WaveCompliance reference(const CoatedBody& body, Real wave_number) {
  const Real x = wave_number * body.thickness;
  Matrix conditions = Matrix::Zero(6, 6);
  Matrix moved(2, 4);
  for (int i = 0; i < 6; ++i) {
    const Real sign = i == 2 || i == 3 ? 1.0L : -1.0L;
    const Real shift = sign > 0.0L ? x : 0.0L;
    conditions.col(i).tail(4) = -wave(body.base, sign, i == 5, 0.0L, 0.0L);
    if (i >= 4) continue;
    const auto top = wave(body.surface, sign, i % 2 == 1, 0.0L, shift);
    conditions.col(i) << top.tail(2), wave(body.surface, sign, i % 2 == 1, x, shift);
    moved.col(i) = top.head(2);
  }
  const Matrix loads = Matrix::Identity(6, 2);
  const Matrix m = moved * conditions.fullPivLu().solve(loads).topRows(4);
  const Real g = body.surface.shear_modulus;
  const Real ratio = g / static_cast<Real>(body.base.shear_modulus);
  const Real across = (ratio + std::tanh(x)) / (g * (1.0L + ratio * std::tanh(x)));
  return {static_cast<double>(across), static_cast<double>(m(0, 0)), static_cast<double>(m(1, 1)),
          static_cast<double>(m(0, 1))};
}

TEST(WaveCompliance, IsWhatNaviersEquationsSayAndPositiveDefinite) {
  constexpr double kReference = 2e-13;  // the reference loses x^-3 of its 19 digits
  for (const CoatedBody& body : hostile(0.7)) {
    for (const double x : {0.02, 0.1, 0.4999, 0.5001, 1.0, 3.0, 12.0}) {
      const WaveCompliance expected = reference(body, x / 0.7L);
      const WaveCompliance c = wave_compliance(body, x / 0.7);
      EXPECT_NEAR(c.across / expected.across, 1.0, kReference);
      EXPECT_NEAR(c.along / expected.along, 1.0, kReference);
      EXPECT_NEAR(c.normal / expected.normal, 1.0, kReference);
      EXPECT_NEAR(c.coupling, expected.coupling, kReference * std::sqrt(expected.along * expected.normal));
    }
    for (double x = 1e-10; x < 1e3; x *= 1.7) {  // tractions do work, however thin the layer
      const WaveCompliance c = wave_compliance(body, x);
      EXPECT_TRUE(c.across > 0.0 && c.along * c.normal > c.coupling * c.coupling) << x;
    }
  }
}

/// exp(-2 x) by orders 0, 1, 2 and x exp(-2 x) by order 0 (Abramowitz and Stegun, Eq. 29.3.58).
TEST(HankelTable, HasTheTransformsOfExponentials) {
  const HankelTable table = HankelTable::of({0, 1, 2, 0}, [](double x) -> HankelTable::Values {
    return std::exp(-2.0 * x) * HankelTable::Values(1.0, 1.0, 1.0, x);
  });
  const auto error = [&](double r) {
    const double rho = std::hypot(r, 2.0);
    const double slope = r / (rho + 2.0);
    const HankelTable::Values expected(1.0 / rho, slope / rho, slope * slope / rho, 2.0 / rho / rho / rho);
    return (1.0 + r) * (table.at(r) - expected).abs().maxCoeff();
  };
  for (double r = 1e-6; r < 1e7; r *= 1.37) EXPECT_LE(error(r), 5e-13) << r;
  for (const double r : {1e8, 1e12, 1e150}) EXPECT_LE(error(r), 2e-7);  // the tail 1/r
}

Tables all_tables_of(const ElasticLaw& law, const Grid& offsets, int threads = 1) {
  return law.influence_tables(kAllComponents, offsets, threads);
}

/// The largest difference of any coefficient, over the largest of all.
double difference(const Tables& a, const Tables& b) {
  double worst = 0.0, scale = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    const Eigen::Map<const Eigen::ArrayXd> x(a[c].data(), std::ssize(a[c])), y(b[c].data(), std::ssize(b[c]));
    worst = std::max(worst, (x - y).abs().maxCoeff());
    scale = std::max(scale, y.abs().maxCoeff());
  }
  return worst / scale;
}

// A layer's thickness and a foundation's compliance are lengths: counted in another unit they are other
// numbers, and each displacement follows.
TEST(RescaledLaw, IsTheLawWithEachOfItsLengthsInTheOtherUnit) {
  const std::vector<PlaneWave> waves{{0.0, 0.0, 0.1}, {0.3, 0.0, 0.3}, {0.5, -1.2, 1.3}, {3.0, 4.0, 5.0}};
  const Grid offsets{7, 5, 1.0, 0.8};
  for (const double ratio : {0.37, 2.9}) {
    const auto laws = [](double unit) {
      const SharedLaw bodies = half_spaces(kSoft, kHard);
      return std::vector<SharedLaw>{
          bodies, std::make_shared<WinklerLayer>(bodies, 0.7 / unit, 0.4 / unit),
          std::make_shared<CoatedHalfSpaces>(CoatedBody{kHard, 1.3 / unit, kSoft}, CoatedBody{kSoft})};
    };
    const std::vector<SharedLaw> in_unit = laws(1.0), in_other = laws(ratio);
    for (std::size_t i = 0; i < in_unit.size(); ++i) {
      const RescaledLaw law(in_unit[i], ratio);
      const ElasticLaw& expected = *in_other[i];
      EXPECT_LE(difference(all_tables_of(law, offsets), all_tables_of(expected, offsets)), 1e-12);
      EXPECT_NEAR(law.least_eigenvalue(1.0, 0.8) / expected.least_eigenvalue(1.0, 0.8), 1.0, 1e-12);
      EXPECT_EQ(law.couples(), expected.couples());
      for (const bool tangential : {false, true}) {
        std::vector<Symbol> found(waves.size()), right(waves.size());
        law.inverse_symbols(tangential, 1.0, 0.8, waves, found);
        expected.inverse_symbols(tangential, 1.0, 0.8, waves, right);
        for (std::size_t w = 0; w < waves.size(); ++w) {
          for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[w][k], right[w][k], 1e-12 * right[w][0]);
        }
      }
    }
  }
}

/// The change of the coefficients at offset (x, y) by the base: the Fourier integral in polar coordinates of
/// the wave vector, up to where exp(-2 k h) is below rounding.
std::array<double, 6> added_by_base(const CoatedBody& body, const Grid& cell, CellTraction traction, double x,
                                    double y) {
  const auto sinc = [](double a) { return a == 0.0 ? 1.0 : std::sin(a) / a; };
  const GaussRule rule = make_gauss_rule(20);
  const WaveCompliance layer = wave_compliance({body.surface}, 1.0);
  std::array<double, 6> sum{};
  for (double begin = 0.0, width = 0.125; begin < 20.0; begin += width, width = std::min(0.5, begin)) {
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double k = (begin + width * (0.5 + rule.node[i])) / body.thickness;
      const WaveCompliance c = reference(body, k);
      const int directions = 64 + 2 * static_cast<int>(k * (std::hypot(x, y) + cell.h1 + cell.h2));
      for (int j = 0; j < directions; ++j) {
        const double n1 = std::cos(2.0 * std::numbers::pi * j / directions);
        const double n2 = std::sin(2.0 * std::numbers::pi * j / directions);
        const double a = k * n1 * cell.h1;
        const double b = k * n2 * cell.h2;
        const double weight = cell.cell_area() * sinc(0.5 * a) * sinc(0.5 * b) * sharpening(traction, a, b) * width *
                              rule.weight[i] / body.thickness / directions / 2.0 / std::numbers::pi;
        const double even = weight * std::cos(k * (n1 * x + n2 * y));
        const double odd = -weight * std::sin(k * (n1 * x + n2 * y));
        const double across = even * (c.across - layer.across);
        const double along = even * (c.along - layer.along);
        const std::array wave{across * n2 * n2 + along * n1 * n1,       (along - across) * n1 * n2,
                              across * n1 * n1 + along * n2 * n2,       odd * n1 * (c.coupling - layer.coupling),
                              odd * n2 * (c.coupling - layer.coupling), even * (c.normal - layer.normal)};
        for (std::size_t part = 0; part < sum.size(); ++part) sum[part] += wave[part];
      }
    }
  }
  return sum;
}

TEST(CoatedHalfSpaces, HaveTheCoefficientsOfTheFourierIntegral) {
  using Case = std::tuple<CoatedBody, Grid, CellTraction>;
  for (const auto& [body, cell, traction] :
       {Case{{kSoft, 1.3, kHard}, {4, 3, 1.0, 1.0}, CellTraction::constant},
        Case{{{1.0, 0.5}, 0.4, kRigidBody.surface}, {3, 3, 0.5, 1.7}, CellTraction::constant},
        Case{{{20.0, 0.1}, 0.9, kSoft}, {3, 3, 1.0, 1.0}, CellTraction::smooth}}) {
    const HalfSpace other{2.0, 0.1};
    Tables expected = all_tables_of(HalfSpaces(elastic_pair(body.surface, other), traction), cell);
    for (Index i = 0; i < cell.cells(); ++i) {
      const auto added = added_by_base(body, cell, traction, static_cast<double>(i / cell.n2) * cell.h1,
                                       static_cast<double>(i % cell.n2) * cell.h2);
      for (std::size_t c = 0; c < added.size(); ++c) expected[c][static_cast<std::size_t>(i)] += added[c];
    }
    EXPECT_LE(difference(all_tables_of(CoatedHalfSpaces(body, {other}, traction), cell), expected), 2e-13);
  }
}

TEST(CoatedHalfSpaces, AreHalfSpacesWhereLayerAndBaseAreAlike) {
  const Grid cell{9, 7, 1.0, 0.8};
  const Tables plain = all_tables_of(HalfSpaces(elastic_pair(kSoft, kHard)), cell);
  for (const double thickness : {1e-3, 1.0, 1e4}) {
    const CoatedHalfSpaces law({kSoft, thickness, kSoft}, CoatedBody{kHard, 2.0 * thickness, kHard});
    EXPECT_LE(difference(all_tables_of(law, cell), plain), 1e-14);
  }
  EXPECT_EQ(all_tables_of(CoatedHalfSpaces({kSoft}, {kHard}), cell), plain);
}

/// A thin layer on a rigid base is Winkler's foundation: cells are independent, and a pressure shortens the
/// layer as in uniaxial strain.
TEST(CoatedHalfSpaces, AreWinklersFoundationOnARigidBase) {
  constexpr double kThickness = 1e-3;
  const CoatedHalfSpaces law({kSoft, kThickness, kRigidBody.surface}, kRigidBody);
  Tables expected(6, std::vector<double>(600));
  expected[0][0] = expected[2][0] = kThickness;
  expected[5][0] = kThickness * (1.0 - 2.0 * 0.3) / (2.0 * (1.0 - 0.3));
  EXPECT_LE(difference(all_tables_of(law, {30, 20, 1.0, 1.0}), expected), 1e-11);
}

TEST(CoatedHalfSpaces, ChangeNoBitWithThreadsAndMirrorAlongTheDiagonal) {
  const CoatedHalfSpaces law({kSoft, 0.3, kHard}, {kHard, 2.0, kSoft});
  for (const Grid& cell : {Grid{9, 6, 1.0, 1.0}, Grid{6, 9, 1.0, 1.0}, Grid{7, 7, 1.0, 0.5}}) {
    const Tables tables = all_tables_of(law, cell);
    for (const int threads : {2, 5}) EXPECT_EQ(all_tables_of(law, cell, threads), tables);
    const Tables turned = all_tables_of(law, {cell.n2, cell.n1, cell.h2, cell.h1});
    const auto i = static_cast<std::size_t>(cell.n2 + 2);  // offset (1, 2), and there (2, 1)
    const auto j = static_cast<std::size_t>(2 * cell.n1 + 1);
    for (const auto& [c, d] : {std::pair{0U, 2U}, {1U, 1U}, {2U, 0U}, {3U, 4U}, {4U, 3U}, {5U, 5U}})
      EXPECT_NEAR(tables[c][i], turned[d][j], 1e-14);
    EXPECT_EQ(tables[3][1], 0.0);  // where x = 0
  }
}

/// On any cells: the matrices are positive definite, but for the tables' error, and the bound holds.
TEST(CoatedHalfSpaces, HaveEigenvaluesAboveTheBound) {
  const auto least = [](const Grid& cell, const BlockKernel& kernel, const ElasticLaw& law) {
    const DenseMatrix matrix(cell, kernel, law);
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix.matrix()).eigenvalues().minCoeff();
  };
  for (const double thickness : {1e-3, 0.1, 1.0, 1e4}) {
    for (const CoatedBody& body : hostile(thickness)) {
      for (const Grid& cell : {Grid{6, 6, 1.0, 1.0}, Grid{4, 8, 1.0, 0.2}}) {
        const CoatedHalfSpaces law(body, kRigidBody);
        const double bound = law.least_eigenvalue(cell.h1, cell.h2);
        const double found = least(cell, tangential_kernel(), law);
        EXPECT_TRUE(bound <= found && found <= 6.0 * bound) << thickness << ": " << found << ", " << bound;
        EXPECT_GE(least(cell, normal_kernel(), law), -1e-13 / body.surface.shear_modulus);
      }
    }
  }
}

TEST(CoatedHalfSpaces, HaveTheInverseOfTheirSymbol) {
  const CoatedBody body{kSoft, 0.7, kHard};
  const std::array waves{PlaneWave{0.6, -0.8, 1.0}};
  std::array<Symbol, 1> tangential, normal;
  CoatedHalfSpaces(body, {kHard}).inverse_symbols(true, 1.0, 1.0, waves, tangential);
  CoatedHalfSpaces(body, {kHard}).inverse_symbols(false, 1.0, 1.0, waves, normal);
  const WaveCompliance c = reference(body, 1.0L);
  const auto [p11, p12, p22] = tangential[0];
  EXPECT_NEAR(0.6 * p12 - 0.8 * p22, -0.8 / (c.along + 0.8 / 5.0), 1e-12);
  EXPECT_NEAR(0.8 * p11 + 0.6 * p12, 0.8 / (c.across + 1.0 / 5.0), 1e-12);
  EXPECT_NEAR(normal[0][0], 1.0 / (c.normal + 0.8 / 5.0), 1e-12);
}

TEST(CoatedHalfSpaces, CoupleUnlessTheBodiesAreAlikeOrDoNotContract) {
  const CoatedBody body{kSoft, 0.5, kHard};
  EXPECT_FALSE(CoatedHalfSpaces(body, body).couples());
  EXPECT_TRUE(CoatedHalfSpaces(body, {kHard}).couples());
  EXPECT_TRUE(CoatedHalfSpaces(body, {kSoft, 0.6, kHard}).couples());
  EXPECT_FALSE(CoatedHalfSpaces({{1.0, 0.5}}, {{2.0, 0.5}}).couples());
  // An incompressible layer that is squeezed flows sideways.
  EXPECT_TRUE(CoatedHalfSpaces({{1.0, 0.5}, 1.0, kRigidBody.surface}, kRigidBody).couples());
}

TEST(CoatedHalfSpaces, HaveAKeyForEachNumber) {
  const auto key = [](const CoatedBody& lower) {
    CacheKey made("law");
    CoatedHalfSpaces(lower, {kHard}).add_to(made);
    return made;
  };
  const CoatedBody body{kSoft, 1.0, kHard};
  EXPECT_EQ(key(body), key(body));
  for (const auto member : {&CoatedBody::surface, &CoatedBody::base}) {
    for (const auto number : {&HalfSpace::shear_modulus, &HalfSpace::poisson_ratio}) {
      CoatedBody other = body;
      other.*member.*number += 0.1;
      EXPECT_NE(key(body), key(other));
    }
  }
  EXPECT_NE(key(body), key({kSoft, 1.1, kHard}));
}

}  // namespace
}  // namespace slipstick::solver
