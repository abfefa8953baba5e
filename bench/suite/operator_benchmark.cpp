// The tangential operator in each of its forms: its construction and one application, with the error against
// another form and the memory used. Bare padded transforms bound dcfft's time from below.

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <random>

#include "bench/suite/suite.hpp"
#include "solver/elasticity/direct.hpp"
#include "solver/elasticity/elasticity.hpp"
#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/elasticity/linear_operator.hpp"
#include "solver/fft/fftw.hpp"
#include "solver/grid/reduction.hpp"

namespace slipstick::bench {
namespace {

using Eigen::ArrayXd;
using namespace solver;

/// Ten times what rounding does: of direct sums on 128 cells along a side 2e-14, of transforms on 1,024 less;
constexpr double kAllowedError = 2e-13;

/// One way to apply the operator. All know a grid of cells x cells; `quarter` works on one quadrant of it.
struct Form {
  OperatorKind kind = OperatorKind::dcfft;
  OperatorOptions options = {};
  bool quarter = false;
};

solver::SharedLaw law() { return solver::half_spaces({2.0, 0.3}, {2.0, 0.3}); }

Grid whole(Index cells) { return {cells, cells, 1.0, 1.0}; }

Grid grid_of(const Form& form, Index cells) { return form.quarter ? solver::quadrant_of(whole(cells)) : whole(cells); }

std::shared_ptr<LinearOperator> make(const Form& form, const Grid& grid) {
  return solver::make_operator(form.kind, grid, solver::tangential_kernel(), *law(), form.options);
}

/// About what the operator holds.
double bytes(const Form& form, const Grid& grid) {
  const solver::Elasticity elastic{.law = law(), .kind = form.kind, .diagonal = form.options.diagonal};
  return elastic.operator_bytes(grid, solver::tangential_kernel());
}

ArrayXd apply(LinearOperator& op, const ArrayXd& traction) {
  ArrayXd displacement(traction.size());
  op.apply(traction, displacement);
  return displacement;
}

ArrayXd random_field(Index size) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  return ArrayXd::NullaryExpr(size, [&] { return uniform(generator); });
}

/// As a body of revolution has it: q2(x1, x2) = -q1(x2, x1).
ArrayXd with_diagonal_mirror(ArrayXd field, const Grid& grid) {
  for (Index i = 0; i < grid.n1; ++i) {
    for (Index j = 0; j < grid.n2; ++j) {
      field[grid.cells() + i * grid.n2 + j] = -field[j * grid.n2 + i];
    }
  }
  return field;
}

/// A traction with the displacement that it causes.
struct Reference {
  ArrayXd traction;
  ArrayXd displacement;

  double error(LinearOperator& op) const {
    return (apply(op, traction) - displacement).abs().maxCoeff() / displacement.abs().maxCoeff();
  }
};

/// A full field, by convolution on the whole grid.
Reference by_convolution(const Form& form, Index cells) {
  const Grid grid = grid_of(form, cells);
  const auto convolution = make({}, whole(cells));
  ArrayXd traction = random_field(2 * grid.cells());
  if (!form.quarter) return {traction, apply(*convolution, traction)};
  if (form.options.diagonal) traction = with_diagonal_mirror(traction, grid);
  const ArrayXd unfolded = solver::unfold(grid, traction, solver::torsion_symmetry());
  return {traction, solver::restrict_to_quadrant(whole(cells), apply(*convolution, unfolded))};
}

/// Tractions on the corners and a few cells more, summed up from the influence coefficients: the sums of a
/// full field would take longer than the benchmark.
Reference by_summation(Index cells) {
  constexpr std::array kComponents{solver::Component::k11, solver::Component::k12, solver::Component::k22};
  constexpr int kFurther = 6;
  const auto tables = law()->influence_tables(kComponents, {cells, cells, 1.0, 1.0});
  std::mt19937_64 generator(2);
  std::uniform_int_distribution<Index> place(0, cells - 1);
  std::vector<std::array<Index, 2>> loaded{{0, 0}, {0, cells - 1}, {cells - 1, 0}, {cells - 1, cells - 1}};
  for (int i = 0; i < kFurther; ++i) loaded.push_back({place(generator), place(generator)});

  const Index count = cells * cells;
  Reference sums{ArrayXd::Zero(2 * count), ArrayXd::Zero(2 * count)};
  for (const auto& [k, l] : loaded) {
    const double q1 = std::cos(static_cast<double>(k + 3 * l));
    const double q2 = std::sin(static_cast<double>(2 * k - l) + 1.0);
    sums.traction[k * cells + l] += q1;
    sums.traction[count + k * cells + l] += q2;
    for (Index i = 0; i < cells; ++i) {
      for (Index j = 0; j < cells; ++j) {
        const auto offset = static_cast<std::size_t>(std::abs(i - k) * cells + std::abs(j - l));
        const double k12 = (i < k) == (j < l) ? tables[1][offset] : -tables[1][offset];
        sums.displacement[i * cells + j] += tables[0][offset] * q1 + k12 * q2;
        sums.displacement[count + i * cells + j] += k12 * q1 + tables[2][offset] * q2;
      }
    }
  }
  return sums;
}

/// Sums: four components, a multiplication and an addition for each pair of cells. Transforms: by convention
/// a real one of P values takes 2.5 P log2 P, here on the padded field.
double operations(OperatorKind kind, Index cells) {
  const double pairs = std::pow(static_cast<double>(cells), 4);
  if (kind != OperatorKind::dcfft) return 2.0 * 4.0 * pairs;
  const double padded = std::pow(static_cast<double>(solver::fast_length(2 * cells - 1)), 2);
  return 4.0 * 2.5 * padded * std::log2(padded);
}

Prepared application(const Form& form, Index cells) {
  const auto op = make(form, grid_of(form, cells));
  const bool by_sums = form.kind == OperatorKind::dcfft && !form.quarter;
  const double error = (by_sums ? by_summation(cells) : by_convolution(form, cells)).error(*op);
  const auto in = std::make_shared<ArrayXd>(random_field(2 * op->grid().cells()));
  const auto out = std::make_shared<ArrayXd>(in->size());
  const auto work = [op, in, out] {
    op->apply(*in, *out);
    benchmark::DoNotOptimize(out->data());
  };
  Prepared prepared;
  prepared.counters = {{"error", error}, {"bytes", bytes(form, op->grid())}};
  if (!(error <= kAllowedError)) prepared.invalid_reason = "disagrees with its reference";
  prepared.timing = repeated(work);
  if (!form.quarter) prepared.counters["GFLOP/s"] = rate(1e-9 * operations(form.kind, cells));
  if (form.kind == OperatorKind::dense) {  // reading the matrix bounds the time
    prepared.counters["bytes_per_second"] = rate(8.0 * std::pow(static_cast<double>(2 * cells * cells), 2));
  }
  return prepared;
}

/// Its result is checked where it is applied.
Prepared set_up(const Form& form, Index cells) {
  const Grid grid = grid_of(form, cells);
  return {.counters = {{"bytes", bytes(form, grid)}},
          .timing = repeated([form, grid] { benchmark::DoNotOptimize(make(form, grid)); })};
}

/// Two forward and two backward transforms of padded fields, by plain FFTW: the least time of a convolution
/// that does not exploit its padding, and the unit in which times of different machines can be compared.
Prepared bare_transforms(Index cells) {
  const auto n = static_cast<int>(fast_length(2 * cells - 1));
  const std::size_t size = static_cast<std::size_t>(n) * static_cast<std::size_t>(n);
  const auto field = std::make_shared<FftwBuffer>(size);
  const auto spectrum = std::make_shared<FftwBuffer>(size + 2 * static_cast<std::size_t>(n));
  const auto forward =
      std::make_shared<FftwPlan>(fftw_plan_dft_r2c_2d(n, n, field->data(), spectrum->complex(), FFTW_ESTIMATE));
  const auto backward =
      std::make_shared<FftwPlan>(fftw_plan_dft_c2r_2d(n, n, spectrum->complex(), field->data(), FFTW_ESTIMATE));
  std::fill_n(field->data(), size, 0.0);  // planning has written there
  return {.counters = {{"GFLOP/s", rate(1e-9 * operations(OperatorKind::dcfft, cells))}},
          .timing = repeated([=] {
            for (int i = 0; i < 2; ++i) {
              fftw_execute_dft_r2c(forward->get(), field->data(), spectrum->complex());
              fftw_execute_dft_c2r(backward->get(), spectrum->complex(), field->data());
            }
          })};
}

/// Cells along a side: 2^k, and 3 2^k where a law is fitted to times. Padded lengths are exactly twice as
/// large; the steps of dcfft's time, where lengths are rounded up, lie between.
std::vector<Index> doubling(Index smallest, Index largest) {
  std::vector<Index> sizes;
  for (Index size = smallest; size <= largest; size *= 2) sizes.push_back(size);
  return sizes;
}

std::vector<Index> fine_sizes(Index largest) {
  std::vector<Index> sizes = doubling(4, largest);
  std::ranges::copy(doubling(6, largest), std::back_inserter(sizes));
  std::ranges::sort(sizes);
  return sizes;
}

}  // namespace

void add_operator_benchmarks(Suite& suite) {
  const std::vector<Index> all = fine_sizes(1024);
  const std::vector<Index> direct = fine_sizes(128);  // a third of a second
  const std::vector<Index> dense = fine_sizes(64);    // half a gigabyte
  const OperatorOptions two_threads{.threads = 2};
  const Form quarter{.quarter = true};
  const auto add = [&](const std::string& family, Prepared (*prepare)(const Form&, Index), const Form& form,
                       const std::vector<Index>& sizes) {
    suite.add_sizes(family, sizes, [prepare, form](Index cells) { return prepare(form, cells); });
  };

  add("application/dense", application, {.kind = OperatorKind::dense}, dense);
  add("application/direct", application, {.kind = OperatorKind::direct}, direct);
  add("application/direct_2_threads", application, {.kind = OperatorKind::direct, .options = two_threads},
      doubling(4, 128));
  add("application/dcfft", application, {}, all);
  add("application/dcfft_2_threads", application, {.options = two_threads}, doubling(4, 1024));
  add("application/dcfft_quarter", application, quarter, doubling(16, 1024));
  add("application/dcfft_quarter_with_diagonal", application, {.options = {.diagonal = true}, .quarter = true},
      doubling(16, 1024));

  add("setup/dense", set_up, {.kind = OperatorKind::dense}, dense);
  add("setup/direct", set_up, {.kind = OperatorKind::direct}, direct);
  add("setup/dcfft", set_up, {}, all);
  add("setup/dcfft_quarter", set_up, quarter, doubling(16, 1024));
  suite.add_sizes("four_bare_transforms", all, bare_transforms);
}

}  // namespace slipstick::bench
