#include "analytic/layered/layered_pair.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <stdexcept>

#include "analytic/tests/values.hpp"

namespace slipstick::analytic::layered {
namespace {

/// Stresses s_zz, s_xz and displacements u_x, u_z by the stress function of plane strain f = z^q exp(s z), q
/// = 0 or 1, of wave number 1: s_zz = -f, s_xz = -f', 2 G u_x = (1 - nu) f'' + nu f, 2 G u_z = (1 - nu) f'''
/// - (2 - nu) f', phases left out.
Eigen::Vector4d state_of(int q, double s, double z, const Elastic& material) {
  const auto derivative = [&](int n) { return std::pow(s, n) * (q == 0 ? 1 : z + n / s) * std::exp(s * z); };
  const double nu = material.poisson_ratio;
  const double twice = 2 * material.shear_modulus;
  return {-derivative(0), -derivative(1), ((1 - nu) * derivative(2) + nu * derivative(0)) / twice,
          ((1 - nu) * derivative(3) - (2 - nu) * derivative(1)) / twice};
}

/// How far the surface of a coated body moves into it under a unit pressure of wave number 1, from the
/// equations of layer and base: two at the surface, four where they are bonded, two there on a rigid base.
double moved(const Body& body) {
  const double h = body.coat->thickness;
  const Elastic& base = body.coat->base;
  const int bonds = std::isinf(base.shear_modulus) ? 2 : 4;
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(2 + bonds, 2 + bonds);
  Eigen::RowVector4d at_surface;
  for (int j = 0; j < 4; ++j) {
    const double s = j < 2 ? -1 : 1;
    const double scale = j < 2 ? 1 : std::exp(-h);
    const Eigen::Vector4d top = scale * state_of(j % 2, s, 0, body.surface);
    matrix.block(0, j, 2, 1) = top.head(2);
    matrix.block(2, j, bonds, 1) = scale * state_of(j % 2, s, h, body.surface).tail(bonds);
    at_surface[j] = top[3];
  }
  for (int j = 0; j < bonds - 2; ++j) matrix.block(2, 4 + j, bonds, 1) = -state_of(j, -1, 0, base);
  const Eigen::VectorXd pressure = -Eigen::VectorXd::Unit(2 + bonds, 0);
  return at_surface * matrix.fullPivLu().solve(pressure).head(4);
}

/// For shear waves the base's impedance G_base is, at the surface, G (G_base + G t)/(G + G_base t), t =
/// tanh(k h).
double sheared(const Body& body) {
  const double g = body.surface.shear_modulus;
  const double base = body.coat->base.shear_modulus;
  const double t = std::tanh(body.coat->thickness);
  return std::isinf(base) ? t / g : (g + base * t) / (base + g * t) / g;
}

TEST(LayeredPair, MovesAsTheEquationsOfLayersAndBasesSay) {
  const Body other{{4, 0.3}, Coat{0.7, {1, 0.2}}};
  for (const double base : {1e-3, 0.2, 1.0, 7.0, 1e3, kInfinity}) {
    for (const double nu : {0.0, 0.3, 0.5}) {
      for (const double h : {0.02, 0.4, 1.5, 6.0}) {
        const Body body{{1, nu}, Coat{h, {base, 0.5 - nu}}};
        const Pair pair(body, other);
        EXPECT_EQ(pair.thickness(), std::min(h, 0.7));
        // The equations solved here lose digits under a thin layer on a base unlike it.
        EXPECT_NEAR((1 + pair.normal_excess(1)) * 2 / pair.effective_modulus() / (moved(body) + moved(other)),
                    1, 1e-12 / std::pow(std::min(1.0, h), 3))
            << base << ' ' << nu << ' ' << h;
        EXPECT_NEAR((1 + pair.torsional_excess(1)) / pair.shear_modulus() / (sheared(body) + sheared(other)),
                    1, 1e-13)
            << base << ' ' << h;
      }
    }
  }
}

TEST(LayeredPair, RefusesWhatIsNoCoatedPair) {
  const Body coated{{1, 0.3}, Coat{1, {2, 0.3}}};
  EXPECT_THROW(Pair(Body{{1, 0.3}}, Body{{1, 0.3}}), std::domain_error);
  EXPECT_THROW(Pair(Body{{kInfinity, 0.3}, Coat{1, {2, 0.3}}}, coated), std::domain_error);
  for (const double bad : {0.0, -1.0, kNan}) {
    EXPECT_THROW(Pair(Body{{bad, 0.3}}, coated), std::domain_error);
    EXPECT_THROW(Pair(Body{{1, 0.3}, Coat{bad, {2, 0.3}}}, coated), std::domain_error);
    EXPECT_THROW(Pair(Body{{1, 0.3}, Coat{1, {bad, 0.3}}}, coated), std::domain_error);
    EXPECT_THROW(Pair(Body{{1, bad - 1}}, coated), std::domain_error);
  }
}

}  // namespace
}  // namespace slipstick::analytic::layered
