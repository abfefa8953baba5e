// Where the cells of a file lie, and how exactly it says so.

#include "convergence/check/foreign_field.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>

#include "solver/input/file_precision.hpp"
#include "solver/input/tests/complaint.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::find_precision;
using solver::Index;
using namespace testing;

ArrayXd written(const ArrayXd& values, const std::string& format) {
  return values.unaryExpr(
      [&](double x) { return std::strtod(fmt::format(fmt::runtime(format), x).c_str(), nullptr); });
}

TEST(FilePrecision, IsThatOfTheDigitsWritten) {
  const ArrayXd values = 1e8 * (ArrayXd::Random(200) + 1.1);
  EXPECT_DOUBLE_EQ(find_precision(written(values, "{:.5e}")).relative, 0.5e-5);
  EXPECT_DOUBLE_EQ(find_precision(written(values, "{:.9e}")).relative, 0.5e-9);
  EXPECT_DOUBLE_EQ(find_precision(written(1e-6 * values, "{:.3f}")).absolute, 0.5e-3);
  EXPECT_LE(find_precision(values).relative, 1.2e-16);
  EXPECT_NEAR(find_precision(values.cast<float>().cast<double>()).relative, 6e-8, 1e-9);
}

TEST(FilePrecision, BoundsWhatWritingHasChanged) {
  const ArrayXd values = 1e3 * ArrayXd::Random(200);
  for (const char* format : {"{:.4e}", "{:.2f}", "{:.0f}"}) {
    const ArrayXd read = written(values, format);
    const ArrayXd allowed = find_precision(read).rounding(read);
    EXPECT_TRUE(((read - values).abs() <= allowed * (1.0 + 1e-6)).all()) << format;
  }
}

struct Positions {
  solver::Column x1{"x1", {}};
  solver::Column x2{"x2", {}};
};

/// Cells (i, j) of a disc on a grid of 13 x 9 cells of h1 x h2 from (first1, first2) on, as `keep` says.
Positions positions(const std::function<bool(int, int)>& keep, double h1, double h2, double first1,
                    double first2) {
  std::vector<std::array<double, 2>> places;
  for (int i = 0; i < 13; ++i) {
    for (int j = 0; j < 9; ++j) {
      if (keep(i, j)) places.push_back({first1 + i * h1, first2 + j * h2});
    }
  }
  std::ranges::shuffle(places, std::mt19937(3));
  const Eigen::Map<const Eigen::Array2Xd> at(places.front().data(), 2, static_cast<Index>(places.size()));
  return {{"x1", at.row(0).transpose()}, {"x2", at.row(1).transpose()}};
}

bool in_disc(int i, int j) { return std::hypot((i - 6) / 6.6, (j - 4) / 4.6) < 1.0; }

FieldGrid find(const Positions& at) { return find_field_grid("field.csv", at.x1, at.x2); }

// Each row's cell is where the row lies, whatever order, offset and count of digits.
TEST(FieldGrid, IsFoundFromPositionsAlone) {
  for (const char* format : {"{:.17e}", "{:.9e}", "{:.3e}"}) {
    const double h1 = 1.3e-5;
    const double h2 = 2.1e-5;
    Positions at = positions(in_disc, h1, h2, -7.123e-5, 3.3e-5);
    const Positions exact = at;
    at.x1.values = written(at.x1.values, format);
    at.x2.values = written(at.x2.values, format);
    const FieldGrid found = find(at);
    EXPECT_EQ(found.grid.n1, 13);
    EXPECT_EQ(found.grid.n2, 9);
    EXPECT_NEAR(found.grid.h1 / h1, 1.0, 1e-3);
    EXPECT_NEAR(found.grid.h2 / h2, 1.0, 1e-3);
    for (Index row = 0; row < at.x1.values.size(); ++row) {
      const Index cell = found.cells[static_cast<std::size_t>(row)];
      EXPECT_NEAR(found.centre[0] + found.grid.x1(cell / 9), exact.x1.values[row], 1e-2 * h1);
      EXPECT_NEAR(found.centre[1] + found.grid.x2(cell % 9), exact.x2.values[row], 1e-2 * h2);
    }
  }
}

// Positions that are round numbers have few digits and no rounding.
TEST(FieldGrid, TakesRoundNumbersAsTheyAre) {
  for (const double first : {0.0, 5e-6, -6e-5}) {
    const FieldGrid found = find(positions(in_disc, 1e-5, 1e-5, first, first));
    EXPECT_EQ(found.grid.n1, 13);
    EXPECT_NEAR(found.grid.h1, 1e-5, 1e-18);
  }
}

TEST(FieldGrid, LetsCellsAndWholeRowsOfThemBeMissing) {
  const FieldGrid found =
      find(positions([](int i, int j) { return i != 4 && (i + 2 * j) % 5 != 0; }, 1e-5, 1e-5, 0, 0));
  EXPECT_EQ(found.grid.n1, 13);
  EXPECT_EQ(found.grid.n2, 9);
  EXPECT_NEAR(found.grid.h1, 1e-5, 1e-18);
}

std::string complaint(const Positions& at) {
  return solver::complaint([&] { find(at); });
}

TEST(FieldGrid, NamesTheRowThatDoesNotFit) {
  Positions off = positions(in_disc, 1e-5, 1e-5, 0, 0);
  off.x1.values[16] += 0.3e-5;
  EXPECT_THAT(complaint(off), AllOf(HasSubstr("field.csv"), HasSubstr("row 17"), HasSubstr("x1 = ")));
  Positions twice = positions(in_disc, 1e-5, 1e-5, 0, 0);
  twice.x1.values[30] = twice.x1.values[3];
  twice.x2.values[30] = twice.x2.values[3];
  EXPECT_THAT(complaint(twice), AllOf(HasSubstr("row 31"), HasSubstr("row 4")));
  Positions far = positions(in_disc, 1e-5, 1e-5, 0, 0);
  far.x2.values[5] = 3.0;
  EXPECT_THAT(complaint(far), AllOf(HasSubstr("field.csv"), HasSubstr("row 6: x2 = 3")));
  const Positions few = positions([](int i, int) { return i < 3; }, 1e-5, 1e-5, 0, 0);
  EXPECT_THAT(complaint(few), AllOf(HasSubstr("x1"), HasSubstr("3"), HasSubstr("4")));
}

// One digit too many makes a grid of any size: the row is named before anything is held for each cell.
TEST(FieldGrid, NamesTheRowThatIsFarAway) {
  const Positions good = positions(in_disc, 1e-5, 1e-5, 1e-6, 1e-6);
  for (const double factor : {-1e3, 1e3, 1e4, 1e5, 1e6, 1e9, 1e300}) {
    Positions far = good;
    far.x1.values[33] *= factor;
    EXPECT_THAT(complaint(far), AllOf(HasSubstr("row 34"), HasSubstr("x1"), HasSubstr("allowed"))) << factor;
  }
}

// Columns in different units.
TEST(FieldGrid, RefusesCellsThatAreLongAndThin) {
  for (const double factor : {1e4, 1e9, 1e-4, 1e-9}) {
    const Positions thin = positions(in_disc, factor * 1e-5, 1e-5, 0, 0);
    EXPECT_THAT(complaint(thin), AllOf(HasSubstr("row 1: ("), HasSubstr("allowed"))) << factor;
  }
  EXPECT_EQ(complaint(positions(in_disc, 1e-4, 1e-6, 0, 0)), "");
}

// Two small patches in opposite corners, a hundred times as far apart as they are wide.
TEST(FieldGrid, TakesPatchesFarApart) {
  Positions patches =
      positions([](int i, int j) { return (i < 4 && j < 3) || (i > 9 && j > 5); }, 1e-5, 1e-5, 0, 0);
  for (solver::Column* const x : {&patches.x1, &patches.x2}) {
    x->values = (x->values > 5e-5).select(x->values + 60 * 1e-5, x->values);
  }
  EXPECT_EQ(find(patches).grid.n1, 73);
}

}  // namespace
}  // namespace slipstick::convergence
