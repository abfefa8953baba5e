#include "analytic/layered/layered_pair.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace slipstick::analytic::layered {
namespace {

constexpr double kRigid = std::numeric_limits<double>::infinity();

/// A stress function of plane strain of wave number 1, (p + q z) exp(s z), with its first three derivatives.
std::array<double, 4> stress_function(double p, double q, double s, double z) {
  std::array<double, 4> f{};
  for (int n = 0; n < 4; ++n) f[n] = (p + q * z + n * q / s) * std::pow(s, n) * std::exp(s * z);
  return f;
}

/// Normal stress, shear stress, displacement along and into the body, by a stress function f: s_zz = -f,
/// s_xz = -f', 2 G u_x = (1 - nu) f'' + nu f, 2 G u_z = (1 - nu) f''' - (2 - nu) f', phases left out.
std::array<double, 4> state_of(const std::array<double, 4>& f, const Elastic& material) {
  const double nu = material.poisson_ratio;
  const double twice = 2 * material.shear_modulus;
  return {-f[0], -f[1], ((1 - nu) * f[2] + nu * f[0]) / twice, ((1 - nu) * f[3] - (2 - nu) * f[1]) / twice};
}

/// How far the surface of a coated body moves into it under a unit pressure of wave number 1, from the
/// equations of layer and base themselves: two at the surface, four where they are bonded.
double moved(const Body& body) {
  const double h = body.coat->thickness;
  const bool rigid = std::isinf(body.coat->base.shear_modulus);
  const int size = rigid ? 4 : 6;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(size);
  std::array<double, 6> at_surface{};
  for (int j = 0; j < size; ++j) {
    const bool in_base = j >= 4;
    const double s = j == 2 || j == 3 ? 1 : -1;
    const double scale = s > 0 ? std::exp(-h) : in_base ? std::exp(h) : 1;
    const double p = j % 2 == 0 ? scale : 0;
    const double q = j % 2 == 0 ? 0 : scale;
    const Elastic& material = in_base ? body.coat->base : body.surface;
    const auto top = state_of(stress_function(p, q, s, 0), material);
    const auto bond = state_of(stress_function(p, q, s, h), material);
    if (!in_base) {
      matrix(0, j) = top[0];
      matrix(1, j) = top[1];
      at_surface[j] = top[3];
    }
    for (int i = rigid ? 2 : 0; i < 4; ++i) matrix(rigid ? i : 2 + i, j) = in_base ? -bond[i] : bond[i];
  }
  right[0] = -1;
  const Eigen::VectorXd parts = matrix.fullPivLu().solve(right);
  double sum = 0;
  for (int j = 0; j < 4; ++j) sum += parts[j] * at_surface[j];
  return sum;
}

TEST(LayeredPair, MovesAsTheEquationsOfLayerAndBaseSay) {
  for (const double modulus : {1e-3, 0.2, 1.0, 7.0, 1e3, kRigid}) {
    for (const double nu : {0.0, 0.3, 0.5}) {
      for (const double base_nu : {0.1, 0.5}) {
        for (const double thickness : {0.02, 0.4, 1.5, 6.0}) {
          const Body body{{1.3, nu}, Coat{thickness, {1.3 * modulus, base_nu}}};
          const Pair pair(body, Body{{kRigid, 0.3}});
          const double half_space = (1 - nu) / 1.3;
          // The equations solved here lose digits under a thin layer on a base unlike it.
          const double tolerance = 1e-12 / std::pow(std::min(1.0, thickness), 3);
          EXPECT_NEAR((1 + pair.normal_excess(1)) * half_space / moved(body), 1, tolerance)
              << modulus << ' ' << nu << ' ' << base_nu << ' ' << thickness;
        }
      }
    }
  }
}

/// Shear waves: the base's impedance G_base carried through the layer is G (G_base + G t)/(G + G_base t) with
/// t = tanh(k h).
TEST(LayeredPair, CarriesTheImpedanceOfShearThroughTheLayer) {
  for (const double ratio : {1e-3, 0.3, 1.0, 40.0}) {
    for (const double x : {1e-4, 0.1, 1.0, 5.0}) {
      const Pair pair(Body{{2, 0.3}, Coat{0.5, {2 * ratio, 0.2}}}, Body{{kRigid, 0}});
      const double t = std::tanh(x);
      EXPECT_NEAR(1 + pair.torsional_excess(x / 0.5), (1 + ratio * t) / (ratio + t),
                  1e-14 * std::max(1.0, 1 / ratio))
          << ratio << ' ' << x;
    }
  }
}

TEST(LayeredPair, AddsTheBodies) {
  const Body hard{{4, 0.3}, Coat{0.2, {1, 0.2}}};
  const Body soft{{1, 0.4}, Coat{0.7, {9, 0.1}}};
  const Body rigid{{kRigid, 0}};
  const Pair both(hard, soft);
  for (const double k : {0.01, 1.0, 4.0}) {
    const auto compliance = [&](const Pair& pair, bool normal) {
      return normal ? (1 + pair.normal_excess(k)) / pair.effective_modulus()
                    : (1 + pair.torsional_excess(k)) / pair.shear_modulus();
    };
    for (const bool normal : {true, false}) {
      const double sum = compliance(Pair(hard, rigid), normal) + compliance(Pair(rigid, soft), normal);
      EXPECT_NEAR(compliance(both, normal) / sum, 1, 1e-14) << k;
    }
  }
  EXPECT_EQ(both.thickness(), 0.2);
}

TEST(LayeredPair, RefusesWhatIsNoCoatedPair) {
  const Body coated{{1, 0.3}, Coat{1, {2, 0.3}}};
  EXPECT_THROW(Pair(Body{{1, 0.3}}, Body{{1, 0.3}}), std::domain_error);
  EXPECT_THROW(Pair(Body{{kRigid, 0.3}, Coat{1, {2, 0.3}}}, coated), std::domain_error);
  for (const double bad : {0.0, -1.0, std::nan("")}) {
    EXPECT_THROW(Pair(Body{{bad, 0.3}}, coated), std::domain_error);
    EXPECT_THROW(Pair(Body{{1, 0.3}, Coat{bad, {2, 0.3}}}, coated), std::domain_error);
    EXPECT_THROW(Pair(Body{{1, 0.3}, Coat{1, {bad, 0.3}}}, coated), std::domain_error);
  }
  for (const double bad : {-1.0, 0.51, std::nan("")})
    EXPECT_THROW(Pair(Body{{1, bad}}, coated), std::domain_error);
}

}  // namespace
}  // namespace slipstick::analytic::layered
