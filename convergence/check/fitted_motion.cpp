#include "convergence/check/fitted_motion.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "solver/contact/certificate.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// |s| is smoothed to sqrt(|s|^2 + e^2), e being first the root mean square of s and falling tenfold each
/// time that Newton's method has settled, down to what tells no slip of any file's digits apart.
constexpr double kLeastSmoothing = 1e-9;
constexpr double kReduction = 0.1;
/// Newton's decrement, over the sum of mu p |s|, at which the smoothing that is left weighs more.
constexpr double kSettled = 1e-3;
constexpr int kMostSteps = 200;
constexpr int kMostHalvings = 30;

/// Cells without a bound are zero in all fields.
struct Program {
  ArrayXd displacement, traction, bound;
  std::vector<ArrayXd> motions;

  ArrayXd slip(const VectorXd& z) const {
    ArrayXd s = displacement;
    for (Index k = 0; k < z.size(); ++k) s -= z[k] * motions[static_cast<std::size_t>(k)];
    return s;
  }

  double smoothed_gap(const ArrayXd& s, double smoothing) const {
    return (traction * s).sum() + (bound * (solver::dot_products(s, s) + smoothing * smoothing).sqrt()).sum();
  }

  /// Gradient and second derivatives in z.
  struct Derivatives {
    VectorXd gradient;
    MatrixXd hessian;
  };
  Derivatives derivatives(const ArrayXd& s, double smoothing) const {
    const auto n = static_cast<Index>(motions.size());
    const ArrayXd size = (solver::dot_products(s, s) + smoothing * smoothing).sqrt();
    const ArrayXd weight = bound / size;
    Derivatives d{VectorXd(n), MatrixXd(n, n)};
    const ArrayXd pull = traction + weight.replicate(2, 1) * s;
    std::vector<ArrayXd> along;
    for (const ArrayXd& motion : motions) along.push_back(solver::dot_products(s, motion) / size);
    for (Index k = 0; k < n; ++k) {
      const auto at_k = static_cast<std::size_t>(k);
      d.gradient[k] = -(pull * motions[at_k]).sum();
      for (Index l = 0; l <= k; ++l) {
        const auto at_l = static_cast<std::size_t>(l);
        d.hessian(k, l) = d.hessian(l, k) =
            (weight * (solver::dot_products(motions[at_k], motions[at_l]) - along[at_k] * along[at_l])).sum();
      }
    }
    return d;
  }
};

/// Least squares of s weighted with the bound.
VectorXd least_slip(const Program& program) {
  const auto n = static_cast<Index>(program.motions.size());
  MatrixXd matrix(n, n);
  VectorXd right(n);
  for (Index k = 0; k < n; ++k) {
    const ArrayXd weighted = program.bound.replicate(2, 1) * program.motions[static_cast<std::size_t>(k)];
    right[k] = (weighted * program.displacement).sum();
    for (Index l = 0; l < n; ++l)
      matrix(k, l) = (weighted * program.motions[static_cast<std::size_t>(l)]).sum();
  }
  return matrix.ldlt().solve(right);
}

VectorXd least_gap(const Program& program) {
  VectorXd z = least_slip(program);
  ArrayXd s = program.slip(z);
  const double scale = std::sqrt((program.bound * solver::dot_products(s, s)).sum() / program.bound.sum());
  double smoothing = scale;
  for (int step = 0; step < kMostSteps && smoothing > kLeastSmoothing * scale; ++step) {
    const auto [gradient, hessian] = program.derivatives(s, smoothing);
    const VectorXd newton = -hessian.ldlt().solve(gradient);
    const double decrement = -gradient.dot(newton);
    const double value = program.smoothed_gap(s, smoothing);
    bool lower = false;
    for (int halvings = 0; halvings < kMostHalvings && !lower; ++halvings) {
      const VectorXd next = z + std::ldexp(1.0, -halvings) * newton;
      const ArrayXd next_slip = program.slip(next);
      lower = program.smoothed_gap(next_slip, smoothing) < value;
      if (!lower) continue;
      z = next;
      s = next_slip;
    }
    if (!lower || !(decrement > kSettled * smoothing * program.bound.sum())) smoothing *= kReduction;
  }
  return z;
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
  fitted.gap =
      solver::dot_products(program.traction, fitted.slip) + friction_bound * solver::norms(fitted.slip);
  return fitted;
}

}  // namespace slipstick::convergence
