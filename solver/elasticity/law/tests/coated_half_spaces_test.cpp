#include "solver/elasticity/law/coated_half_spaces.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "solver/cache/solve_cache.hpp"
#include "solver/elasticity/direct.hpp"
#include "solver/elasticity/law/gauss_rule.hpp"
#include "solver/elasticity/law/tests/layered_waves.hpp"
#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

using std::numbers::pi;
using testing_waves::kHostileBodies;
using testing_waves::kRigidBase;
using testing_waves::wave_reference;
using Tables = std::vector<std::vector<double>>;

constexpr HalfSpace kSoft{1.0, 0.3};
constexpr HalfSpace kHard{5.0, 0.2};
constexpr CoatedBody kRigidBody{{kRigidBase, 0.0}};

CoatedBody with_thickness(CoatedBody body, double thickness) {
  body.layer->thickness = thickness;
  return body;
}

CoatedBody coated(const HalfSpace& layer, double thickness, const HalfSpace& base) {
  return {base, BondedLayer{layer, thickness}};
}

Tables tables_of(const ElasticLaw& law, const Grid& offsets, int threads = 1) {
  return law.influence_tables(kAllComponents, offsets, threads);
}

double largest(const std::vector<double>& table) {
  return std::abs(*std::ranges::max_element(table, {}, [](double x) { return std::abs(x); }));
}

/// The largest difference of any coefficient, over the largest of all.
double difference(const Tables& a, const Tables& b) {
  double worst = 0.0;
  double scale = 0.0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    scale = std::max(scale, largest(b[c]));
    for (std::size_t i = 0; i < a[c].size(); ++i) worst = std::max(worst, std::abs(a[c][i] - b[c][i]));
  }
  return worst / scale;
}

// --- against a Fourier integral over the plane of wave vectors ---

/// Ends of panels within which a wave turns by a few radians, up to where exp(-2 x) is below rounding.
std::vector<double> panel_ends() {
  std::vector<double> ends{0.0, 0.125, 0.25};
  while (ends.back() < 20.0) ends.push_back(ends.back() < 0.5 ? 0.5 : ends.back() + 0.5);
  return ends;
}

/// A coefficient's integrand over the direction: a symbol times the cell's wave, at offset (x, y).
std::array<double, 6> ring(const WaveCompliance& s, double k, const Grid& cell, double x, double y,
                           CellTraction traction) {
  const auto sinc = [](double a) { return a == 0.0 ? 1.0 : std::sin(a) / a; };
  const int directions = 64 + 2 * static_cast<int>(k * (std::hypot(x, y) + cell.h1 + cell.h2));
  std::array<double, 6> sum{};
  for (int i = 0; i < directions; ++i) {
    const double n1 = std::cos(2.0 * pi * i / directions);
    const double n2 = std::sin(2.0 * pi * i / directions);
    const double a = 0.5 * k * n1 * cell.h1;
    const double b = 0.5 * k * n2 * cell.h2;
    const double sharper = traction == CellTraction::smooth
                               ? 1.0 + (std::pow(std::sin(a), 2) + std::pow(std::sin(b), 2)) / 6.0
                               : 1.0;
    const double weight = cell.h1 * cell.h2 * sinc(a) * sinc(b) * sharper / (2.0 * pi * directions);
    const double even = weight * std::cos(k * (n1 * x + n2 * y));
    const double odd = -weight * std::sin(k * (n1 * x + n2 * y));
    const std::array symbol{even * (s.across * n2 * n2 + s.along * n1 * n1),
                            even * (s.along - s.across) * n1 * n2,
                            even * (s.across * n1 * n1 + s.along * n2 * n2),
                            odd * s.coupling * n1,
                            odd * s.coupling * n2,
                            even * s.normal};
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += symbol[c];
  }
  return sum;
}

/// What the bases add to the coefficients at an offset. Both layers have one thickness.
std::array<double, 6> beyond_layers(const CoatedBody& lower, const CoatedBody& upper, const Grid& cell,
                                    double x, double y, CellTraction traction) {
  const double thickness = lower.layer->thickness;
  const auto beyond = [](const CoatedBody& body, double at) {
    if (!body.layer) return WaveCompliance{};
    const WaveCompliance whole = wave_reference(body, at);
    const WaveCompliance layer = LayerSymbol(CoatedBody{body.surface()}).whole(1.0);
    return WaveCompliance{whole.across - layer.across, whole.along - layer.along, whole.normal - layer.normal,
                          whole.coupling - layer.coupling};
  };
  const GaussRule rule = make_gauss_rule(20);
  std::array<double, 6> sum{};
  const std::vector<double> ends = panel_ends();
  for (std::size_t panel = 1; panel < ends.size(); ++panel) {
    const double width = ends[panel] - ends[panel - 1];
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double at = ends[panel - 1] + width * (0.5 + rule.node[i]);
      const WaveCompliance pair = of_pair(beyond(lower, at), beyond(upper, at));
      const auto values = ring(pair, at / thickness, cell, x, y, traction);
      for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += width / thickness * rule.weight[i] * values[c];
    }
  }
  return sum;
}

TEST(CoatedHalfSpaces, HaveTheCoefficientsOfTheFourierIntegral) {
  struct Case {
    CoatedBody lower, upper;
    Grid cell;
    CellTraction traction;
  };
  const CellTraction constant = CellTraction::constant;
  for (const auto& [lower, upper, cell, traction] :
       {Case{coated(kSoft, 1.3, kHard), {{2.0, 0.1}}, {4, 3, 1.0, 1.0}, constant},
        Case{coated(kHard, 0.4, kSoft),
             coated({3.0, 0.5}, 0.4, {kRigidBase, 0.0}),
             {3, 3, 1.0, 0.6},
             constant},
        Case{coated({1.0, 0.5}, 9.0, {kRigidBase, 0.0}), kRigidBody, {3, 4, 0.5, 1.7}, constant},
        Case{coated({20.0, 0.1}, 0.9, kSoft), {{2.0, 0.5}}, {3, 3, 1.0, 1.0}, CellTraction::smooth}}) {
    const Tables tables = tables_of(CoatedHalfSpaces(lower, upper, traction), cell);
    Tables expected = tables_of(HalfSpaces(elastic_pair(lower.surface(), upper.surface()), traction), cell);
    for (Index k1 = 0; k1 < cell.n1; ++k1) {
      for (Index k2 = 0; k2 < cell.n2; ++k2) {
        const auto added = beyond_layers(lower, upper, cell, static_cast<double>(k1) * cell.h1,
                                         static_cast<double>(k2) * cell.h2, traction);
        for (std::size_t c = 0; c < expected.size(); ++c)
          expected[c][static_cast<std::size_t>(k1 * cell.n2 + k2)] += added[c];
      }
    }
    EXPECT_LE(difference(tables, expected), 2e-13);
  }
}

// --- limits ---

TEST(CoatedHalfSpaces, AreHalfSpacesWhereLayerAndBaseAreAlike) {
  const Grid cell{9, 7, 1.0, 0.8};
  const HalfSpaces plain(elastic_pair(kSoft, kHard));
  for (const double thickness : {1e-3, 1.0, 1e4}) {
    const CoatedHalfSpaces law(coated(kSoft, thickness, kSoft), coated(kHard, thickness, kHard));
    EXPECT_EQ(tables_of(law, cell), tables_of(plain, cell));
    EXPECT_NEAR(law.least_eigenvalue(1.0, 0.8) / plain.least_eigenvalue(1.0, 0.8), 0.8, 0.2);
    const std::vector<PlaneWave> waves{{0.3, -0.4, 0.5}, {0.0, 0.0, 0.1}};
    for (const bool tangential : {true, false}) {
      std::vector<Symbol> coated_inverse(2);
      std::vector<Symbol> inverse(2);
      law.inverse_symbols(tangential, 1.0, 0.8, waves, coated_inverse);
      plain.inverse_symbols(tangential, 1.0, 0.8, waves, inverse);
      for (std::size_t i = 0; i < waves.size(); ++i) {
        for (std::size_t j = 0; j < 3; ++j) EXPECT_NEAR(coated_inverse[i][j], inverse[i][j], 1e-14);
      }
    }
  }
  EXPECT_EQ(tables_of(CoatedHalfSpaces({kSoft}, {kHard}), cell), tables_of(plain, cell));
}

/// A thin layer adds what is in proportion to its thickness, a thick one leaves what the base changes by: in
/// proportion to one over it.
TEST(CoatedHalfSpaces, GoFromTheBaseToTheLayerWithTheThickness) {
  const Grid cell{6, 6, 1.0, 1.0};
  const Tables base = tables_of(HalfSpaces(elastic_pair(kHard, kHard)), cell);
  const Tables layer = tables_of(HalfSpaces(elastic_pair(kSoft, kHard)), cell);
  const auto from = [&](const Tables& limit, double thickness) {
    return difference(tables_of(CoatedHalfSpaces(coated(kSoft, thickness, kHard), {kHard}), cell), limit);
  };
  EXPECT_NEAR(from(base, 1e-5) / from(base, 1e-4), 0.1, 2e-3);
  EXPECT_NEAR(from(layer, 1e5) / from(layer, 1e4), 0.1, 2e-3);
  EXPECT_LE(from(base, 1e-6), 1e-4);
  EXPECT_LE(from(layer, 1e5), 1e-5);
}

/// A uniform traction over the plane shears the layer by h/G, and pressure shortens it by the modulus of
/// uniaxial strain.
TEST(CoatedHalfSpaces, OnARigidBaseAddUpToTheUniformLayersCompliance) {
  const Grid cell{60, 60, 1.0, 1.0};
  for (const double thickness : {0.05, 1.0, 2.5}) {
    const CoatedHalfSpaces law(coated(kSoft, thickness, {kRigidBase, 0.0}), kRigidBody);
    const Tables tables = tables_of(law, cell);
    const auto total = [&](Component component) {
      double sum = 0.0;
      for (Index k1 = 0; k1 < cell.n1; ++k1) {
        for (Index k2 = 0; k2 < cell.n2; ++k2) {
          const int images = (k1 == 0 ? 1 : 2) * (k2 == 0 ? 1 : 2);
          sum += images *
                 tables[static_cast<std::size_t>(component)][static_cast<std::size_t>(k1 * cell.n2 + k2)];
        }
      }
      return sum;
    };
    const double confined = 2.0 * (1.0 - 0.3) / (1.0 - 2.0 * 0.3);
    EXPECT_NEAR(total(Component::k11), thickness, 1e-9);
    EXPECT_NEAR(total(Component::k22), thickness, 1e-9);
    EXPECT_NEAR(total(Component::k33), thickness / confined, 1e-9);
  }
}

/// Where a thin layer lies on a rigid base, each cell stands alone.
TEST(CoatedHalfSpaces, OnARigidBaseAreWinklersFoundationWhereTheyAreThin) {
  constexpr double kThickness = 1e-3;
  const Grid cell{30, 30, 1.0, 1.0};
  const CoatedHalfSpaces law(coated(kSoft, kThickness, {kRigidBase, 0.0}), kRigidBody);
  Tables tables = tables_of(law, cell);
  const double confined = (1.0 - 2.0 * 0.3) / (2.0 * (1.0 - 0.3));
  EXPECT_NEAR(tables[0][0] / kThickness, 1.0, 1e-11);
  EXPECT_NEAR(tables[2][0] / kThickness, 1.0, 1e-11);
  EXPECT_NEAR(tables[5][0] / kThickness, confined, 1e-11);
  for (std::vector<double>& table : tables) {
    table[0] = 0.0;
    EXPECT_LE(largest(table), 1e-11 * kThickness);
  }
}

// --- what holds for any law ---

TEST(CoatedHalfSpaces, ChangeNoBitWithThreadsAndMirrorAlongTheDiagonal) {
  const CoatedHalfSpaces law(coated(kSoft, 0.3, kHard), coated(kHard, 2.0, kSoft));
  for (const Grid& cell : {Grid{9, 6, 1.0, 1.0}, Grid{6, 9, 1.0, 1.0}, Grid{7, 7, 1.0, 0.5}}) {
    const Tables tables = tables_of(law, cell);
    for (const int threads : {2, 3, 5}) EXPECT_EQ(tables_of(law, cell, threads), tables);
    const Tables turned = tables_of(law, {cell.n2, cell.n1, cell.h2, cell.h1});
    const auto n2 = static_cast<std::size_t>(cell.n2);
    for (std::size_t i = 0; i < tables[0].size(); ++i) {
      const std::size_t j = i % n2 * static_cast<std::size_t>(cell.n1) + i / n2;
      EXPECT_NEAR(tables[0][i], turned[2][j], 1e-14);
      EXPECT_NEAR(tables[1][i], turned[1][j], 1e-14);
      EXPECT_NEAR(tables[3][i], turned[4][j], 1e-14);
    }
    for (const std::size_t odd : {1U, 3U}) EXPECT_EQ(tables[odd][n2 - 1], 0.0);  // x = 0
    for (const std::size_t odd : {1U, 4U}) EXPECT_EQ(tables[odd][n2 * 2], 0.0);  // y = 0
  }
}

/// Of the largest coefficient of half-spaces that consist of the layers: an incompressible layer on a rigid
/// base, much thinner than a cell, has no more under a pressure.
constexpr double kTablesError = 1e-12;

/// On any cells, thin and thick: the matrix is positive definite, and its eigenvalues are above the bound.
TEST(CoatedHalfSpaces, HaveEigenvaluesAboveTheBound) {
  for (const CoatedBody& body : kHostileBodies) {
    for (const double thickness : {1e-3, 0.1, 1.0, 1e4}) {
      for (const Grid& cell : {Grid{6, 6, 1.0, 1.0}, Grid{4, 8, 1.0, 0.2}}) {
        const CoatedHalfSpaces law(with_thickness(body, thickness), kRigidBody);
        const DenseMatrix tangential(cell, tangential_kernel(), law);
        const double least =
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(tangential.matrix()).eigenvalues().minCoeff();
        const double bound = law.least_eigenvalue(cell.h1, cell.h2);
        SCOPED_TRACE(testing::Message() << body.surface().shear_modulus << " on " << body.base.shear_modulus
                                        << ", h = " << thickness << ", cells " << cell.h2);
        EXPECT_GE(least, bound);
        EXPECT_LE(least, 6.0 * bound);
        const HalfSpaces layer(elastic_pair(body.surface(), kRigidBody.base));
        const DenseMatrix normal(cell, normal_kernel(), law);
        const Eigen::VectorXd values =
            Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(normal.matrix()).eigenvalues();
        EXPECT_GE(values.minCoeff(), -kTablesError * layer.influence_coefficients(Component::k33, cell)[0]);
      }
    }
  }
}

TEST(CoatedHalfSpaces, CoupleUnlessTheBodiesAreAlikeOrDoNotContract) {
  const CoatedBody body = coated(kSoft, 0.5, kHard);
  EXPECT_FALSE(CoatedHalfSpaces(body, body).couples());
  EXPECT_TRUE(CoatedHalfSpaces(body, {kHard}).couples());
  EXPECT_TRUE(CoatedHalfSpaces(body, with_thickness(body, 0.6)).couples());
  EXPECT_FALSE(CoatedHalfSpaces({{1.0, 0.5}}, {{2.0, 0.5}}).couples());
  // An incompressible layer that is squeezed flows sideways.
  EXPECT_TRUE(CoatedHalfSpaces(coated({1.0, 0.5}, 1.0, {kRigidBase, 0.0}), kRigidBody).couples());
}

TEST(CoatedHalfSpaces, ThrowForWhatIsNoLayer) {
  EXPECT_THROW(CoatedHalfSpaces(kRigidBody, kRigidBody), std::invalid_argument);
  for (const double wrong : {0.0, -1.0, kRigidBase, std::nan("")}) {
    EXPECT_THROW(CoatedHalfSpaces(coated(kSoft, wrong, kHard), {kHard}), std::invalid_argument);
    EXPECT_THROW(CoatedHalfSpaces({kHard}, coated({wrong, 0.3}, 1.0, kHard)), std::invalid_argument);
  }
}

TEST(CoatedHalfSpaces, HaveAKeyOfTheirOwnForEachNumber) {
  const auto key = [](const CoatedBody& lower, CellTraction traction = CellTraction::constant) {
    CacheKey made("law");
    CoatedHalfSpaces(lower, {kHard}, traction).add_to(made);
    return made;
  };
  const CoatedBody body = coated(kSoft, 1.0, kHard);
  EXPECT_EQ(key(body), key(body));
  EXPECT_NE(key(body), key(body, CellTraction::smooth));
  for (const CoatedBody& other :
       {coated({1.1, 0.3}, 1.0, kHard), coated({1.0, 0.2}, 1.0, kHard), coated(kSoft, 1.1, kHard),
        coated(kSoft, 1.0, {5.1, 0.2}), coated(kSoft, 1.0, {5.0, 0.3}), CoatedBody{kSoft}}) {
    EXPECT_NE(key(body), key(other));
  }
}

}  // namespace
}  // namespace slipstick::solver
