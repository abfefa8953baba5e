#include "solver/newton/natural_map_newton.hpp"

#include <gmock/gmock.h>

#include "solver/allocations/allocations.hpp"
#include "solver/elasticity/elasticity.hpp"
#include "solver/tests/torsion_bench.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using testing::HasSubstr;

/// A preconditioner that is not definite: it reverses every residual.
class Reversing final : public InverseSymbol {
 public:
  void apply(std::span<double> field) override {
    for (double& value : field) value = -value;
  }
  std::array<double, 2> diagonal() const override { return {1.0, 1.0}; }
};

/// The sphere's contact in torsion, as a convex program.
class Newton : public testing::Test {
 protected:
  explicit Newton(Index cells = 24) : bench_(cells), q_(ArrayXd::Zero(2 * bench_.model.grid.cells())) {}

  NewtonSummary run(LinearOperator& op, InverseSymbol& symbol, ArrayXd& q, const NewtonOptions& options) {
    return minimise(discs_, program_, op, symbol, all_, q, {}, options);
  }
  NewtonSummary run(ArrayXd& q, const NewtonOptions& options = {}) { return run(*bench_.op, *symbol_, q, options); }
  double energy(const ArrayXd& q) {
    const ArrayXd u = bench_.op->applied(q);
    return 0.5 * (q * u).sum();
  }

  Bench bench_;
  const Grid& grid_ = bench_.model.grid;
  std::unique_ptr<InverseSymbol> symbol_ = make_inverse_symbol(grid_, tangential_kernel(), *bench_.model.law);
  ArrayXd rotation_ = (bench_.bound > 0.0).cast<double>().replicate(2, 1) * rotation_field(grid_);
  MotionField turn_{grid_, 0.0, 0.0, 1.0};
  FrictionDiscs discs_{grid_, bench_.bound};
  Packing all_{grid_, Sweep::whole(grid_), 2};
  ConvexProgram program_{.g = nullptr, .imposed = {{&turn_, 0.8 * bench_.limit}}};
  ArrayXd q_;
};

/// The program is strictly convex: all starts end in its one minimum.
TEST_F(Newton, ReachesTheSameMinimumFromAnyStart) {
  ASSERT_TRUE(run(q_).converged);
  const double least = energy(q_);
  std::mt19937_64 generator(1);
  std::normal_distribution<double> normal;
  const double largest = bench_.bound.maxCoeff();
  const ArrayXd noise = ArrayXd::NullaryExpr(q_.size(), [&] { return largest * normal(generator); });
  for (const ArrayXd& start : {ArrayXd(1e6 * rotation_), ArrayXd(-1e6 * rotation_), noise, ArrayXd(1e3 * noise),
                               ArrayXd(-q_), ArrayXd(ArrayXd::Constant(q_.size(), largest))}) {
    ArrayXd q = start;
    const NewtonSummary summary = run(q);
    EXPECT_TRUE(summary.converged) << summary.message;
    EXPECT_LE(summary.gap, 1e-8);
    EXPECT_NEAR(energy(q) / least, 1.0, 2e-8);
    EXPECT_NEAR((q * rotation_).sum() / bench_.limit, 0.8, kRounding);
  }
}

TEST_F(Newton, AllocatesNothingInTheIteration) {
  const auto allocated = [&](double tolerance, int least_iterations) {
    q_.setZero();
    const long before = allocations();
    const NewtonSummary summary = run(q_, {.tolerance = tolerance});
    EXPECT_TRUE(summary.converged);
    EXPECT_GE(summary.iterations, least_iterations);
    return allocations() - before;
  };
  EXPECT_EQ(allocated(1e-12, 3), allocated(1e6, 0));
}

/// Gradient steps descend where a preconditioner misleads conjugate gradients.
TEST_F(Newton, FallsBackOnTheGradientWhereTheLinearSolveFails) {
  ASSERT_TRUE(run(q_).converged);
  Reversing reversing;
  ArrayXd q = ArrayXd::Zero(q_.size());
  const NewtonSummary summary = run(*bench_.op, reversing, q, {.tolerance = 1e-4, .max_applications = 20000});
  EXPECT_TRUE(summary.converged) << summary.message;
  EXPECT_LE(summary.gap, 1e-4);
  EXPECT_NEAR(energy(q) / energy(q_), 1.0, 1e-4);
  EXPECT_EQ(summary.safeguards.gradient_steps, summary.iterations);
  EXPECT_EQ(summary.safeguards.breakdowns, summary.iterations);
  EXPECT_THAT(summary.safeguards.breakdown, HasSubstr("square is -"));
}

TEST_F(Newton, SaysThatItsApplicationsWereTooFew) {
  const NewtonSummary summary = run(q_, {.tolerance = 1e-8, .max_applications = 4});
  EXPECT_FALSE(summary.converged);
  EXPECT_THAT(summary.message, HasSubstr("within 4 operator applications"));
  EXPECT_GT(summary.gap, 1e-8);
  // The last field is still admissible and carries the load.
  EXPECT_NEAR((q_ * rotation_).sum() / bench_.limit, 0.8, kRounding);
  EXPECT_LE((norms(q_) - bench_.bound).maxCoeff(), kRounding * bench_.bound.maxCoeff());
}

// No tractions have a gap below the rounding of their displacements: what is as small is certified.
TEST_F(Newton, EndsWhereRoundingHidesTheGap) {
  const NewtonSummary summary = run(q_, {.tolerance = 1e-19, .max_applications = 100});
  EXPECT_TRUE(summary.converged);
  EXPECT_LE(summary.gap, 1e-13);
  EXPECT_GT(summary.gap, 1e-19);
}

TEST_F(Newton, IsNotConvergedOnWhatIsNoNumber) {
  for (const double factor : {std::numeric_limits<double>::quiet_NaN(), -1.0}) {
    Multiple broken(grid_, factor);
    ArrayXd q = ArrayXd::Zero(q_.size());
    const NewtonSummary summary = run(broken, *symbol_, q, {.tolerance = 1e-8, .max_applications = 2000});
    EXPECT_FALSE(summary.converged) << factor;
    EXPECT_NE(summary.message, "") << factor;
  }
  ArrayXd q = ArrayXd::Constant(q_.size(), std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(run(q).converged);
}

/// Under the identity for an operator the answer is the projection of the rotation onto the discs.
TEST_F(Newton, ProjectsUnderTheIdentity) {
  Multiple identity(grid_, 1.0);
  const NewtonSummary summary = run(identity, *symbol_, q_, {.tolerance = 1e-12});
  ASSERT_TRUE(summary.converged) << summary.message;
  ArrayXd expected = summary.multipliers[0] * rotation_;
  discs_.project(expected);
  EXPECT_LE((q_ - expected).abs().maxCoeff(), 1e-6 * bench_.bound.maxCoeff());
}

}  // namespace
}  // namespace slipstick::solver
