#include "solver/elasticity/random_rounding.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>

namespace slipstick::solver {
namespace {

class RandomlyRounded final : public LinearOperator {
 public:
  RandomlyRounded(std::unique_ptr<LinearOperator> op, const BlockKernel& kernel, std::uint64_t seed)
      : LinearOperator(op->grid(), kernel), op_(std::move(op)) {
    std::seed_seq sequence{static_cast<std::uint64_t>(grid().n1), static_cast<std::uint64_t>(grid().n2),
                           static_cast<std::uint64_t>(kernel.inputs), seed};
    generator_.seed(sequence);
  }

 private:
  void do_apply(std::span<const double> traction, std::span<double> displacement) override {
    op_->apply(traction, displacement);
    double largest = 0.0;
    for (const double u : displacement) largest = std::max(largest, std::abs(u));
    const double ulp = std::numeric_limits<double>::epsilon() * largest;
    for (double& u : displacement) u += ulp * (2.0 * drawn() - 1.0);
    std::fesetround(drawn() < 0.5 ? FE_UPWARD : FE_DOWNWARD);
  }

  /// From 0 to 1, the same with every library.
  double drawn() { return std::ldexp(static_cast<double>(generator_() >> 11U), -53); }

  std::unique_ptr<LinearOperator> op_;
  std::mt19937_64 generator_;
};

}  // namespace

std::unique_ptr<LinearOperator> rounded_at_random(std::unique_ptr<LinearOperator> op,
                                                  const BlockKernel& kernel, std::uint64_t seed) {
  return std::make_unique<RandomlyRounded>(std::move(op), kernel, seed);
}

}  // namespace slipstick::solver
