// How large what the page shows is.

#include "convergence/report/validation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace slipstick::convergence {
namespace {

using testing::ElementsAre;

TEST(ValidationSizeTest, OfAStudyIsItsFinestMesh) {
  EXPECT_THAT(up_to({16, 24, 32, 48, 64}, 32), ElementsAre(16, 24, 32));
  EXPECT_THAT(up_to({16, 24, 40, 48}, 32), ElementsAre(16, 24, 32));
  EXPECT_THAT(up_to({16, 24}, 32), ElementsAre(16, 24));
  EXPECT_THAT(up_to({}, 32), ElementsAre());
}

}  // namespace
}  // namespace slipstick::convergence
