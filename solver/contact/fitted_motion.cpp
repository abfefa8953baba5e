#include "solver/contact/fitted_motion.hpp"

#include "solver/contact/certificate.hpp"
#include "solver/contact/smoothed_friction.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

/// From the root mean square of s down to a slip below the digits of any file.
constexpr Smoothing kSlipSmoothing{.first = 1.0, .least = 1e-9};

/// A contact whose fields are zero in cells without a bound.
struct Program {
  ArrayXd displacement, traction, bound;
  std::vector<ArrayXd> motions;

  Index count() const { return static_cast<Index>(motions.size()); }
  const ArrayXd& motion(Index k) const { return motions[static_cast<std::size_t>(k)]; }

  ArrayXd slip(const Coefficients& z) const {
    ArrayXd s = displacement;
    for (Index k = 0; k < z.size(); ++k) s -= z[k] * motion(k);
    return s;
  }
};

/// The sum of s.q + mu p |s|, |s| smoothed, and its derivatives in z.
struct SmoothedGap {
  Coefficients z;
  double smoothed = 0.0;
  Coefficients gradient = {};
  CoefficientMatrix hessian = {};
};

SmoothedGap evaluate(const Program& program, const Coefficients& z, double smoothing) {
  const Index n = program.count();
  const ArrayXd s = program.slip(z);
  const ArrayXd size = (dot_products(s, s) + smoothing * smoothing).sqrt();
  const ArrayXd weight = program.bound / size;
  const ArrayXd pull = program.traction + weight.replicate(2, 1) * s;
  SmoothedGap gap{z, (program.traction * s).sum() + (program.bound * size).sum(), Coefficients(n),
                  CoefficientMatrix(n, n)};
  for (Index k = 0; k < n; ++k) {
    const ArrayXd along = dot_products(s, program.motion(k)) / size;
    gap.gradient[k] = -(pull * program.motion(k)).sum();
    for (Index l = 0; l <= k; ++l) {
      gap.hessian(k, l) = gap.hessian(l, k) = (weight * (dot_products(program.motion(k), program.motion(l)) -
                                                         along * dot_products(s, program.motion(l)) / size))
                                                  .sum();
    }
  }
  return gap;
}

/// Least squares of s weighted with the bound.
Coefficients least_slip(const Program& program) {
  const Index n = program.count();
  CoefficientMatrix matrix(n, n);
  Coefficients right(n);
  for (Index k = 0; k < n; ++k) {
    const ArrayXd weighted = program.bound.replicate(2, 1) * program.motion(k);
    right[k] = (weighted * program.displacement).sum();
    for (Index l = 0; l < n; ++l) matrix(k, l) = (weighted * program.motion(l)).sum();
  }
  return SmallCholesky(matrix).solve(right);
}

/// Newton's method on bounds over their sum, and displacements over the root mean square of s at the start.
Coefficients least_gap(Program program) {
  const double total = program.bound.sum();
  program.bound /= total;
  program.traction /= total;
  const Coefficients start = least_slip(program);
  const ArrayXd s = program.slip(start);
  const double scale = std::sqrt((program.bound * dot_products(s, s)).sum());
  if (!(scale > 0.0)) return start;
  program.displacement /= scale;
  const auto move = [&](const SmoothedGap& from, const Coefficients& step, double smoothing) {
    return evaluate(program, from.z + step, smoothing);
  };
  const auto is_least = [](const SmoothedGap&, double) { return false; };
  const Coefficients scaled = start / scale;
  return scale *
         minimise_smoothed(SmoothedGap{.z = scaled, .gradient = scaled}, kSlipSmoothing, move, is_least).z;
}

}  // namespace

FittedMotion fit_motion(const ArrayXd& displacement, const ArrayXd& traction, const ArrayXd& friction_bound,
                        const std::vector<ArrayXd>& motions) {
  const ArrayXd contact = (friction_bound > 0.0).cast<double>();
  const auto within = [&](const ArrayXd& field) { return ArrayXd(contact.replicate(2, 1) * field); };
  Program program{within(displacement), within(traction), friction_bound, {}};
  for (const ArrayXd& motion : motions) program.motions.push_back(within(motion));
  FittedMotion fitted;
  if (!motions.empty()) fitted.coefficients = least_gap(program);
  fitted.slip = program.slip(fitted.coefficients);
  fitted.gap = dot_products(program.traction, fitted.slip) + friction_bound * norms(fitted.slip);
  return fitted;
}

}  // namespace slipstick::solver
