#include "solver/elasticity/law/layer_symbol.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "solver/elasticity/law/tests/layered_waves.hpp"

namespace slipstick::solver {
namespace {

using testing_waves::kHostileBodies;
using testing_waves::wave_reference;

using Member = double WaveCompliance::*;
constexpr std::array<Member, 4> kMembers{&WaveCompliance::across, &WaveCompliance::along,
                                         &WaveCompliance::normal, &WaveCompliance::coupling};

/// The reference loses x^-3 of its 19 digits.
constexpr std::array kWaveNumbers{0.02, 0.1, 0.4999, 0.5001, 1.0, 3.0, 12.0};
constexpr double kReference = 2e-13;

TEST(LayerSymbol, IsWhatNaviersEquationsSay) {
  for (const CoatedBody& body : kHostileBodies) {
    const LayerSymbol symbol(body);
    for (const double x : kWaveNumbers) {
      SCOPED_TRACE(testing::Message()
                   << body.surface().shear_modulus << " on " << body.base.shear_modulus << ", x = " << x);
      const WaveCompliance expected = wave_reference(body, x);
      const WaveCompliance whole = symbol.whole(x);
      for (const Member member : kMembers) {
        const double scale = member == &WaveCompliance::coupling ? std::sqrt(expected.along * expected.normal)
                                                                 : expected.*member;
        EXPECT_NEAR(whole.*member, expected.*member, kReference * scale);
      }
    }
  }
}

TEST(LayerSymbol, IsThatOfTheLayerAndWhatTheBaseAdds) {
  for (const CoatedBody& body : kHostileBodies) {
    const LayerSymbol symbol(body);
    const WaveCompliance layer = LayerSymbol(CoatedBody{body.surface()}).whole(1.0);
    for (const double x : kWaveNumbers) {
      const WaveCompliance whole = symbol.whole(x);
      const WaveCompliance beyond = symbol.beyond_layer(x);
      for (const Member member : kMembers) {
        EXPECT_NEAR(layer.*member + beyond.*member, whole.*member,
                    1e-14 * (layer.across + std::abs(whole.*member)));
      }
    }
  }
}

/// Long waves feel the base, short ones the layer: the difference goes like x, and like exp(-2 x).
TEST(LayerSymbol, GoesFromTheBaseToTheLayer) {
  for (const CoatedBody& body : kHostileBodies) {
    const LayerSymbol symbol(body);
    const WaveCompliance base = LayerSymbol(CoatedBody{body.base}).whole(1.0);
    const double softest = std::max(1.0 / body.surface().shear_modulus, 1.0 / body.base.shear_modulus);
    for (const Member member : kMembers) {
      const double near = symbol.whole(1e-8).*member - base.*member;
      const double nearer = symbol.whole(1e-9).*member - base.*member;
      EXPECT_NEAR(nearer, 0.1 * near, 1e-3 * std::abs(near) + 1e-14 * softest);
      EXPECT_LE(std::abs(near), 1e-3 * softest);
      EXPECT_EQ(symbol.beyond_layer(1e3).*member, 0.0);
      EXPECT_LE(std::abs(symbol.beyond_layer(20.0).*member), 1e4 * std::exp(-40.0) * softest);
    }
  }
}

TEST(LayerSymbol, ChangesNothingWhereLayerAndBaseAreAlike) {
  const LayerSymbol symbol(CoatedBody{{2.5, 0.31}, BondedLayer{{2.5, 0.31}, 0.7}});
  const WaveCompliance plain = LayerSymbol(CoatedBody{{2.5, 0.31}}).whole(1.0);
  for (const double wave : {1e-6, 0.3, 2.0, 50.0}) {
    for (const Member member : kMembers) {
      EXPECT_EQ(symbol.beyond_layer(wave).*member, 0.0);
      EXPECT_NEAR(symbol.whole(wave).*member, plain.*member, 1e-15);
    }
  }
}

/// Tractions do work on any body.
TEST(LayerSymbol, IsPositiveDefinite) {
  for (const CoatedBody& body : kHostileBodies) {
    for (double x = 1e-10; x < 1e3; x *= 1.7) {
      const WaveCompliance c = LayerSymbol(body).whole(x);
      EXPECT_GT(c.across, 0.0) << x;
      EXPECT_GT(c.along, 0.0) << x;
      EXPECT_GT(c.normal * c.along, c.coupling * c.coupling) << x;
    }
  }
}

}  // namespace
}  // namespace slipstick::solver
