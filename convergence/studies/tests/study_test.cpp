// Errors of tractions by region, expected orders, and solves in processes of their own. studies_test.py tests
// studies as a whole.

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>

#include "convergence/oracle/errors.hpp"
#include "convergence/oracle/oracle.hpp"
#include "convergence/orders/expected_order.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/process_pool.hpp"
#include "convergence/studies/study_judgement.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/model/make_model.hpp"

namespace slipstick::convergence {
namespace {

std::string cells(int n) { return "grid.cells=[" + std::to_string(n) + "," + std::to_string(n) + "]"; }

using Solves = ScratchFolder;

/// Solves do not reap other children of this process.
TEST_F(Solves, LeaveOtherChildrenAlone) {
  const ProcessPool pool({.folder = folder_ / "points", .program = SLIPSTICK_PROGRAM});
  const pid_t other = fork();
  if (other == 0) _exit(3);
  EXPECT_TRUE(pool.run(RunSpec{SLIPSTICK_SCENES "/paper.toml", {cells(16)}}).is_converged());
  int status = 0;
  EXPECT_EQ(waitpid(other, &status, 0), other);
  EXPECT_EQ(WEXITSTATUS(status), 3);
}

/// A field that is exact at the centres differs from cell averages only where the traction has an edge, and
/// there less and less: by h^(1/2) in bands of width h.
TEST(TractionError, AverageAndCentreDifferAtTheEdgesOnly) {
  const auto error_at = [](int n) {
    const solver::Scene scene = example("paper", {cells(n)});
    const solver::Grid grid = solver::make_model(scene).grid_in_m();
    const Oracle oracle = *find_oracle(scene).oracle;
    return traction_error(exact_fields(oracle, grid).traction, oracle, grid);
  };
  const TractionError coarse = error_at(32);
  const TractionError fine = error_at(128);
  for (const TractionError& error : {coarse, fine}) {
    EXPECT_EQ(error.at_centres.max, 0.0);
    EXPECT_EQ(error.inside.max, 0.0);
    EXPECT_EQ(error.outside.max, 0.0);
    EXPECT_GT(error.stick_edge.l1, 0.0);
    EXPECT_GT(error.contact_edge.l1, 0.0);
  }
  EXPECT_NEAR(std::log(coarse.averaged.l1 / fine.averaged.l1) / std::log(4.0), 1.5, 0.25);
  EXPECT_NEAR(std::log(coarse.averaged.l2 / fine.averaged.l2) / std::log(4.0), 1.0, 0.25);
}

TEST(TractionError, RegionsAddUpToTheWhole) {
  const solver::Scene scene = example("paper", {cells(48)});
  const solver::Grid grid = solver::make_model(scene).grid_in_m();
  const Oracle oracle = *find_oracle(scene).oracle;
  const Eigen::ArrayXd exact = exact_fields(oracle, grid).traction;
  const TractionError error = traction_error(1.01 * exact, oracle, grid);
  EXPECT_NEAR(error.at_centres.l1, 0.01, 1e-12);
  EXPECT_NEAR(error.at_centres.l2, 0.01, 1e-12);
  EXPECT_NEAR(error.at_centres.max, 0.01, 1e-12);
  const FieldError parts[] = {error.stick_edge, error.contact_edge, error.inside, error.outside};
  double l1 = 0.0;
  double squares = 0.0;
  double most = 0.0;
  for (const FieldError& part : parts) {
    l1 += part.l1;
    squares += part.l2 * part.l2;
    most = std::max(most, part.max);
  }
  EXPECT_NEAR(l1, error.averaged.l1, 1e-12);
  EXPECT_NEAR(std::sqrt(squares), error.averaged.l2, 1e-12);
  EXPECT_EQ(most, error.averaged.max);
}

TEST(ExpectedOrder, EveryErrorHasOneWithAReasonWhereTheEdgeIsARoot) {
  const solver::Scene sphere = example("paper");
  const solver::Scene punch = example("flat_punch");
  const solver::Scene rough = example("rough_sphere");
  for (const auto& [quantity, label] : error_quantities()) {
    EXPECT_GT(expected_order(quantity, sphere).value, 0.0) << quantity;
    EXPECT_FALSE(expected_order(quantity, sphere).why.empty());
    EXPECT_TRUE(std::isnan(expected_order(quantity, rough).value));
    const double singular = expected_order(quantity, punch).value;
    EXPECT_FALSE(singular > expected_order(quantity, sphere).value) << quantity;
  }
}

}  // namespace
}  // namespace slipstick::convergence
