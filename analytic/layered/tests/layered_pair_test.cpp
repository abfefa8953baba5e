#include "analytic/layered/layered_pair.hpp"

#include <stdexcept>

#include "analytic/tests/values.hpp"

namespace slipstick::analytic::layered {
namespace {

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
