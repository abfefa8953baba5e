// The paper's method where there is nothing to do, too little to do it with, or no answer.

#include <fmt/core.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/input_error.hpp"
#include "solver/solve.hpp"
#include "solver/tests/torsion_bench.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using testing::HasSubstr;
using testing::StartsWith;

TEST(Unloaded, HasNoTraction) {
  const Bench bench(16);
  for (const TangentialProblem& problem :
       {under_moment(bench.bound, 0.0), under_twist(bench.bound, 0.0), under_moment(0.0 * bench.bound, 0.0),
        under_twist(0.0 * bench.bound, 1e-3)}) {
    const TangentialSolution solution = solve_by_paper_method(*bench.op, problem);
    EXPECT_EQ(solution.status, Status::converged) << solution.message;
    EXPECT_EQ(largest(solution.traction), 0.0);
    EXPECT_EQ(solution.twist, problem.twist.value_or(0.0));
    const Certificate certificate = certify({solution.traction, solution.elastic_displacement, solution.slip},
                                            problem.friction_bound, rotation_field(bench.model.grid), 0.0);
    EXPECT_EQ(certificate.gap, 0.0);
    EXPECT_EQ(certificate.moment, 0.0);
    EXPECT_LE(certificate.friction_bound, 0.0);
  }
  Scene frictionless = paper_scene(16, 0.5);
  frictionless.friction = 0.0;
  EXPECT_EQ(by_paper_method(frictionless).status, Status::converged);
  EXPECT_EQ(by_paper_method(frictionless).moment, 0.0);
}

/// One cell of a grid off the axis: q = M/r at right angles to its arm, and it turns by K q/r.
TEST(OneCell, OffTheAxisCarriesTheMomentAlone) {
  const Grid grid{7, 7, 1.0, 1.0};
  const ElasticPair pair = elastic_pair({1.0, 0.3}, {2.5, 0.1});
  const auto op = make_operator(OperatorKind::dcfft, grid, tangential_kernel(), pair);
  ArrayXd bound = ArrayXd::Zero(49);
  const Index cell = 5 * 7 + 3;  // at (2, 0)
  bound[cell] = 1.0;
  EXPECT_DOUBLE_EQ(moment_limit(grid, bound), 2.0);
  const TangentialSolution solution = solve_by_paper_method(*op, under_moment(bound, 1.2));
  ASSERT_EQ(solution.status, Status::converged) << solution.message;
  EXPECT_NEAR(solution.traction[49 + cell], 0.6, kRounding);
  EXPECT_NEAR(solution.traction[cell], 0.0, kRounding);
  const double self = influence_coefficients(Component::k22, pair, 1.0, 1.0, 1, 1).front();
  EXPECT_NEAR(solution.twist, self * 0.6 / 2.0, kRounding);
}

/// A cell on the axis carries no moment about it, so there is nothing to turn it.
TEST(OneCell, OnTheAxisCarriesNothing) {
  const Solution solution = by_paper_method(paper_scene(1, 0.5));
  EXPECT_EQ(solution.status, Status::converged);
  EXPECT_EQ(solution.contact_cells, 1);
  EXPECT_EQ(solution.moment_limit, 0.0);
  EXPECT_EQ(solution.moment, 0.0);
  EXPECT_EQ(solution.twist_angle, 0.0);
  EXPECT_EQ(solution.certificate.gap, 0.0);
  EXPECT_EQ(solution.certificate.moment, 0.0);
}

/// The axis' own cell holds neither moment nor twist: when all others slip, that is gross slip.
TEST(OneCell, OnTheAxisIsNoStickArea) {
  const Bench bench(9);
  ASSERT_GT(bench.bound[40], 0.0);
  const double just_below = std::nextafter(bench.limit, 0.0);
  const TangentialSolution solution = solve_by_paper_method(*bench.op, under_moment(bench.bound, just_below));
  EXPECT_TRUE(std::isfinite(solution.twist));
  if (solution.status == Status::not_converged) {
    EXPECT_THAT(solution.message, StartsWith("empty stick area in iteration "));
  } else {
    EXPECT_LE(bench.certify_solution(solution, just_below).moment, kRounding);
  }
}

/// A linear operator of the test's own.
class FakeOperator final : public LinearOperator {
 public:
  FakeOperator(const Grid& grid, double factor)
      : LinearOperator(grid, tangential_kernel()), factor_(factor) {}
  std::size_t bytes() const override { return 0; }

 private:
  void do_apply(std::span<const double> traction, std::span<double> displacement) override {
    std::transform(traction.begin(), traction.end(), displacement.begin(),
                   [this](double q) { return factor_ * q; });
  }
  double factor_;
};

TEST(Breakdown, OfTooFewIterationsIsNamedWithItsNumbers) {
  const Bench bench(24);
  PaperOptions options = to_tolerance(1e-9);
  options.max_iterations = 3;
  const TangentialSolution solution =
      solve_by_paper_method(*bench.op, under_moment(bench.bound, 0.5 * bench.limit), options);
  EXPECT_EQ(solution.status, Status::not_converged);
  EXPECT_EQ(solution.iterations, 3);
  EXPECT_THAT(solution.message, StartsWith("too many iterations: change "));
  EXPECT_THAT(solution.message, HasSubstr("after 3, asked for 1e-09"));
  EXPECT_THAT(solution.message, HasSubstr(fmt::format("{:.3g}", solution.change)));
  EXPECT_GT(solution.change, 1e-9);
  EXPECT_GT(largest(solution.traction), 0.0);  // what it has got is reported
}

TEST(Breakdown, OfNumbersThatAreNotFiniteIsNamed) {
  const Bench bench(24);
  for (const double factor :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    FakeOperator broken(bench.model.grid, factor);
    const TangentialSolution solution =
        solve_by_paper_method(broken, under_moment(bench.bound, 0.5 * bench.limit));
    EXPECT_EQ(solution.status, Status::not_converged);
    EXPECT_THAT(solution.message, StartsWith("non-finite slip in iteration 1: S = "));
    EXPECT_FALSE(bench.certify_solution(solution, 0.5 * bench.limit).gap <= 1e300);
  }
}

TEST(Breakdown, OfAnOperatorThatIsNotPositiveDefiniteIsNamed) {
  const Bench bench(24);
  FakeOperator indefinite(bench.model.grid, -1.0);
  const TangentialSolution solution =
      solve_by_paper_method(indefinite, under_moment(bench.bound, 0.5 * bench.limit));
  EXPECT_EQ(solution.status, Status::not_converged);
  EXPECT_THAT(solution.message, StartsWith("indefinite operator in iteration "));
  EXPECT_THAT(solution.message, HasSubstr("d.Kd = -"));
}

TEST(Breakdown, OfAnEmptyStickAreaIsNamed) {
  const Bench bench(24);
  const TangentialSolution solution = solve_by_paper_method(*bench.op, under_twist(bench.bound, 1.0));
  EXPECT_EQ(solution.status, Status::not_converged);
  EXPECT_THAT(solution.message, StartsWith("empty stick area in iteration "));
  EXPECT_THAT(solution.message, HasSubstr("every cell slips"));
  EXPECT_EQ((solution.stick > 0.0).count(), 0);
  EXPECT_NEAR(bench.moment_of(solution.traction) / bench.limit, 1.0, 1e-3);
}

TEST(BadTangentialProblem, ThrowsForBoundsThatAreNegativeOrNotFinite) {
  const Bench bench(8);
  for (const double value :
       {-1e-300, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    ArrayXd bound = bench.bound;
    bound[27] = value;
    EXPECT_THROW(solve_by_paper_method(*bench.op, under_moment(bound, 0.1 * bench.limit)),
                 std::invalid_argument)
        << value;
  }
}

TEST(BadTangentialProblem, ThrowsUnlessOneLoadIsGiven) {
  const Bench bench(8);
  TangentialProblem problem = under_moment(bench.bound, 0.0);
  problem.twist = 0.0;
  EXPECT_THROW(solve_by_paper_method(*bench.op, problem), std::invalid_argument);
  problem.moment = problem.twist = std::nullopt;
  EXPECT_THROW(solve_by_paper_method(*bench.op, problem), std::invalid_argument);
  for (const double twist :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(solve_by_paper_method(*bench.op, under_twist(bench.bound, twist)), std::invalid_argument);
  }
}

TEST(BadTangentialProblem, ThrowsForGrossSlipAndSaysTheLimit) {
  const Bench bench(8);
  for (const double moment :
       {bench.limit, -bench.limit, 1.5 * bench.limit, std::numeric_limits<double>::quiet_NaN()}) {
    try {
      solve_by_paper_method(*bench.op, under_moment(bench.bound, moment));
      ADD_FAILURE() << "no exception for a moment of " << moment;
    } catch (const std::invalid_argument& error) {
      EXPECT_THAT(error.what(), HasSubstr("gross slip"));
      EXPECT_THAT(error.what(), HasSubstr("allowed: "));
      if (std::isfinite(moment)) {
        EXPECT_THAT(error.what(), HasSubstr(fmt::format("carries {} times", bench.limit / std::abs(moment))));
      }
    }
  }
  const double just_below = std::nextafter(bench.limit, 0.0);
  EXPECT_NO_THROW(solve_by_paper_method(*bench.op, under_moment(bench.bound, just_below)));
}

TEST(BadTangentialProblem, OfASceneSaysTheLimitInItsUnits) {
  Scene scene = paper_scene(32, 0.5);
  const double limit = by_paper_method(scene).moment_limit;
  scene.steps[0].torsion = {};
  scene.steps[0].torsion.moment = limit * (1.0 + 1e-12);
  try {
    by_paper_method(scene);
    ADD_FAILURE() << "no exception";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("paper.toml: load.moment = "));
    EXPECT_THAT(error.what(), HasSubstr(fmt::format("below {:.10g}", limit).substr(0, 14)));
  }
  scene.steps[0].torsion.moment = 0.5 * limit;
  EXPECT_NEAR(by_paper_method(scene).moment / limit, 0.5, kRounding);
}

}  // namespace
}  // namespace slipstick::solver
