#include "solver/elasticity/mirrored_convolution.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <utility>

#include "solver/grid/threads.hpp"

namespace slipstick::solver {
namespace {

Index groups(Index lines, Index group) { return (lines + group - 1) / group; }

/// Lines of h + 1 coefficients, from one to the next and from one coefficient to the next.
struct KernelLines {
  Index count;
  Index distance;
  Index step;
};

/// Cosine transforms over half a period, 0..h, of lines that are even about both ends; sine transforms of odd
/// ones. In place. Two lines are the real and the imaginary part of a complex one over the whole period,
/// and FFTW plans that far sooner than a cosine transform.
void transform_lines(double* values, const KernelLines& lines, Index h, bool odd, int threads) {
  std::vector<FftwBuffer> periods, transforms;
  for (int thread = 0; thread < threads; ++thread) {
    periods.emplace_back(count(4 * h));
    transforms.emplace_back(count(4 * h));
  }
  const FftwPlan plan(
      plan_transform(static_cast<int>(2 * h), periods[0].complex(), transforms[0].complex(), FFTW_FORWARD));
  const double sign = odd ? -1.0 : 1.0;
  const Index ends = odd ? 1 : 0;  // where odd lines are taken to be zero, as their transforms are
  const auto transform_pair = [&](int thread, Index line) {
    FftwBuffer& period = periods[static_cast<std::size_t>(thread)];
    FftwBuffer& transformed = transforms[static_cast<std::size_t>(thread)];
    double* const first = values + line * lines.distance;
    double* const second = line + 1 < lines.count ? first + lines.distance : first;
    double* const z = period.data();
    std::fill_n(z, 4 * h, 0.0);
    for (Index k = ends; k <= h - ends; ++k) {
      const std::array pair{first[k * lines.step], second[k * lines.step]};
      for (const Index i : {0, 1}) {
        z[2 * ((2 * h - k) % (2 * h)) + i] = sign * pair[count(i)];
        z[2 * k + i] = pair[count(i)];
      }
    }
    fftw_execute_dft(plan.get(), period.complex(), transformed.complex());
    const double* const sums = transformed.data();
    for (Index k = 0; k <= h; ++k) {
      second[k * lines.step] = odd ? sums[2 * k] : sums[2 * k + 1];
      first[k * lines.step] = odd ? -sums[2 * k + 1] : sums[2 * k];
    }
  };
  in_parts(threads, groups(lines.count, 2), [&](int thread, Index begin, Index end) {
    for (Index pair = begin; pair < end; ++pair) transform_pair(thread, 2 * pair);
  });
}

/// The transform of a kernel that is even (odd) along both coordinates. In place.
void transform_kernel(std::vector<double>& values, Index h1, Index h2, bool odd, int threads) {
  transform_lines(values.data(), {h1 + 1, h2 + 1, 1}, h2, odd, threads);
  transform_lines(values.data(), {h2 + 1, 1, h2 + 1}, h1, odd, threads);
}

/// The exchanged coordinates of the last group's columns reach up to a group further.
std::size_t transformed_reals(Index frequencies) {
  constexpr Index lines = HalfSampleTransform::kLines;
  return count((groups(frequencies, lines) * frequencies + lines) * lines);
}

}  // namespace

MirroredConvolution::MirroredConvolution(const Grid& quadrant, BlockKernel kernel, const ElasticLaw& law,
                                         const OperatorOptions& options)
    : LinearOperator(quadrant, std::move(kernel)),
      diagonal_(part_of(quadrant, this->kernel(), options.diagonal) == Part::diagonal),
      threads_(std::max(options.threads, 1)),
      along1_(quadrant.n1),
      along2_(quadrant.n2),
      column_groups_(groups(along2_.frequencies(), kLines)),
      own_row_groups_(own_row_groups(quadrant)),
      own_column_groups_(quadrant.ranks.own_share(column_groups_)),
      shared_(shared_matrix(quadrant, column_groups_)),
      half_transformed_(count(fields() * shared_.size())) {
  if (diagonal_ && quadrant.ranks.several())
    throw std::invalid_argument("several ranks do not exchange rows and columns");
  if (diagonal_) transformed_ = FftwBuffer(transformed_reals(along1_.frequencies()));
  std::vector<Component> components = this->kernel().distinct();
  if (diagonal_) components.pop_back();  // K22 is the mirror image of K11
  const Grid offsets{along1_.frequencies() + 1, along2_.frequencies() + 1, quadrant.h1, quadrant.h2};
  auto tables = law.influence_tables(components, offsets, threads_);
  for (std::size_t c = 0; c < components.size(); ++c) {
    spectra_.push_back(kernel_spectrum(components[c], std::move(tables[c])));
  }
  for (int thread = 0; thread < threads_; ++thread) {
    row_workspaces_.emplace_back(along2_);
    for (Index field = 0; field < fields(); ++field) column_workspaces_.emplace_back(along1_);
  }
}

/// 1/(p1 p2) included, which undoes the transforms' scale.
FftwBuffer MirroredConvolution::kernel_spectrum(Component component, std::vector<double> values) const {
  const Index h1 = along1_.frequencies();
  const Index h2 = along2_.frequencies();
  const bool odd = component == Component::k12;
  transform_kernel(values, h1, h2, odd, threads_);
  const double scale = 1.0 / (4.0 * static_cast<double>(h1) * static_cast<double>(h2));
  // Where the field is odd, its row 0 is that of frequency h. K12's transform is zero at 0 and at h.
  const Index row0 = component == Component::k22 ? h1 : 0;
  const Index column0 = component == Component::k11 ? h2 : 0;
  const Index first = own_column_groups_.first * kLines;
  const Index last = std::min(own_column_groups_.last * kLines, h2);
  FftwBuffer spectrum(count(own_column_groups_.count() * kLines * h1));
  const Index start = odd ? 1 : 0;
  in_parts(threads_, h1 - start, [&](int, Index begin, Index end) {
    for (Index k1 = start + begin; k1 < start + end; ++k1) {
      for (Index k2 = std::max(first, start); k2 < last; ++k2) {
        const Index from = (k1 == 0 ? row0 : k1) * (h2 + 1) + (k2 == 0 ? column0 : k2);
        spectrum.data()[((k2 - first) / kLines * h1 + k1) * kLines + k2 % kLines] = (scale * values[count(from)]);
      }
    }
  });
  return spectrum;
}

RankTranspose MirroredConvolution::shared_matrix(const Grid& quadrant, Index column_groups) {
  static_assert(kRowsOfBand % kLines == 0);
  return {quadrant.ranks, groups(quadrant.n1, kLines), rows_of_rank(quadrant.n1, quadrant.ranks) / kLines,
          column_groups, kLines * kLines};
}

IndexRange MirroredConvolution::own_row_groups(const Grid& quadrant) {
  const IndexRange own = own_rows(quadrant);
  return {groups(own.first, kLines), groups(own.last, kLines)};
}

Parity MirroredConvolution::parity_of(Index field) const {
  if (inputs() == 1) return {1, 1};
  return field == 0 ? Parity{1, -1} : Parity{-1, 1};
}

double MirroredConvolution::sent_bytes(const Grid& quadrant, const BlockKernel& kernel) {
  const Index column_groups = groups(Transform::frequencies(quadrant.n2), kLines);
  return static_cast<double>(kernel.inputs + kernel.outputs) * shared_matrix(quadrant, column_groups).sent_bytes();
}

void MirroredConvolution::do_apply(std::span<const double> traction, std::span<double> displacement) {
  const auto in_groups = [this](Index total, const auto& work) {
    in_parts(threads_, total, [&work](int thread, Index first, Index last) {
      for (Index group = first; group < last; ++group) work(thread, group);
    });
  };
  const auto in_row_groups = [&](const auto& work) {
    const Index own = own_row_groups_.count();
    in_groups(fields() * own,
              [&](int thread, Index group) { work(thread, group / own, own_row_groups_.first + group % own); });
  };
  in_row_groups([&](int thread, Index field, Index group) {
    rows_forward(thread, field, group, traction.data() + field * grid().cells());
  });
  for (Index field = 0; field < fields(); ++field) shared_.to_columns(of_field(field));
  if (diagonal_) {
    in_groups(column_groups_, [&](int thread, Index group) { columns_forward_diagonal(thread, group); });
    in_groups(column_groups_, [&](int thread, Index group) { columns_backward_diagonal(thread, group); });
  } else {
    in_groups(own_column_groups_.count(), [&](int thread, Index group) { convolve_columns(thread, group); });
  }
  for (Index field = 0; field < fields(); ++field) shared_.to_rows(of_field(field));
  in_row_groups([&](int thread, Index field, Index group) {
    rows_backward(thread, field, group, displacement.data() + field * grid().cells());
    const Index n = grid().n1;
    if (diagonal_) mirror_rows(displacement.data(), n, {group * kLines, std::min((group + 1) * kLines, n)});
  });
}

void MirroredConvolution::rows_forward(int thread, Index field, Index group, const double* values) {
  const Index n2 = grid().n2;
  const Index rows = std::min(kLines, grid().n1 - group * kLines);
  const double* const first = values + group * kLines * n2;
  double* const block = half_transformed(field, group);
  if (std::all_of(first, first + rows * n2, [](double value) { return value == 0; })) {
    std::fill_n(block, shared_.row_step(), 0.0);
    return;
  }
  along2_.forward(row_workspaces_[count(thread)], {.data = first, .line_stride = n2, .count = rows},
                  parity_of(field).x2, [block](Index k2) { return block + k2 * kLines; });
}

void MirroredConvolution::rows_backward(int thread, Index field, Index group, double* values) {
  const Index n2 = grid().n2;
  const Index rows = std::min(kLines, grid().n1 - group * kLines);
  const double* const block = half_transformed(field, group);
  along2_.backward(row_workspaces_[count(thread)],
                   {.data = values + group * kLines * n2, .line_stride = n2, .count = rows}, parity_of(field).x2,
                   [block](Index k2) { return Transform::packets(block + k2 * kLines); });
}

void MirroredConvolution::convolve_columns(int thread, Index group) {
  for (Index field = 0; field < fields(); ++field) {
    Workspace& work = column_workspace(thread, field);
    along1_.forward(work, columns<const double>(field, group), parity_of(field).x1,
                    [&work](Index k1) { return work.row(k1); });
  }
  multiply(thread, group);
  for (Index field = 0; field < fields(); ++field) {
    Workspace& work = column_workspace(thread, field);
    along1_.backward(work, columns<double>(field, group), parity_of(field).x1,
                     [&work](Index k1) { return Transform::packets(work.row(k1)); });
  }
}

/// The spectra of odd fields and of odd kernels lack a factor of -i for each coordinate in which they are
/// odd: K12's product with either field lacks (-i)^2.
void MirroredConvolution::multiply(int thread, Index group) {
  using P = Packet;
  const Index h1 = along1_.frequencies();
  const auto spectrum = [&](std::size_t component, Index k1) {
    return spectra_[component].data() + (group * h1 + k1) * kLines;
  };
  for (Index k1 = 0; k1 < h1; ++k1) {
    double* const first = column_workspace(thread, 0).row(k1);
    const double* const k11 = spectrum(0, k1);
    if (fields() == 1) {
      for (Index c = 0; c < kLines; c += P::kSize) P::store(first + c, P::load(k11 + c) * P::load(first + c));
      continue;
    }
    double* const second = column_workspace(thread, 1).row(k1);
    const double* const k12 = spectrum(1, k1);
    const double* const k22 = spectrum(2, k1);
    for (Index c = 0; c < kLines; c += P::kSize) {
      const auto q1 = P::load(first + c);
      const auto q2 = P::load(second + c);
      P::store(first + c, P::load(k11 + c) * q1 - P::load(k12 + c) * q2);
      P::store(second + c, P::load(k22 + c) * q2 - P::load(k12 + c) * q1);
    }
  }
}

void MirroredConvolution::columns_forward_diagonal(int thread, Index group) {
  double* const block = transformed_.data() + group * along1_.frequencies() * kLines;
  along1_.forward(column_workspace(thread, 0), columns<const double>(0, group), parity_of(0).x1,
                  [block](Index k1) { return block + k1 * kLines; });
}

/// The spectrum of q2 is that of -q1 with its coordinates exchanged: k12's sign is the other one than above.
void MirroredConvolution::columns_backward_diagonal(int thread, Index group) {
  const Index h = along1_.frequencies();
  const double* const k11 = spectra_[0].data() + group * h * kLines;
  const double* const k12 = spectra_[1].data() + group * h * kLines;
  const double* const plain = transformed_.data() + group * h * kLines;
  const double* const exchanged = transformed_.data() + group * kLines * kLines;
  const auto product = [=](Index k1) {
    return [=, at = k1 * kLines, column = exchanged + k1 / kLines * h * kLines + k1 % kLines](Index line) {
      using P = Packet;
      return P::load(k11 + at + line) * P::load(plain + at + line) +
             P::load(k12 + at + line) * P::gather(column + line * kLines, kLines);
    };
  };
  along1_.backward(column_workspace(thread, 0), columns<double>(0, group), parity_of(0).x1, product);
}

}  // namespace slipstick::solver
