#include "solver/newton/coefficients.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace slipstick::solver {
namespace {

constexpr double kFewRoundings = 1e-14;

CoefficientMatrix random_matrix(Eigen::Index rows, Eigen::Index columns) {
  return CoefficientMatrix::Random(rows, columns);
}

TEST(Coefficients, SolveARegularSystem) {
  for (Eigen::Index n = 1; n <= kMaxConditions; ++n) {
    const CoefficientMatrix matrix = random_matrix(n, n) + 2.0 * CoefficientMatrix::Identity(n, n);
    const Coefficients x = Coefficients::Random(n);
    EXPECT_LE((least_solution(matrix, matrix * x) - x).norm(), kFewRoundings * x.norm()) << n;
  }
}

// The pseudo-inverse of u v^T is v u^T / (|u|^2 |v|^2).
TEST(Coefficients, AreTheLeastThatSolveASingularSystem) {
  const Coefficients u = Coefficients::Random(3);
  const Coefficients v = Coefficients::Random(3);
  const Coefficients right = Coefficients::Random(3);
  const Coefficients expected = v * u.dot(right) / (u.squaredNorm() * v.squaredNorm());
  EXPECT_LE((least_solution(u * v.transpose(), right) - expected).norm(), kFewRoundings * expected.norm());
}

// The least x of fewer equations than unknowns is made of the equations' rows.
TEST(Coefficients, AreTheLeastOfFewerEquationsThanUnknowns) {
  const CoefficientMatrix row = random_matrix(1, 2);
  Coefficients right(1);
  right << 0.7;
  const Coefficients expected = row.transpose() * right / row.squaredNorm();
  EXPECT_LE((least_solution(row, right) - expected).norm(), kFewRoundings);
}

TEST(Coefficients, AreZeroWithoutEquationsAndNaNWhereTheyAre) {
  const Coefficients one = Coefficients::Ones(2);
  EXPECT_EQ(least_solution(CoefficientMatrix::Zero(2, 2), one).norm(), 0.0);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), HUGE_VAL}) {
    CoefficientMatrix matrix = CoefficientMatrix::Identity(2, 2);
    matrix(1, 0) = bad;
    EXPECT_TRUE(std::isnan(least_solution(matrix, one)[0])) << bad;
  }
}

TEST(Coefficients, AreFoundAtTheEndsOfTheRange) {
  const Coefficients one = Coefficients::Ones(2);
  for (const double size : {1e-300, 1e300}) {
    CoefficientMatrix matrix(2, 2);
    matrix << 2.0, 1.0, 1.0, 3.0;
    const Coefficients x = least_solution(size * matrix, size * one);
    EXPECT_LE((x - least_solution(matrix, one)).norm(), kFewRoundings) << size;
  }
}

}  // namespace
}  // namespace slipstick::solver
