#include "solver/convolution.hpp"

#include <algorithm>
#include <array>
#include <new>
#include <set>

#include "solver/threads.hpp"

namespace slipstick::solver {
namespace {

/// Columns transformed together: 8 complex numbers are two cache lines.
constexpr Index kBlock = 8;
constexpr Index kBlockReals = 2 * kBlock;

Index row_stride(Index p2) { return (p2 / 2 + 1 + kBlock - 1) / kBlock * kBlock; }

std::size_t count(Index n) { return static_cast<std::size_t>(n); }

void require_plan(const FftwPlan& plan) {
  if (!plan) throw std::runtime_error("FFTW could not make a plan");
}

}  // namespace

FftwBuffer::FftwBuffer(std::size_t doubles) : data_(fftw_alloc_real(doubles)), doubles_(doubles) {
  if (!data_) throw std::bad_alloc();
  std::fill_n(data_.get(), doubles, 0.0);
}

Index fast_length(Index minimum) {
  for (Index length = std::max<Index>(minimum + minimum % 2, 4);; length += 2) {
    Index rest = length;
    for (const Index factor : {2, 3, 5, 7}) {
      while (rest % factor == 0) rest /= factor;
    }
    if (rest == 1) return length;
  }
}

Convolution::Convolution(const Grid& grid, BlockKernel kernel, const ElasticPair& pair,
                         const OperatorOptions& options)
    : LinearOperator(grid, std::move(kernel)),
      p1_(fast_length(2 * grid.n1 - 1)),
      p2_(fast_length(2 * grid.n2 - 1)),
      row_stride_(row_stride(p2_)),
      threads_(std::max(options.threads, 1)),
      row_spectra_(2 * count(grid.n1 * row_stride_) * std::max(inputs(), outputs())) {
  for (int thread = 0; thread < threads_; ++thread) {
    row_buffer_.emplace_back(count(p2_));
    column_block_.emplace_back(count(p1_ * kBlockReals) * std::max(inputs(), outputs()));
  }
  make_plans(options.measure_plans ? FFTW_MEASURE : FFTW_ESTIMATE);
  for (const Component component : this->kernel().components) {
    if (!spectra_.contains(component)) spectra_.emplace(component, kernel_spectrum(component, pair));
  }
}

void Convolution::make_plans(unsigned flags) {
  const int p1 = static_cast<int>(p1_);
  const int p2 = static_cast<int>(p2_);
  constexpr int block = static_cast<int>(kBlock);
  double* const row = row_buffer_.front().data();
  fftw_complex* const spectrum = row_spectra_.complex();
  fftw_complex* const columns = column_block_.front().complex();
  row_forward_.reset(fftw_plan_dft_r2c_1d(p2, row, spectrum, flags));
  row_backward_.reset(fftw_plan_dft_c2r_1d(p2, spectrum, row, flags));
  const auto plan_columns = [&](int direction) {
    return FftwPlan(fftw_plan_many_dft(1, &p1, block, columns, nullptr, block, 1, columns, nullptr, block, 1,
                                       direction, flags));
  };
  column_forward_ = plan_columns(FFTW_FORWARD);
  column_backward_ = plan_columns(FFTW_BACKWARD);
  require_plan(row_forward_);
  require_plan(row_backward_);
  require_plan(column_forward_);
  require_plan(column_backward_);
}

/// The transform of a kernel that is even (odd) along a coordinate is a cosine (-i times a sine) transform
/// over half a period. The factors of -i are left out here and applied in multiply_columns.
FftwBuffer Convolution::kernel_spectrum(Component component, const ElasticPair& pair) const {
  const Index m1 = p1_ / 2 + 1;
  const Index m2 = p2_ / 2 + 1;
  FftwBuffer buffer(count(m1 * row_stride_));
  const std::vector<double> coefficients =
      influence_coefficients(component, pair, grid().h1, grid().h2, m1, m2);
  const double scale = 1.0 / (static_cast<double>(p1_) * static_cast<double>(p2_));
  for (Index k1 = 0; k1 < m1; ++k1) {
    for (Index k2 = 0; k2 < m2; ++k2) {
      buffer.data()[k1 * row_stride_ + k2] = scale * coefficients[count(k1 * m2 + k2)];
    }
  }
  const Parity sign = parity(component);
  const Index first1 = sign.x1 < 0 ? 1 : 0;  // a sine transform leaves out both ends, where the field is zero
  const Index first2 = sign.x2 < 0 ? 1 : 0;
  const std::array<fftw_iodim, 1> along1{
      {{static_cast<int>(m1 - 2 * first1), static_cast<int>(row_stride_), static_cast<int>(row_stride_)}}};
  const std::array<fftw_iodim, 1> along2{{{static_cast<int>(m2 - 2 * first2), 1, 1}}};
  const std::array<fftw_r2r_kind, 1> kind1{sign.x1 < 0 ? FFTW_RODFT00 : FFTW_REDFT00};
  const std::array<fftw_r2r_kind, 1> kind2{sign.x2 < 0 ? FFTW_RODFT00 : FFTW_REDFT00};
  double* const start = buffer.data() + first1 * row_stride_ + first2;
  for (const bool columns : {true, false}) {
    const FftwPlan plan(columns ? fftw_plan_guru_r2r(1, along1.data(), 1, along2.data(), start, start,
                                                     kind1.data(), FFTW_ESTIMATE)
                                : fftw_plan_guru_r2r(1, along2.data(), 1, along1.data(), start, start,
                                                     kind2.data(), FFTW_ESTIMATE));
    require_plan(plan);
    fftw_execute(plan.get());
  }
  const auto clear = [&](Index k1, Index k2) { buffer.data()[k1 * row_stride_ + k2] = 0.0; };
  for (Index k2 = 0; first1 != 0 && k2 < m2; ++k2) clear(0, k2), clear(m1 - 1, k2);
  for (Index k1 = 0; first2 != 0 && k1 < m1; ++k1) clear(k1, 0), clear(k1, m2 - 1);
  return buffer;
}

double Convolution::predicted_bytes(const Grid& grid, const BlockKernel& kernel, int threads) {
  const Index p1 = fast_length(2 * grid.n1 - 1);
  const Index p2 = fast_length(2 * grid.n2 - 1);
  const auto fields = static_cast<Index>(std::max(kernel.inputs, kernel.outputs));
  const std::set<Component> distinct(kernel.components.begin(), kernel.components.end());
  const Index spectra = static_cast<Index>(distinct.size()) * (p1 / 2 + 1) * row_stride(p2);
  const Index workspace = 2 * fields * grid.n1 * row_stride(p2);
  const Index per_thread = p2 + fields * p1 * kBlockReals;
  return 8.0 * static_cast<double>(spectra + workspace + std::max(threads, 1) * per_thread);
}

std::size_t Convolution::bytes() const {
  std::size_t sum = row_spectra_.bytes();
  for (const auto& [component, spectrum] : spectra_) sum += spectrum.bytes();
  for (const FftwBuffer& buffer : row_buffer_) sum += buffer.bytes();
  for (const FftwBuffer& buffer : column_block_) sum += buffer.bytes();
  return sum;
}

void Convolution::do_apply(std::span<const double> traction, std::span<double> displacement) {
  // The rows of all fields lie one after the other.
  const auto in_rows = static_cast<Index>(inputs()) * grid().n1;
  const auto out_rows = static_cast<Index>(outputs()) * grid().n1;
  in_parts(threads_, in_rows, [&](int thread, Index first, Index last) {
    for (Index row = first; row < last; ++row) row_forward(thread, row, traction.data() + row * grid().n2);
  });
  in_parts(threads_, row_stride_ / kBlock, [&](int thread, Index first, Index last) {
    for (Index block = first; block < last; ++block) convolve_columns(thread, block * kBlock);
  });
  in_parts(threads_, out_rows, [&](int thread, Index first, Index last) {
    for (Index row = first; row < last; ++row)
      row_backward(thread, row, displacement.data() + row * grid().n2);
  });
}

void Convolution::row_forward(int thread, Index row, const double* values) {
  const Index n2 = grid().n2;
  if (std::all_of(values, values + n2, [](double value) { return value == 0.0; })) {
    std::fill_n(row_spectra_.data() + 2 * row * row_stride_, 2 * row_stride_, 0.0);
    return;
  }
  double* const padded = row_buffer_[count(thread)].data();
  std::copy_n(values, n2, padded);
  std::fill(padded + n2, padded + p2_, 0.0);
  fftw_execute_dft_r2c(row_forward_.get(), padded, row_spectra_.complex() + row * row_stride_);
}

void Convolution::row_backward(int thread, Index row, double* values) {
  double* const padded = row_buffer_[count(thread)].data();
  fftw_execute_dft_c2r(row_backward_.get(), row_spectra_.complex() + row * row_stride_, padded);
  std::copy_n(padded, grid().n2, values);
}

void Convolution::convolve_columns(int thread, Index first_column) {
  const Index n1 = grid().n1;
  double* const block = column_block_[count(thread)].data();
  const auto field_of_block = [&](std::size_t field) {
    return block + static_cast<Index>(field) * p1_ * kBlockReals;
  };
  const auto row_of_spectrum = [&](std::size_t field, Index row) {
    return row_spectra_.data() + 2 * ((static_cast<Index>(field) * n1 + row) * row_stride_ + first_column);
  };
  for (std::size_t field = 0; field < inputs(); ++field) {
    double* const columns = field_of_block(field);
    for (Index i = 0; i < n1; ++i) {
      std::copy_n(row_of_spectrum(field, i), kBlockReals, columns + i * kBlockReals);
    }
    std::fill(columns + n1 * kBlockReals, columns + p1_ * kBlockReals, 0.0);
    auto* const complex = reinterpret_cast<fftw_complex*>(columns);
    fftw_execute_dft(column_forward_.get(), complex, complex);
  }
  multiply_columns(block, first_column);
  for (std::size_t field = 0; field < outputs(); ++field) {
    double* const columns = field_of_block(field);
    auto* const complex = reinterpret_cast<fftw_complex*>(columns);
    fftw_execute_dft(column_backward_.get(), complex, complex);
    for (Index i = 0; i < n1; ++i) {
      std::copy_n(columns + i * kBlockReals, kBlockReals, row_of_spectrum(field, i));
    }
  }
}

/// outputs = kernel spectrum * inputs, in place, for one block of columns.
void Convolution::multiply_columns(double* block, Index first_column) const {
  struct Factor {
    const double* spectrum;
    int sign_x1;     ///< sign of the spectrum at negative frequencies along x1
    bool imaginary;  ///< odd in one coordinate only: times -i
    double sign;     ///< odd in both coordinates: (-i)^2
  };
  std::array<Factor, 4> factors{};
  for (std::size_t c = 0; c < kernel().components.size(); ++c) {
    const Parity sign = parity(kernel().components[c]);
    factors[c] = {spectra_.at(kernel().components[c]).data() + first_column, sign.x1, sign.x1 != sign.x2,
                  sign.x1 < 0 && sign.x2 < 0 ? -1.0 : 1.0};
  }
  std::array<std::array<double, kBlockReals>, 2> in;
  for (Index k1 = 0; k1 < p1_; ++k1) {
    const bool negative = k1 > p1_ / 2;
    const Index row = negative ? p1_ - k1 : k1;
    const auto values = [&](std::size_t field) {
      return block + (static_cast<Index>(field) * p1_ + k1) * kBlockReals;
    };
    for (std::size_t b = 0; b < inputs(); ++b) std::copy_n(values(b), kBlockReals, in[b].data());
    for (std::size_t a = 0; a < outputs(); ++a) {
      std::array<double, kBlockReals> sum{};
      for (std::size_t b = 0; b < inputs(); ++b) {
        const Factor& factor = factors[a * inputs() + b];
        const double* const spectrum = factor.spectrum + row * row_stride_;
        const double sign = negative ? factor.sign * factor.sign_x1 : factor.sign;
        for (std::size_t c = 0; c < count(kBlock); ++c) {
          const double value = sign * spectrum[c];
          if (factor.imaginary) {  // (-i)(x + i y) = y - i x
            sum[2 * c] += value * in[b][2 * c + 1];
            sum[2 * c + 1] -= value * in[b][2 * c];
          } else {
            sum[2 * c] += value * in[b][2 * c];
            sum[2 * c + 1] += value * in[b][2 * c + 1];
          }
        }
      }
      std::copy_n(sum.data(), kBlockReals, values(a));
    }
  }
}

}  // namespace slipstick::solver
