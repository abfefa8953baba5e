#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <string>
#include <vector>

#include "solver/fft/fftw.hpp"

namespace slipstick::solver {
namespace {

/// FFTW's own description.
std::string text(fftw_plan plan) {
  const FftwPlan owned(plan);
  return std::unique_ptr<char, decltype(&std::free)>(fftw_sprint_plan(owned.get()), std::free).get();
}

/// The plans of an operator and of its preconditioner for lines of a length.
std::vector<std::string> plans(int n) {
  FftwBuffer buffer(static_cast<std::size_t>(40 * n + 4 * (n + 16) * (n + 16)));
  auto* const in = buffer.complex();
  auto* const out = in + 10 * n;
  return {text(plan_transform(n, in, out, FFTW_FORWARD)),
          text(plan_transforms({n, 4, 1, n, 4, 1}, in, out, FFTW_FORWARD)),
          text(plan_transforms({n, 4, 4, 1, 1, n}, in, out, FFTW_BACKWARD)),
          text(plan_transform(2 * n, in, out, FFTW_FORWARD))};
}

/// An estimated plan does not depend on earlier plans, so that a process gets the same bits whatever it has
/// planned before.
TEST(EstimatedPlans, DoNotDependOnThoseBefore) {
  constexpr std::array lengths{8, 12, 20, 36, 54, 64, 70, 128, 162};
  std::vector<std::vector<std::string>> alone;
  for (const int n : lengths) {
    fftw_forget_wisdom();
    alone.push_back(plans(n));
  }
  for (std::size_t i = lengths.size(); i-- > 0;) EXPECT_EQ(plans(lengths[i]), alone[i]) << lengths[i];
  for (std::size_t i = 0; i < lengths.size(); ++i) EXPECT_EQ(plans(lengths[i]), alone[i]) << lengths[i];
}

}  // namespace
}  // namespace slipstick::solver
