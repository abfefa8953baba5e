#include "solver/contact/projected_gradient.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>
#include <random>
#include <vector>

#include "solver/newton/tests/project_with_moment.hpp"
#include "solver/scene/hertz_pressure.hpp"
#include "solver/tests/torsion_bench.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using namespace testing;

constexpr double kGradientGap = 1e-10;

ProjectedGradientOptions to_gap(double tolerance) {
  ProjectedGradientOptions options;
  options.tolerance = tolerance;
  return options;
}

/// An elliptic contact, 1 to 0.6, of friction bound sqrt(1 - ...) on a grid that is wider than it.
struct GradientBench {
  explicit GradientBench(Index cells, OperatorKind kind = OperatorKind::dcfft)
      : grid{cells, cells, 2.2 / static_cast<double>(cells), 1.4 / static_cast<double>(cells)},
        bound(hertz_cell_averages({1.0, 0.6, 1.0}, grid)),
        t(rotation_field(grid)),
        op(make_operator(kind, grid, tangential_kernel(), *half_spaces({1.0, 0.3}, {1.0, 0.3}))),
        limit(moment_limit(grid, bound)) {}

  TangentialSolution solve(const TangentialProblem& problem, double gap = kGradientGap) const {
    return solve_by_projected_gradient(*op, problem, to_gap(gap));
  }
  double moment_of(const ArrayXd& q) const { return (q * t).sum(); }
  double gap_of(const TangentialSolution& solution) const {
    return certify({solution.traction, solution.elastic_displacement, solution.slip}, bound, t, 0.0).gap;
  }
  double energy(const ArrayXd& q, const ArrayXd& load) const {
    ArrayXd u(q.size());
    op->apply(q, u);
    return (q * (0.5 * u + load)).sum();
  }

  Grid grid;
  ArrayXd bound;
  ArrayXd t;
  std::unique_ptr<LinearOperator> op;
  double limit;
};

/// Displacements as by a pressure on unlike bodies: towards the centre, a fifth of torsion's displacements.
ArrayXd inward(const GradientBench& bench, double size = 0.3) {
  ArrayXd load(2 * bench.grid.cells());
  load << -size * cell_x1(bench.grid), -size * cell_x2(bench.grid);
  return load;
}

void expect_coulombs_law(const TangentialSolution& solution, const ArrayXd& bound, double tolerance) {
  const ArrayXd size = norms(solution.traction);
  const ArrayXd slip = norms(solution.slip);
  const ArrayXd along = dot_products(solution.traction, solution.slip);
  const double largest_slip = slip.maxCoeff();
  ASSERT_GT(largest_slip, 0.0);
  for (Index i = 0; i < bound.size(); ++i) {
    if (bound[i] == 0.0) {
      EXPECT_EQ(size[i], 0.0);
      EXPECT_EQ(slip[i], 0.0);
      EXPECT_EQ(solution.stick[i], 0.0);
    } else if (solution.stick[i] != 0.0) {
      EXPECT_LE(size[i], bound[i] * (1.0 + kRounding));
      EXPECT_LE(slip[i], tolerance * largest_slip);
    } else {
      EXPECT_NEAR(size[i] / bound[i], 1.0, tolerance);
      EXPECT_LE(slip[i] + along[i] / bound[i], tolerance * largest_slip);  // slip against traction
    }
  }
}

class Ellipse : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(MomentRatios, Ellipse, testing::Values(0.1, 0.5, -0.5, 0.9));

TEST_P(Ellipse, ObeysCoulombsLawInEveryCell) {
  for (const bool loaded : {false, true}) {
    const GradientBench bench(24);
    TangentialProblem problem = under_moment(bench.bound, GetParam() * bench.limit);
    if (loaded) problem.initial_displacement = inward(bench);
    const TangentialSolution solution = bench.solve(problem);
    ASSERT_EQ(solution.status, Status::converged) << solution.message;
    EXPECT_THAT(solution.message, testing::IsEmpty());
    EXPECT_LE(bench.gap_of(solution), kGradientGap);
    EXPECT_EQ(bench.gap_of(solution), solution.change);
    EXPECT_NEAR(bench.moment_of(solution.traction) / bench.limit, GetParam(), kRounding);
    EXPECT_GT(solution.stick.sum(), 0.0);
    EXPECT_GT((bench.bound > 0.0).count(), solution.stick.sum());
    expect_coulombs_law(solution, bench.bound, 1e-4);
  }
}

TEST_P(Ellipse, ReportsWhatItsTractionsCause) {
  const GradientBench bench(16);
  TangentialProblem problem = under_moment(bench.bound, GetParam() * bench.limit);
  problem.initial_displacement = inward(bench);
  const TangentialSolution solution = bench.solve(problem);
  ArrayXd u(solution.traction.size());
  bench.op->apply(solution.traction, u);
  EXPECT_TRUE((u == solution.elastic_displacement).all());
  const ArrayXd slip = u + problem.initial_displacement - solution.twist * bench.t;
  const ArrayXd contact = (bench.bound > 0.0).cast<double>().replicate(2, 1);
  EXPECT_LE(largest(contact * slip - solution.slip), kRounding * largest(u));
}

TEST_P(Ellipse, AnswersItsTwistWithItsMoment) {
  const GradientBench bench(24);
  const TangentialSolution by_moment = bench.solve(under_moment(bench.bound, GetParam() * bench.limit));
  const TangentialSolution by_twist = bench.solve(under_twist(bench.bound, by_moment.twist));
  ASSERT_EQ(by_twist.status, Status::converged) << by_twist.message;
  EXPECT_EQ(by_twist.twist, by_moment.twist);
  EXPECT_LE(bench.gap_of(by_twist), kGradientGap);
  EXPECT_NEAR(bench.moment_of(by_twist.traction) / by_moment.twist,
              bench.moment_of(by_moment.traction) / by_moment.twist,
              1e-6 * bench.limit / std::abs(by_moment.twist));
  EXPECT_LE(relative_difference(by_twist.traction, by_moment.traction), 1e-4);
  EXPECT_TRUE((by_twist.stick == by_moment.stick).all());
}

/// The gap bounds the energy's excess over the minimum, so that no admissible traction may be lower by more.
TEST_P(Ellipse, HasTheLeastEnergy) {
  const GradientBench bench(16);
  TangentialProblem problem = under_moment(bench.bound, GetParam() * bench.limit);
  for (const double size : {0.0, 0.3}) {
    problem.initial_displacement = inward(bench, size);
    const TangentialSolution solution = bench.solve(problem);
    const double least = bench.energy(solution.traction, problem.initial_displacement);
    const double slack = kGradientGap * 0.5 * (solution.traction * solution.elastic_displacement).sum();
    std::mt19937 generator(7);
    std::normal_distribution<double> value;
    for (int trial = 0; trial < 50; ++trial) {
      const double spread = std::pow(10.0, -trial % 5);
      ArrayXd other =
          solution.traction + spread * ArrayXd::NullaryExpr(bench.t.size(), [&] { return value(generator); });
      project_with_moment(other, bench.bound, bench.grid, *problem.moment);
      EXPECT_GE(bench.energy(other, problem.initial_displacement), least - slack);
    }
    if (size != 0.0) continue;  // under a radial load the paper's method may lose all of its stick area
    const TangentialSolution paper = solve_by_paper_method(*bench.op, problem, to_tolerance(1e-10));
    ASSERT_EQ(paper.status, Status::converged) << paper.message;
    EXPECT_GE(bench.energy(paper.traction, problem.initial_displacement), least - slack);
  }
}

/// Without a moment: the surfaces slip by the displacements by the pressure, unless tractions hold them.
TEST(EllipticContact, IsNotWithoutTractionWhereThePressureMovesTheSurfaces) {
  const GradientBench bench(16);
  TangentialProblem problem = under_moment(bench.bound, 0.0);
  problem.initial_displacement = inward(bench);
  for (const TangentialSolution& solution :
       {bench.solve(problem), solve_by_paper_method(*bench.op, problem, to_tolerance(1e-10))}) {
    EXPECT_FALSE(solution.status == Status::converged && (solution.traction == 0.0).all());
  }
}

/// |q - q*|_K^2/2 is at most the gap: a looser solution differs from a tight one by no more.
TEST(EllipticContact, IsAsNearAsItsGapPromises) {
  const GradientBench bench(24);
  const TangentialProblem problem = under_moment(bench.bound, 0.5 * bench.limit);
  const TangentialSolution tight = bench.solve(problem, 1e-12);
  ASSERT_EQ(tight.status, Status::converged) << tight.message;
  const double energy = 0.5 * (tight.traction * tight.elastic_displacement).sum();
  for (const double tolerance : {1e-2, 1e-4, 1e-6}) {
    const TangentialSolution loose = bench.solve(problem, tolerance);
    EXPECT_LE(bench.gap_of(loose), tolerance);
    EXPECT_LT(loose.iterations, tight.iterations);
    const ArrayXd error = loose.traction - tight.traction;
    EXPECT_LE(bench.energy(error, 0.0 * error), 2.0 * tolerance * energy);
  }
}

TEST(Circle, DoesNotDependOnTheOperatorNorOnTheStart) {
  const Bench bench(16);
  const TangentialProblem problem = under_moment(bench.bound, 0.5 * bench.limit);
  const TangentialSolution reference = solve_by_projected_gradient(*bench.op, problem, to_gap(1e-12));
  const Bench dense(16, paper::kFriction, OperatorKind::dense);
  const TangentialSolution other = solve_by_projected_gradient(*dense.op, problem, to_gap(1e-12));
  EXPECT_LE(relative_difference(other.traction, reference.traction), 1e-6);
  EXPECT_NEAR(other.twist / reference.twist, 1.0, 1e-8);

  ProjectedGradientOptions options = to_gap(1e-12);
  options.start = -10.0 * rotation_field(bench.model.grid);
  const TangentialSolution from_afar = solve_by_projected_gradient(*bench.op, problem, options);
  EXPECT_LE(relative_difference(from_afar.traction, reference.traction), 1e-6);
  options.start = reference.traction;
  const TangentialSolution from_there = solve_by_projected_gradient(*bench.op, problem, options);
  EXPECT_LT(from_there.iterations, reference.iterations / 2);
  options.start = ArrayXd::Zero(3);
  EXPECT_THROW(solve_by_projected_gradient(*bench.op, problem, options), std::invalid_argument);
}

TEST(FullStick, OfABondedContactIsLinearInTheMoment) {
  const Bench bench(16);
  const ArrayXd bonded = (bench.bound > 0.0).select(ArrayXd::Constant(bench.bound.size(), 20.0), 0.0);
  const auto solve = [&](double moment) {
    TangentialSolution solution =
        solve_by_projected_gradient(*bench.op, under_moment(bonded, moment), to_gap(1e-8));
    EXPECT_EQ(solution.status, Status::converged) << solution.message;
    EXPECT_EQ(solution.stick.sum(), static_cast<double>((bonded > 0.0).count()));
    EXPECT_NEAR(bench.moment_of(solution.traction) / moment, 1.0, 1e-6);
    return solution;
  };
  const TangentialSolution once = solve(1.0);
  const TangentialSolution twice = solve(2.0);
  EXPECT_NEAR(twice.twist / once.twist, 2.0, 1e-6);
  EXPECT_GT(once.twist, 0.0);
}

/// On a circle any moment makes the edge slip, but on cells not a tiny one.
TEST(FullStick, UnderATinyMoment) {
  const Bench bench(16);
  const TangentialSolution solution =
      solve_by_projected_gradient(*bench.op, under_moment(bench.bound, 1e-3 * bench.limit), to_gap(1e-8));
  ASSERT_EQ(solution.status, Status::converged) << solution.message;
  EXPECT_EQ(solution.stick.sum(), static_cast<double>((bench.bound > 0.0).count()));
  EXPECT_NEAR(bench.moment_of(solution.traction) / bench.limit, 1e-3, kRounding);
}

TEST(ProjectedGradient, RefusesWhatNoTractionCanCarry) {
  const Bench bench(8);
  EXPECT_THROW(solve_by_projected_gradient(*bench.op, under_moment(bench.bound, bench.limit)),
               std::invalid_argument);
}

TEST(ProjectedGradient, AppliesOnceAnIteration) {
  const Bench bench(24);
  const long before = bench.op->applications();
  const TangentialSolution solution =
      solve_by_projected_gradient(*bench.op, under_moment(bench.bound, 0.5 * bench.limit));
  ASSERT_EQ(solution.status, Status::converged) << solution.message;
  EXPECT_LE(bench.op->applications() - before, solution.iterations + 8);  // curvatures and the start
}

TEST(ProjectedGradient, TellsItsProgress) {
  const Bench bench(24);
  std::vector<double> gaps;
  int last = 0;
  ProjectedGradientOptions options = to_gap(1e-8);
  options.progress = [&](int iteration, double gap) {
    last = iteration;
    gaps.push_back(gap);
  };
  const TangentialSolution solution =
      solve_by_projected_gradient(*bench.op, under_moment(bench.bound, 0.5 * bench.limit), options);
  ASSERT_GE(gaps.size(), 3U);
  EXPECT_EQ(gaps.back(), solution.change);
  EXPECT_EQ(last, solution.iterations);
  EXPECT_LT(gaps.back(), 1e-3 * gaps.front());
}

TEST(ProjectedGradientBreakdown, OfTooFewIterationsIsNamedWithItsNumbers) {
  const Bench bench(24);
  ProjectedGradientOptions options = to_gap(1e-9);
  options.max_iterations = 7;  // between two evaluations of the certificate
  const TangentialSolution solution =
      solve_by_projected_gradient(*bench.op, under_moment(bench.bound, 0.5 * bench.limit), options);
  EXPECT_EQ(solution.status, Status::not_converged);
  EXPECT_EQ(solution.iterations, 7);
  EXPECT_EQ(solution.message,
            fmt::format("too many iterations: gap {:.3g} after 7, tolerance 1e-09", solution.change));
  EXPECT_GT(solution.change, 1e-9);
  EXPECT_NEAR(bench.moment_of(solution.traction) / bench.limit, 0.5, kRounding);  // admissible all the same
}

// No gap is below the rounding of its displacements.
TEST(ProjectedGradientBreakdown, OfProgressIsSeenLongBeforeTheLastIteration) {
  const Bench bench(24);
  const TangentialSolution solution =
      solve_by_projected_gradient(*bench.op, under_moment(bench.bound, 0.5 * bench.limit), to_gap(1e-30));
  EXPECT_EQ(solution.status, Status::not_converged);
  EXPECT_THAT(solution.message, StartsWith("no further progress"));
  EXPECT_LT(solution.change, 1e-12);
  EXPECT_LT(solution.iterations, 2000);
}

/// A linear operator of the test's own: a function of the cell and of how often it was called.
class MadeUpOperator final : public LinearOperator {
 public:
  using Factor = std::function<double(std::size_t cell, long call)>;
  MadeUpOperator(const Grid& grid, Factor factor)
      : LinearOperator(grid, tangential_kernel()), factor_(std::move(factor)) {}

 private:
  void do_apply(std::span<const double> traction, std::span<double> displacement) override {
    for (std::size_t i = 0; i < traction.size(); ++i)
      displacement[i] = factor_(i, applications()) * traction[i];
  }
  Factor factor_;
};

TEST(ProjectedGradientBreakdown, OfNumbersThatAreNotFiniteIsNamed) {
  const Bench bench(16);
  const TangentialProblem problem = under_moment(bench.bound, 0.5 * bench.limit);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    MadeUpOperator broken(bench.model.grid, [&](std::size_t, long) { return bad; });
    const TangentialSolution solution = solve_by_projected_gradient(broken, problem);
    EXPECT_EQ(solution.status, Status::not_converged);
    EXPECT_THAT(solution.message, StartsWith("no step length: norm of K = "));

    MadeUpOperator late(bench.model.grid, [&](std::size_t, long call) { return call < 12 ? 1.0 : bad; });
    const TangentialSolution broke_later = solve_by_projected_gradient(late, problem, to_gap(1e300));
    EXPECT_EQ(broke_later.status, Status::not_converged);
    EXPECT_THAT(broke_later.message, StartsWith("not finite: gap = "));
    EXPECT_THAT(broke_later.message, HasSubstr("in iteration 10"));
    EXPECT_FALSE(broke_later.change <= 1e300);
  }
}

TEST(ProjectedGradientBreakdown, OfAnOperatorThatIsNotPositiveDefiniteIsNamed) {
  const Bench bench(16);
  MadeUpOperator indefinite(bench.model.grid, [](std::size_t, long) { return -1.0; });
  const TangentialSolution solution =
      solve_by_projected_gradient(indefinite, under_moment(bench.bound, 0.5 * bench.limit));
  EXPECT_EQ(solution.status, Status::not_converged);
  EXPECT_THAT(solution.message, StartsWith("indefinite operator: q.Kq/2 = -"));
}

/// The power iterations start from a field that is zero in this component of an outermost cell, and an
/// operator without coupling leaves it so: the curvature that the steps meet has to mend the bound.
TEST(Backtracking, MendsAStepThatIsTooLong) {
  const Grid grid{16, 16, 1.0, 1.0};
  const ArrayXd bound = ArrayXd::Ones(grid.cells());
  const std::size_t soft = 8 * 16 + 15;
  MadeUpOperator op(grid, [&](std::size_t i, long) { return i == soft ? 10.0 : 1.0; });
  const TangentialProblem problem = under_moment(bound, 0.5 * moment_limit(grid, bound));
  const TangentialSolution solution = solve_by_projected_gradient(op, problem, to_gap(1e-12));
  ASSERT_EQ(solution.status, Status::converged) << solution.message;
  // Each cell for itself: q = phi t, a tenth of it where it is soft, or the bound.
  const ArrayXd& q = solution.traction;
  EXPECT_NEAR(10.0 * q[static_cast<Index>(soft)], -solution.twist * grid.x2(15), 1e-6 * solution.twist);
  EXPECT_LE(largest(dot_products(q, q).sqrt()), 1.0 + kRounding);
}

/// Without a limit the momentum grows to 1, and the fine mesh takes 1280 iterations.
TEST(Momentum, KeepsIterationsFew) {
  const auto iterations = [](Index cells) {
    const Bench bench(cells);
    const TangentialSolution solution =
        solve_by_projected_gradient(*bench.op, under_moment(bench.bound, 0.5 * bench.limit), to_gap(1e-8));
    EXPECT_EQ(solution.status, Status::converged) << solution.message;
    return solution.iterations;
  };
  EXPECT_LE(iterations(64), 200);
  EXPECT_LE(iterations(128), 250);
}

/// An operator D - (1 - eps) Dc (Dc)^T/c.Dc with D diagonal, 1 and 1/20, and the checkerboard c soft: the
/// limit of the momentum is no help, and the limit from torsion, which hardly feels c, must be dropped where
/// it overshoots.
class SoftOnTheCheckerboard final : public LinearOperator {
 public:
  explicit SoftOnTheCheckerboard(const Grid& grid) : LinearOperator(grid, tangential_kernel()) {
    D_ = c_ = ArrayXd::Ones(2 * grid.cells());
    for (Index i = 0; i < D_.size(); ++i) {
      const Index cell = i % grid.cells();
      if ((cell / grid.n2 + cell % grid.n2) % 2 != 0) c_[i] = -1.0;
      if (cell % 3 == 0) D_[i] = 0.05;
    }
    c_ *= rotation_field(grid);
  }

 private:
  void do_apply(std::span<const double> traction, std::span<double> displacement) override {
    const ArrayXd Dq = D_ * Eigen::Map<const ArrayXd>(traction.data(), D_.size());
    const double part = (1.0 - 1e-6) * (c_ * Dq).sum() / (c_ * D_ * c_).sum();
    Eigen::Map<ArrayXd>(displacement.data(), D_.size()) = Dq - part * D_ * c_;
  }
  ArrayXd D_, c_;
};

TEST(Momentum, IsGivenUpWhereItOvershoots) {
  const Grid grid{16, 16, 1.0, 1.0};
  const ArrayXd bound = ArrayXd::Ones(grid.cells());
  SoftOnTheCheckerboard op(grid);
  const TangentialSolution solution =
      solve_by_projected_gradient(op, under_moment(bound, 0.5 * moment_limit(grid, bound)), to_gap(1e-10));
  ASSERT_EQ(solution.status, Status::converged) << solution.message;
  EXPECT_LE(solution.iterations, 200);
}

}  // namespace
}  // namespace slipstick::solver
