#include <gmock/gmock.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <string>

#include "solver/elasticity/direct.hpp"
#include "solver/newton/conjugate_gradients.hpp"
#include "solver/newton/tangent_space.hpp"
#include "solver/tests/fields.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXf;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::HasSubstr;

const HalfSpaces kPair(elastic_pair({2.0, 0.3}, {2.0, 0.3}));
/// Residuals fall by this factor. They belong to random right-hand sides, which lie mostly across the tangent space.
constexpr double kReduction = 1e-13;
/// The relative error of the solution then: the systems of some tens of unknowns have condition numbers of
/// some hundreds.
constexpr double kSolved = 1e-11;
constexpr int kMany = 500;

/// Any field as a condition.
struct FieldCondition {
  template <typename Values>
  double dot(Index first, const Values& with) const {
    return (values.segment(first, with.size()) * with).sum();
  }
  template <typename Part>
  void add_to(Part&& part, Index first, double factor) const {
    part += (factor * values.segment(first, part.size()));
  }

  Eigen::ArrayXd values;
};

/// Solves on a tangent space, with everything that the iteration needs.
class TangentCg {
 public:
  using Field = Eigen::ArrayXd;

  TangentCg(LinearOperator& op, InverseSymbol& symbol, Index size, std::size_t conditions)
      : op_(op),
        symbol_(symbol),
        packing_(op.grid(), Sweep::whole(op.grid()), static_cast<Index>(op.inputs())),
        r_(size),
        x_(size),
        d_(size),
        Ad_(size),
        y_(size),
        w_(conditions, CgTangent(size)),
        constraints_(w_) {}

  Field& residual() { return r_; }
  const Field& solution() const { return x_; }

  bool precondition(const TangentSpace& space, std::vector<FieldCondition> conditions) {
    conditions_ = std::move(conditions);
    std::array<const FieldCondition*, kMaxConditions> each{};
    std::ranges::transform(conditions_, each.begin(), [](const FieldCondition& c) { return &c; });
    TangentPreconditioner inverse{symbol_, space, packing_};
    return constraints_.prepare(inverse, std::span(each).first(conditions_.size()), d_, y_);
  }
  /// The tangents of the last precondition() on another tangent space.
  bool restrict_tangents(const TangentSpace& space) {
    const TangentPreconditioner inverse{symbol_, space, packing_};
    return constraints_.restrict_tangents(inverse, Sweep(Eigen::ArrayXd::Ones(space.f1.size())), y_);
  }
  CgSummary solve(const TangentSpace& space, double reduction, int max_iterations) {
    return run(space, {}, reduction, max_iterations);
  }
  /// Under the conditions of the last precondition().
  CgSummary solve_constrained(const TangentSpace& space, double reduction, int max_iterations) {
    return run(space, constraints_, reduction, max_iterations);
  }

 private:
  using Constraints = CgConstraints<FieldCondition>;
  CgSummary run(const TangentSpace& space, const Constraints& constraints, double reduction, int max_iterations) {
    TangentOperator map{op_, space, packing_};
    TangentPreconditioner inverse{symbol_, space, packing_};
    x_.setZero();
    return projected_cg(map, inverse, constraints, r_, {reduction, max_iterations}, {d_, Ad_, y_}, x_);
  }

  LinearOperator& op_;
  InverseSymbol& symbol_;
  Packing packing_;  ///< of all cells
  Field r_, x_;
  Field d_, Ad_, y_;
  std::vector<CgTangent> w_;
  std::vector<FieldCondition> conditions_;
  Constraints constraints_;
};

std::vector<FieldCondition> one(const ArrayXd& condition) { return {{condition}}; }

/// Cells that stick, slip against various stiffnesses, or carry nothing.
TangentSpace random_states(Index cells, unsigned seed) {
  TangentSpace space(2, cells);
  const ArrayXd random = random_field(3 * cells, seed);
  for (Index i = 0; i < cells; ++i) {
    if (random[i] < -0.6) {
      space.set(i, false);
    } else if (random[i] < 0.1) {
      space.set(i, true);
    } else {
      const double angle = 3.2 * random[i + cells];
      const double stiffness = std::pow(10.0, 2.0 * random[i + 2 * cells]);
      space.set_line(i, std::cos(angle), std::sin(angle), stiffness, 1.0);
    }
  }
  space.find_free();
  return space;
}

/// A column for each way that a cell may move: the tangent space, spelled out.
MatrixXd basis(const TangentSpace& space) {
  const Index n = space.f1.size();
  std::vector<VectorXd> columns;
  const auto add = [&](Index i, double f1, double f2) {
    VectorXd column = VectorXd::Zero(space.components() * n);
    column[i] = f1;
    if (space.components() == 2) column[i + n] = f2;
    columns.push_back(column);
  };
  for (Index i = 0; i < n; ++i) {
    if (space.components() == 1) {
      if (space.f1[i] > 0.0) add(i, 1.0, 0.0);
    } else if (!space.on_line(i)) {
      add(i, 1.0, 0.0);
      add(i, 0.0, 1.0);
    } else if (space.f1[i] != 0.0 || space.f2[i] != 0.0) {
      add(i, space.f1[i], space.f2[i]);
    }
  }
  MatrixXd result(space.components() * n, static_cast<Index>(columns.size()));
  for (Index k = 0; k < result.cols(); ++k) result.col(k) = columns[static_cast<std::size_t>(k)];
  return result;
}

/// The operators of one grid, and the same problem as a dense one.
struct CgBench {
  CgBench(const Grid& grid, bool vectors, unsigned seed)
      : size((vectors ? 2 : 1) * grid.cells()),
        op(grid, vectors ? tangential_kernel() : normal_kernel(), kPair),
        symbol(make_inverse_symbol(grid, vectors ? tangential_kernel() : normal_kernel(), kPair)),
        cg(op, *symbol, size, kMaxConditions),
        space(random_states(grid.cells(), seed)) {
    if (!vectors) {
      space = TangentSpace(1, grid.cells());
      const ArrayXd random = random_field(grid.cells(), seed);
      for (Index i = 0; i < grid.cells(); ++i) space.set(i, random[i] > -0.3);
      space.find_free();
    }
    free = basis(space);
    MatrixXd matrix = op.matrix();
    if (vectors) matrix.diagonal().array() += space.stiffness.cast<double>().replicate(2, 1);
    tangent = free.transpose() * matrix * free;
  }

  /// (K + stiffness)^-1 c on the tangent space.
  VectorXd inverse(const VectorXd& c) const { return free * tangent.fullPivLu().solve(free.transpose() * c); }
  /// The same with c.x = 0 for each column c: the multipliers take out what would violate that.
  VectorXd constrained(const VectorXd& r, const MatrixXd& conditions) const {
    const Index n = tangent.rows();
    const Index m = conditions.cols();
    MatrixXd saddle = MatrixXd::Zero(n + m, n + m);
    saddle.topLeftCorner(n, n) = tangent;
    saddle.topRightCorner(n, m) = -free.transpose() * conditions;
    saddle.bottomLeftCorner(m, n) = conditions.transpose() * free;
    VectorXd right = VectorXd::Zero(n + m);
    right.head(n) = free.transpose() * r;
    return free * saddle.fullPivLu().solve(right).head(n);
  }
  ArrayXd preconditioned(const ArrayXd& r) {
    Packing all(op.grid(), Sweep::whole(op.grid()), space.components());
    TangentPreconditioner map{*symbol, space, all};
    ArrayXd z = ArrayXd::Zero(size);
    ArrayXd y = z;
    ArrayXd in_range = r;
    map.cells().each([&](Index first, Index last) {
      map.project(first, last, in_range);
      map.load(first, last, in_range, z);
    });
    map.transform(z);
    map.cells().each([&](Index first, Index last) { map.store(first, last, in_range, z, y); });
    return y;
  }

  Index size;
  DenseMatrix op;
  std::unique_ptr<InverseSymbol> symbol;
  TangentCg cg;
  TangentSpace space;
  MatrixXd free;
  MatrixXd tangent;
};

class CgOn : public testing::TestWithParam<std::tuple<Grid, bool>> {
 protected:
  CgBench bench(unsigned seed) const { return {std::get<0>(GetParam()), std::get<1>(GetParam()), seed}; }
};
std::string name_of(const testing::TestParamInfo<std::tuple<Grid, bool>>& tested) {
  const auto& [grid, vectors] = tested.param;
  return (vectors ? "vectors_" : "scalars_") + std::to_string(grid.n1) + "x" + std::to_string(grid.n2);
}
INSTANTIATE_TEST_SUITE_P(Grids, CgOn,
                         testing::Combine(testing::Values(Grid{6, 5, 1.0, 1.0}, Grid{4, 9, 1.0, 1.7}), testing::Bool()),
                         name_of);

/// The fields side by side in an array, as conditions.
std::vector<FieldCondition> conditions_of(const ArrayXd& fields, Index size) {
  std::vector<FieldCondition> conditions;
  for (Index start = 0; start < fields.size(); start += size) conditions.push_back({fields.segment(start, size)});
  return conditions;
}

/// The answer of the dense problem, which keeps the conditions in the columns.
void expect_solved(CgBench& b, const CgSummary& summary, const ArrayXd& r, const MatrixXd& columns) {
  EXPECT_EQ(summary.message(), "");
  const VectorXd exact = b.constrained(r.matrix(), columns);
  EXPECT_LE((b.cg.solution().matrix() - exact).norm(), kSolved * exact.norm());
  EXPECT_LE((columns.transpose() * b.cg.solution().matrix()).norm(), 1e-13 * columns.norm() * exact.norm());
}

TEST_P(CgOn, SolvesUnderNoneOneAndThreeConditions) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    for (const Index count : {0, 1, 3}) {
      CgBench b = bench(seed);
      const ArrayXd r = random_field(b.size, 24 + seed);
      const ArrayXd c = random_field(count * b.size, 34 + seed);
      const MatrixXd columns = c.matrix().reshaped(b.size, count);
      ASSERT_TRUE(b.cg.precondition(b.space, conditions_of(c, b.size)));
      b.cg.residual() = r;
      const CgSummary summary =
          count == 0 ? b.cg.solve(b.space, kReduction, kMany) : b.cg.solve_constrained(b.space, kReduction, kMany);
      expect_solved(b, summary, r, columns);
      if (count == 0) {
        EXPECT_LE(summary.reduction, kReduction);
      }
      if (count < 3) continue;
      MatrixXd answers(b.size, count);
      for (Index k = 0; k < count; ++k) answers.col(k) = b.inverse(columns.col(k));
      const MatrixXd products = columns.transpose() * answers;
      const VectorXd multipliers = products.fullPivLu().solve(answers.transpose() * r.matrix());
      EXPECT_LE((summary.multipliers - multipliers).norm(), kSolved * multipliers.norm());
    }
  }
}

/// Any tangents keep the conditions, also the tangents of other states.
TEST_P(CgOn, SolvesWithTangentsOfOtherStates) {
  for (unsigned seed = 1; seed <= 4; ++seed) {
    CgBench b = bench(seed);
    CgBench other = bench(90 + seed);
    const ArrayXd r = random_field(b.size, 26 + seed);
    const ArrayXd c = random_field(2 * b.size, 36 + seed);
    ASSERT_TRUE(b.cg.precondition(other.space, {{c.head(b.size)}, {c.tail(b.size)}}));
    ASSERT_TRUE(b.cg.restrict_tangents(b.space));
    b.cg.residual() = r;
    const CgSummary summary = b.cg.solve_constrained(b.space, kReduction, kMany);
    expect_solved(b, summary, r, c.matrix().reshaped(b.size, 2));
  }
}

/// On the tangent space, whatever they are outside it.
TEST_P(CgOn, KnowsConditionsThatDependOnEachOther) {
  CgBench b = bench(9);
  const ArrayXd c = random_field(2 * b.size, 52);
  const VectorXd across = random_field(b.size, 53).matrix();
  const std::array<ArrayXd, 3> fields{
      c.head(b.size), c.tail(b.size),
      c.head(b.size) - 2.0 * c.tail(b.size) + (across - b.free * (b.free.transpose() * across)).array()};
  EXPECT_TRUE(b.cg.precondition(b.space, {{fields[0]}, {fields[1]}}));
  EXPECT_FALSE(b.cg.precondition(b.space, {{fields[0]}, {fields[1]}, {fields[2]}}));
  const ArrayXd nearly = fields[2] + 1e-3 * random_field(b.size, 54);
  EXPECT_TRUE(b.cg.precondition(b.space, {{fields[0]}, {fields[1]}, {nearly}}));
}

/// Wherever the iteration is stopped.
TEST_P(CgOn, KeepsTheConditionThroughout) {
  CgBench b = bench(5);
  const ArrayXd c = random_field(b.size, 41);
  for (const int iterations : {1, 2, 3, 5, 9}) {
    b.cg.precondition(b.space, one(c));
    b.cg.residual() = random_field(b.size, 42);
    EXPECT_EQ(b.cg.solve_constrained(b.space, 0.0, iterations).iterations, iterations);
    const VectorXd x = b.cg.solution().matrix();
    EXPECT_NEAR(c.matrix().dot(x), 0.0, 1e-13 * c.matrix().norm() * x.norm());
    EXPECT_LE((x - b.free * (b.free.transpose() * x)).norm(), 1e-13 * x.norm()) << "in the tangent space";
  }
}

/// At any iteration the last residual determines the error of the multipliers, c.A^-1 residual / c.A^-1 c.
/// They are the same whether the last residual is preconditioned or the condition is.
TEST_P(CgOn, FindsTheMultiplierAsWellAsTheResidualSays) {
  CgBench b = bench(6);
  const ArrayXd c = random_field(b.size, 51);
  const ArrayXd r = random_field(b.size, 43);
  const VectorXd w = b.inverse(c.matrix());
  const double exact = w.dot(r.matrix()) / w.dot(c.matrix());
  for (const int iterations : {1, 2, 5, 12, 40}) {
    b.cg.precondition(b.space, one(c));
    b.cg.residual() = r;
    const double measured = b.cg.solve_constrained(b.space, 1e-300, iterations).multipliers[0];
    const VectorXd left = b.cg.residual().matrix();
    EXPECT_NEAR(w.dot(left) / w.dot(c.matrix()), exact - measured, kSolved * std::abs(exact));
    b.cg.precondition(b.space, one(c));
    b.cg.residual() = r;
    EXPECT_NEAR(b.cg.solve_constrained(b.space, 0.0, iterations).multipliers[0], measured, kSolved * std::abs(exact));
    if (iterations == 40) {
      EXPECT_NEAR(measured, exact, 1e-3 * std::abs(exact));
    }
  }
}

/// Unit fields show the whole matrix: projector (scale S scale + shift) projector with the inverse symbol S.
TEST_P(CgOn, PreconditionerIsSymmetricAndDefiniteOnTheTangentSpace) {
  CgBench b = bench(7);
  MatrixXd symbol(b.size, b.size);
  MatrixXd preconditioner(b.size, b.size);
  for (Index i = 0; i < b.size; ++i) {
    ArrayXd unit = ArrayXd::Zero(b.size);
    unit[i] = 1.0;
    preconditioner.col(i) = b.preconditioned(unit).matrix();
    b.symbol->apply(std::span(unit.data(), static_cast<std::size_t>(b.size)));
    symbol.col(i) = unit.matrix();
  }
  const double largest = preconditioner.cwiseAbs().maxCoeff();
  EXPECT_LE((preconditioner - preconditioner.transpose()).cwiseAbs().maxCoeff(), 1e-13 * largest);
  const MatrixXd projector = b.free * b.free.transpose();
  EXPECT_LE((preconditioner - projector * preconditioner).cwiseAbs().maxCoeff(), 1e-13 * largest);
  const MatrixXd on_space = b.free.transpose() * preconditioner * b.free;
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatrixXd>(on_space).eigenvalues().minCoeff(), 0.0);

  MatrixXd expected = symbol;
  if (b.space.components() == 2) {
    const VectorXd scale = b.space.scale.cast<double>().replicate(2, 1).matrix();
    expected = scale.asDiagonal() * symbol * scale.asDiagonal();
    expected.diagonal() += b.space.shift.cast<double>().replicate(2, 1).matrix();
  }
  expected = projector * expected * projector;
  EXPECT_LE((preconditioner - expected).cwiseAbs().maxCoeff(), 1e-13 * largest);
}

// --- nothing to solve ---

TEST(Cg, KnowsAConditionOutsideTheTangentSpace) {
  CgBench b({4, 4, 1.0, 1.0}, true, 8);
  for (Index i = 0; i < 16; ++i) b.space.set(i, i != 5);
  b.space.find_free();
  ArrayXd c = ArrayXd::Zero(32);
  c[5] = c[21] = 1.0;
  EXPECT_FALSE(b.cg.precondition(b.space, one(c)));
  c[6] = 1e-3;
  EXPECT_TRUE(b.cg.precondition(b.space, one(c)));
}

TEST(Cg, HasNothingToDoWithoutAResidual) {
  CgBench b({4, 4, 1.0, 1.0}, true, 9);
  b.cg.residual() = ArrayXd::Zero(32);
  const CgSummary summary = b.cg.solve(b.space, 1e-10, kMany);
  EXPECT_EQ(summary.iterations, 0);
  EXPECT_EQ(summary.message(), "");
  EXPECT_TRUE((b.cg.solution() == 0.0).all());
  EXPECT_EQ(b.op.applications(), 0);
}

// --- breakdowns ---

CgSummary solve_with_multiple(double factor, double right) {
  const Grid grid{4, 4, 1.0, 1.0};
  Multiple op(grid, factor);
  const auto symbol = make_inverse_symbol(grid, tangential_kernel(), kPair);
  TangentCg cg(op, *symbol, 32, 1);
  TangentSpace space(2, 16);
  for (Index i = 0; i < 16; ++i) space.set(i, true);
  space.find_free();
  cg.residual() = random_field(32, 71);
  cg.residual()[3] *= right;
  return cg.solve(space, 1e-10, kMany);
}

TEST(CgBreakdown, IsNamed) {
  EXPECT_EQ(solve_with_multiple(2.0, 1.0).message(), "");
  EXPECT_THAT(solve_with_multiple(-2.0, 1.0).message(), HasSubstr("curvature -"));
  EXPECT_THAT(solve_with_multiple(0.0, 1.0).message(), HasSubstr("curvature 0"));
  EXPECT_THAT(solve_with_multiple(std::nan(""), 1.0).message(), HasSubstr("nan"));
  EXPECT_THAT(solve_with_multiple(2.0, std::nan("")).message(), HasSubstr("square is nan"));
}

}  // namespace
}  // namespace slipstick::solver
