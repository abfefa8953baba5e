#include "solver/fft/half_sample_transform.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>

namespace slipstick::solver {
namespace {

class HalfSampleTransformTest : public testing::Test {
 protected:
  using Transform = HalfSampleTransform;
  /// Lines or a spectrum: one row for each line or frequency.
  using Matrix = Eigen::Array<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  static constexpr Index kLines = Transform::kLines;
  static constexpr double kTolerance = 20.0 * std::numeric_limits<double>::epsilon();

  static Matrix spectrum(const Transform& transform, const Matrix& lines, int parity) {
    Transform::Workspace work(transform);
    Matrix rows(transform.frequencies(), kLines);
    transform.forward(work, {.data = lines.data(), .line_stride = lines.cols(), .count = lines.rows()},
                      parity, [&](Index k) { return &rows(k, 0); });
    return rows;
  }

  static double by_definition(const Matrix& lines, Index line, Index k, Index h, int parity) {
    const Index frequency = parity < 0 && k == 0 ? h : k;
    double sum = 0.0;
    for (Index j = 0; j < lines.cols(); ++j) {
      const Index turns = frequency * (2 * j + 1) % (4 * h);
      const double angle = std::numbers::pi * static_cast<double>(turns) / static_cast<double>(2 * h);
      sum += 2.0 * static_cast<double>(lines(line, j)) * (parity > 0 ? std::cos(angle) : std::sin(angle));
    }
    return sum;
  }
};

TEST_F(HalfSampleTransformTest, IsTheSumOfCosinesOrSines) {
  for (const Index samples : {1, 2, 3, 5, 8, 11, 16, 17, 30, 37, 64}) {
    const HalfSampleTransform transform(samples);
    EXPECT_GE(transform.frequencies(), 2 * samples);
    for (const Index count : {Index{1}, Index{2}, Index{5}, kLines}) {
      const Matrix lines = Matrix::Random(count, samples);
      for (const int parity : {1, -1}) {
        const Matrix rows = spectrum(transform, lines, parity);
        const double tolerance = kTolerance * std::sqrt(static_cast<double>(samples));
        for (Index line = 0; line < count; ++line) {
          for (Index k = 0; k < rows.rows(); ++k) {
            ASSERT_NEAR(static_cast<double>(rows(k, line)),
                        by_definition(lines, line, k, rows.rows(), parity), tolerance);
          }
        }
      }
    }
  }
}

TEST_F(HalfSampleTransformTest, ComesBackTimesAPeriod) {
  for (const Index samples : {1, 3, 8, 21, 50}) {
    const HalfSampleTransform transform(samples);
    typename HalfSampleTransform::Workspace work(transform);
    const Matrix lines = Matrix::Random(3, samples);
    for (const int parity : {1, -1}) {
      const Matrix rows = spectrum(transform, lines, parity);
      Matrix back = Matrix::Constant(4, samples, 7);
      transform.backward(work, {.data = back.data(), .line_stride = samples, .count = 3}, parity,
                         [&](Index k) { return transform.packets(&rows(k, 0)); });
      const auto period = static_cast<double>(2 * transform.frequencies());
      EXPECT_LE((back.topRows(3) / period - lines).abs().maxCoeff(), kTolerance);
      EXPECT_TRUE((back.row(3) == 7).all()) << "a line that does not exist must not be written";
    }
  }
}

}  // namespace
}  // namespace slipstick::solver
