#include "solver/elasticity/convolution.hpp"

#include <algorithm>
#include <stdexcept>

namespace slipstick::solver {
namespace {

std::size_t fields(const BlockKernel& kernel) { return std::max(kernel.inputs, kernel.outputs); }

/// A kernel that is odd in one coordinate only has an imaginary spectrum.
bool is_imaginary(Component component) { return parity(component).x1 != parity(component).x2; }

/// How many of m frequencies 0, 1, ... differ in size from those before: the even ones of 2 m mirror about 0
/// and m, the odd ones about 1/2 and m - 1/2.
Index distinct_even(Index m) { return m / 2 + 1; }
Index distinct_odd(Index m) { return (m + 1) / 2; }

/// x_a[i] = sum over b of sign_ab factor_ab[step i] x_b[i], times the imaginary unit if the spectra are imaginary.
template <std::size_t outputs, std::size_t inputs, bool imaginary, int step>
void multiply_run(std::array<double*, 2> x, std::array<const double*, 4> factor, std::array<double, 4> sign, Index n) {
  for (Index i = 0; i < n; ++i) {
    std::array<double, outputs> re{};
    std::array<double, outputs> im{};
    for (std::size_t a = 0; a < outputs; ++a) {
      for (std::size_t b = 0; b < inputs; ++b) {
        const std::size_t ab = a * inputs + b;
        const double value = step > 0 ? factor[ab][i] : sign[ab] * factor[ab][-i];
        re[a] += value * (imaginary ? -x[b][2 * i + 1] : x[b][2 * i]);
        im[a] += value * (imaginary ? x[b][2 * i] : x[b][2 * i + 1]);
      }
    }
    for (std::size_t a = 0; a < outputs; ++a) {
      x[a][2 * i] = re[a];
      x[a][2 * i + 1] = im[a];
    }
  }
}

/// The first `distinct` frequencies of m with the factors as stored, the rest with mirrored ones, the last of
/// which is factor[last].
template <std::size_t outputs, std::size_t inputs, bool imaginary>
void multiply_half(const std::array<std::complex<double>*, 2>& half, std::array<const double*, 4> factor,
                   const std::array<double, 4>& sign, Index m, Index distinct, Index last) {
  std::array<double*, 2> x{reinterpret_cast<double*>(half[0]), reinterpret_cast<double*>(half[1])};
  multiply_run<outputs, inputs, imaginary, 1>(x, factor, sign, distinct);
  for (std::size_t field = 0; field < std::max(outputs, inputs); ++field) x[field] += 2 * distinct;
  for (std::size_t ab = 0; ab < outputs * inputs; ++ab) factor[ab] += last + m - distinct - 1;
  multiply_run<outputs, inputs, imaginary, -1>(x, factor, sign, m - distinct);
}

}  // namespace

auto Convolution::multiply_for(const BlockKernel& kernel) -> Multiply {
  const bool imaginary = std::all_of(kernel.components.begin(), kernel.components.end(), is_imaginary);
  const bool real = std::none_of(kernel.components.begin(), kernel.components.end(), is_imaginary);
  const auto shaped = []<std::size_t outputs, std::size_t inputs, bool odd>() -> Multiply {
    return [](const Spectrum& x, const Factors& factors, Index m) {
      const Index evens = distinct_even(m);
      multiply_half<outputs, inputs, odd>(x.even, factors.quadrant, factors.sign, m, evens, 1);
      auto odd_factors = factors.quadrant;
      for (std::size_t ab = 0; ab < outputs * inputs; ++ab) odd_factors[ab] += evens;
      multiply_half<outputs, inputs, odd>(x.odd, odd_factors, factors.sign, m, distinct_odd(m), 0);
    };
  };
  if (kernel.outputs == 1 && kernel.inputs == 1 && real) return shaped.template operator()<1, 1, false>();
  if (kernel.outputs == 2 && kernel.inputs == 2 && real) return shaped.template operator()<2, 2, false>();
  if (kernel.outputs == 2 && kernel.inputs == 1 && imaginary) return shaped.template operator()<2, 1, true>();
  if (kernel.outputs == 1 && kernel.inputs == 2 && imaginary) return shaped.template operator()<1, 2, true>();
  throw std::invalid_argument("no convolution with a kernel of this shape");
}

Convolution::Convolution(const Grid& grid, BlockKernel kernel, const ElasticLaw& law, const OperatorOptions& options)
    : LinearOperator(grid, std::move(kernel)),
      transform_(grid, fields(this->kernel()), std::max(options.threads, 1),
                 scratch_size(grid, this->kernel(), options)),
      components_(this->kernel().distinct()),
      spectra_(components_.size() * count(transform_.own_columns(grid).count() * (padded1() / 2 + 1))),
      multiply_(multiply_for(this->kernel())) {
  for (std::size_t c = 0; c < this->kernel().components.size(); ++c) {
    const auto found = std::find(components_.begin(), components_.end(), this->kernel().components[c]);
    slot_.at(c) = count(found - components_.begin());
  }
  set_spectra(law);
}

/// The kernel is the sum of a quadrant of offsets and its three mirror images. With Q the quadrant's
/// spectrum, found as any field's, the sum's is 2 Re or 2 i Im of Q(k1, k2) +- Q(-k1, k2).
void Convolution::set_spectra(const ElasticLaw& law) {
  const Grid& grid = this->grid();
  auto quadrants = law.influence_tables(components_, grid, transform_.threads());
  for (std::size_t slot = 0; slot < components_.size(); ++slot) {
    std::vector<double>& quadrant = quadrants[slot];
    for (Index i = 0; i < grid.n1; ++i) quadrant[count(i * grid.n2)] *= 0.5;  // on the axes, images coincide
    for (Index j = 0; j < grid.n2; ++j) quadrant[count(j)] *= 0.5;
    transform_.forward_rows(quadrant);
    transform_.through_columns(1, 0, [&](Index column, const PaddedTransform::Spectrum& spectrum) {
      set_factors(components_[slot], spectrum.even[0], spectrum.odd[0], spectra_.data() + start(column, slot));
    });
  }
}

/// From one column of Q.
void Convolution::set_factors(Component component, const std::complex<double>* even, const std::complex<double>* odd,
                              double* factors) const {
  const Index m1 = padded1() / 2;
  const double scale = 2.0 / (static_cast<double>(padded1()) * static_cast<double>(padded2()));
  const double sign = parity(component).x1;
  const bool imaginary = is_imaginary(component);
  const auto factor = [&](const std::complex<double>& at, const std::complex<double>& mirrored) {
    const std::complex<double> sum = at + sign * mirrored;
    return scale * (imaginary ? sum.imag() : sum.real());
  };
  *factors++ = factor(even[0], even[0]);
  for (Index k = 1; k < distinct_even(m1); ++k) *factors++ = factor(even[k], even[m1 - k]);
  for (Index k = 0; k < distinct_odd(m1); ++k) *factors++ = factor(odd[k], odd[m1 - 1 - k]);
}

std::size_t Convolution::start(Index column, std::size_t slot) const {
  return (count(column) * components_.size() + slot) * count(padded1() / 2 + 1);
}

auto Convolution::factors(Index column) const -> Factors {
  Factors result{};
  for (std::size_t c = 0; c < kernel().components.size(); ++c) {
    result.quadrant[c] = spectra_.data() + start(column, slot_[c]);
    result.sign[c] = parity(kernel().components[c]).x1;
  }
  return result;
}

double Convolution::sent_bytes(const Grid& grid, const BlockKernel& kernel) {
  return static_cast<double>(kernel.inputs + kernel.outputs) * PaddedTransform::sent_bytes(grid);
}

void Convolution::do_apply(std::span<const double> traction, std::span<double> displacement) {
  transform_.forward_rows(traction);
  transform_.through_columns(inputs(), outputs(), [&](Index column, const Spectrum& spectrum) {
    multiply_(spectrum, factors(column), padded1() / 2);
  });
  transform_.backward_rows(displacement);
}

}  // namespace slipstick::solver
