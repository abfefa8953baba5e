#include "solver/contact/fitted_motion.hpp"

#include <algorithm>
#include <array>

#include "solver/contact/certificate.hpp"
#include "solver/contact/smoothed_friction.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

/// Over the root mean square of s: the last one lies below the digits of any file.
constexpr Smoothing kSlipSmoothing{.first = 1.0, .least = 1e-9};

/// Part of the bounds that sticking cells have left where their motion is the one to start from.
constexpr double kSticks = 1e-3;

ArrayXd slip_of(const ArrayXd& displacement, const std::vector<ArrayXd>& motions, const Coefficients& z) {
  ArrayXd s = displacement;
  for (Index k = 0; k < z.size(); ++k) s -= z[k] * motions[static_cast<std::size_t>(k)];
  return s;
}

/// A contact whose tractions are zero in cells without a bound.
struct Program {
  ArrayXd displacement, traction, bound;
  const std::vector<ArrayXd>& motions;

  Index count() const { return static_cast<Index>(motions.size()); }
  const ArrayXd& motion(Index k) const { return motions[static_cast<std::size_t>(k)]; }
};

/// The sum of s.q + mu p |s|, |s| smoothed, and its derivatives in z; the second ones without a difference of
/// near numbers, which would leave nothing of them where all cells slip.
struct SmoothedGap {
  Coefficients z;
  double smoothed = 0.0;
  Coefficients gradient = {};
  CoefficientMatrix hessian = {};
};

SmoothedGap evaluate(const Program& program, const Coefficients& z, double smoothing) {
  constexpr Index kBlock = 256;  // in cache
  using Block = Eigen::Array<double, Eigen::Dynamic, 1, 0, kBlock, 1>;
  const Index n = program.count();
  const Index cells = program.bound.size();
  SmoothedGap gap{z, 0.0, Coefficients::Zero(n), CoefficientMatrix::Zero(n, n)};
  std::array<Block, kMaxConditions> across;
  for (Index first = 0; first < cells; first += kBlock) {
    const Index size = std::min(kBlock, cells - first);
    const auto bound = program.bound.segment(first, size);
    if (!(bound > 0.0).any()) continue;
    const auto part1 = [&](const ArrayXd& field) { return field.segment(first, size); };
    const auto part2 = [&](const ArrayXd& field) { return field.segment(cells + first, size); };
    Block s1 = part1(program.displacement);
    Block s2 = part2(program.displacement);
    for (Index k = 0; k < n; ++k) {
      s1 -= z[k] * part1(program.motion(k));
      s2 -= z[k] * part2(program.motion(k));
    }
    const Block length = (s1.square() + s2.square() + smoothing * smoothing).sqrt();
    const Block weight = bound / length;
    const Block smoothed = (smoothing / length).square();
    const Block pull1 = part1(program.traction) + weight * s1;
    const Block pull2 = part2(program.traction) + weight * s2;
    gap.smoothed += (part1(program.traction) * s1 + part2(program.traction) * s2 + bound * length).sum();
    for (Index k = 0; k < n; ++k) {
      const auto m1 = part1(program.motion(k));
      const auto m2 = part2(program.motion(k));
      gap.gradient[k] -= (pull1 * m1 + pull2 * m2).sum();
      Block& here = across[static_cast<std::size_t>(k)];
      here = (s1 * m2 - s2 * m1) / length;
      for (Index l = 0; l <= k; ++l) {
        gap.hessian(k, l) += (weight * (here * across[static_cast<std::size_t>(l)] +
                                        smoothed * (m1 * part1(program.motion(l)) + m2 * part2(program.motion(l)))))
                                 .sum();
      }
    }
  }
  gap.hessian = CoefficientMatrix(gap.hessian.selfadjointView<Eigen::Lower>());
  return gap;
}

/// Least squares of s with a weight for each cell.
Coefficients least_slip(const Program& program, const ArrayXd& weight) {
  const Index n = program.count();
  CoefficientMatrix matrix(n, n);
  Coefficients right(n);
  for (Index k = 0; k < n; ++k) {
    const ArrayXd weighted = weight.replicate(2, 1) * program.motion(k);
    right[k] = (weighted * program.displacement).sum();
    for (Index l = 0; l <= k; ++l) matrix(k, l) = matrix(l, k) = (weighted * program.motion(l)).sum();
  }
  return SmallCholesky(matrix).solve(right);
}

/// Newton's method on bounds over their sum, and displacements over the root mean square of s at the start: that of
/// least slip where cells stick, if many do. Smoothing by the gap there changes the sum by as much at most.
Coefficients least_gap(Program& program) {
  const double total = program.bound.sum();
  program.bound /= total;
  program.traction /= total;
  const ArrayXd left = (program.bound - norms(program.traction)).max(0.0);
  const Coefficients start =
      least_slip(program, left.sum() > kSticks ? ArrayXd(left + kSlipSmoothing.least * program.bound) : program.bound);
  const ArrayXd s = slip_of(program.displacement, program.motions, start);
  const double scale = std::sqrt((program.bound * dot_products(s, s)).sum());
  if (!(scale > 0.0)) return start;
  program.displacement /= scale;
  const double gap = ((program.traction * s).sum() + (program.bound * norms(s)).sum()) / scale;
  const Smoothing smoothing{std::clamp(gap, kSlipSmoothing.least, kSlipSmoothing.first), kSlipSmoothing.least};
  const auto move = [&](const SmoothedGap& from, const Coefficients& step, double by) {
    return evaluate(program, from.z + step, by);
  };
  const auto is_least = [](const SmoothedGap&, double) { return false; };
  const Coefficients scaled = start / scale;
  return scale * minimise_smoothed(SmoothedGap{.z = scaled, .gradient = scaled}, smoothing, move, is_least).z;
}

}  // namespace

FittedMotion fit_motion(const ArrayXd& displacement, const ArrayXd& traction, const ArrayXd& friction_bound,
                        const std::vector<ArrayXd>& motions) {
  const ArrayXd contact = (friction_bound > 0.0).cast<double>();
  const ArrayXd within = contact.replicate(2, 1) * traction;
  FittedMotion fitted;
  if (!motions.empty()) {
    Program program{displacement, within, friction_bound, motions};
    fitted.coefficients = least_gap(program);
  }
  fitted.slip = contact.replicate(2, 1) * slip_of(displacement, motions, fitted.coefficients);
  fitted.gap = dot_products(within, fitted.slip) + friction_bound * norms(fitted.slip);
  return fitted;
}

}  // namespace slipstick::solver
