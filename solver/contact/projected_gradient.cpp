#include "solver/contact/projected_gradient.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <stdexcept>

#include "solver/contact/certificate.hpp"
#include "solver/newton/admissible.hpp"
#include "solver/newton/load_balance.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

constexpr int kCheckEvery = 10;
/// The run ends after this many iterations without a gap below kFallen times the least one: rounding hides
/// further progress. Contacts 512 cells across need 170 iterations for eight digits.
constexpr int kIdleIterations = 500;
constexpr double kFallen = 0.9;
constexpr int kPowerIterations = 6;
constexpr double kStepMargin = 1.05;
/// Below this part of a displacement, the difference of two is rounding.
constexpr double kNoise = 1e-13;

class ProjectedGradient {
 public:
  ProjectedGradient(LinearOperator& op, const TangentialProblem& problem,
                    const ProjectedGradientOptions& options)
      : op_(op),
        problem_(problem),
        options_(options),
        t_(rotation_field(op.grid())),
        load_(problem.initial_displacement.size() > 0 ? problem.initial_displacement
                                                      : ArrayXd::Zero(t_.size())),
        contact_((problem.friction_bound > 0.0).cast<double>().replicate(2, 1)),
        q_(options.start.size() > 0 ? options.start : ArrayXd::Zero(t_.size())),
        Kq_(ArrayXd::Zero(t_.size())),
        rotation_(op.grid(), 0.0, 0.0, 1.0),
        discs_(op.grid(), problem.friction_bound),
        balance_(discs_, imposed(problem, rotation_)),
        phi_(problem.twist.value_or(0.0)) {
    if (q_.size() != t_.size()) throw std::invalid_argument("start: tractions of another size");
  }

  TangentialSolution run() {
    const bool unloaded = problem_.moment.value_or(problem_.twist.value_or(0.0)) == 0.0 &&
                          problem_.initial_displacement.size() == 0;
    if (unloaded || !contact_.any()) {
      q_.setZero();
      return finish(Status::converged, "");
    }
    bound_largest_eigenvalue();
    if (!std::isfinite(L_) || L_ == 0.0) return failure("no step length: norm of K", L_);
    limit_momentum();
    project(q_);
    op_.apply(q_, Kq_);
    y_ = q_;
    Ky_ = Kq_;
    for (iteration_ = 1; iteration_ <= options_.max_iterations; ++iteration_) {
      descend();
      extrapolate();
      if (iteration_ % kCheckEvery != 0 && iteration_ != options_.max_iterations) continue;
      evaluate_gap();
      if (!std::isfinite(gap_)) return failure("not finite: gap", gap_);
      if (energy_ < 0.0) return failure("indefinite operator: q.Kq/2", energy_);
      if (options_.progress) options_.progress(iteration_, gap_);
      if (gap_ <= options_.tolerance) return finish(Status::converged, "");
      if (!(gap_ > kFallen * least_gap_)) {
        least_gap_ = gap_;
        progressed_ = iteration_;
      } else if (iteration_ - progressed_ >= kIdleIterations) {
        return finish(
            Status::not_converged,
            fmt::format("no further progress: gap {:.3g} after {} iterations, {:.3g} after {}, asked "
                        "for {:.3g}",
                        least_gap_, progressed_, gap_, iteration_, options_.tolerance));
      }
    }
    iteration_ = options_.max_iterations;
    return finish(Status::not_converged,
                  fmt::format("too many iterations: gap {:.3g} after {}, tolerance {:.3g}", gap_, iteration_,
                              options_.tolerance));
  }

 private:
  /// The largest eigenvalue belongs to a smooth field, a translation nearly, far above the others, so that a
  /// few power iterations from there (and from the rotation, which is orthogonal to it by symmetry) come
  /// within the margin from below: fewer applications than the rows' sums, which bound it on square contacts
  /// only up to a third. descend() measures the curvature that it meets and corrects a bound that is too low.
  void bound_largest_eigenvalue() {
    ArrayXd v = contact_ * (1.0 + t_ / t_.abs().maxCoeff());
    ArrayXd Kv(v.size());
    for (int i = 0; i < kPowerIterations; ++i) {
      v /= v.matrix().norm();
      op_.apply(v, Kv);
      v = contact_ * Kv;
      L_ = kStepMargin * v.matrix().norm();
      if (!std::isfinite(L_) || L_ == 0.0) return;
    }
  }

  /// On an energy whose curvatures lie between l and L, momentum pays up to (1 - e)/(1 + e), e = sqrt(l/L);
  /// Nesterov's grows to 1, which on fine meshes costs five times the iterations, restarts or none. Kernels
  /// that smooth are softest on the shortest waves: l is taken from a rotation in a checkerboard of signs,
  /// which has the mirrors that the operator may assume. It need not be a bound, for the method converges
  /// with any momentum up to Nesterov's.
  void limit_momentum() {
    const Grid& grid = op_.grid();
    ArrayXd v = contact_ * t_;
    for (Index i = 0; i < v.size(); ++i) {
      const Index cell = i % grid.cells();
      if ((cell / grid.n2 + cell % grid.n2) % 2 != 0) v[i] = -v[i];
    }
    ArrayXd Kv(v.size());
    op_.apply(v, Kv);
    const double ratio = (v * Kv).sum() / (L_ * v.square().sum());
    if (!(ratio > 0.0)) return;  // for the certificate to see
    const double e = std::sqrt(std::min(ratio, 1.0));
    most_momentum_ = (1.0 - e) / (1.0 + e);
  }

  static std::vector<Condition> imposed(const TangentialProblem& problem, const MotionField& rotation) {
    if (!problem.moment) return {};
    return {{&rotation, *problem.moment}};
  }

  /// Onto the admissible tractions. The moment's multiplier is the twist, but for the length of the step;
  /// what no multiplier brings to the moment is not finite.
  void project(ArrayXd& q) {
    if (problem_.moment) {
      if (!balance_.solve(q, alpha_)) alpha_[0] = std::numeric_limits<double>::quiet_NaN();
      balance_.add(alpha_, q);
      phi_ = L_ * alpha_[0];
    }
    discs_.project(q);
  }

  /// A projected step of length 1/L down the gradient at y; shorter if the energy curves more than L along
  /// it.
  void descend() {
    std::swap(q_, q_old_);
    std::swap(Kq_, Kq_old_);
    for (;;) {
      q_ = y_ - (Ky_ + load_ - (problem_.twist ? phi_ : 0.0) * t_) / L_;
      project(q_);
      Kq_.resize(q_.size());
      op_.apply(q_, Kq_);
      const double square = (q_ - y_).square().sum();
      const double curvature = ((q_ - y_) * (Kq_ - Ky_)).sum();
      const double noise = kNoise * std::sqrt(square * Ky_.square().sum());
      if (!(curvature > L_ * square + noise)) return;  // NaN is for the certificate to see
      L_ = kStepMargin * curvature / square;
    }
  }

  /// The next y, on the line through the last two iterates; q itself where the step turned back on them.
  void extrapolate() {
    const bool turned = ((y_ - q_) * (q_ - q_old_)).sum() > 0.0;
    const double theta = turned ? 1.0 : theta_;
    theta_ = 0.5 * (1.0 + std::sqrt(1.0 + 4.0 * theta * theta));
    const double beta = std::min((theta - 1.0) / theta_, most_momentum_);
    y_ = q_ + beta * (q_ - q_old_);
    Ky_ = Kq_ + beta * (Kq_ - Kq_old_);
  }

  ArrayXd slip() const { return contact_ * (Kq_ + load_ - phi_ * t_); }

  void evaluate_gap() {
    energy_ = 0.5 * (q_ * Kq_).sum();
    gap_ = certify({q_, Kq_, slip()}, problem_.friction_bound, t_, problem_.moment.value_or(0.0)).gap;
  }

  TangentialSolution failure(const char* what, double value) {
    return finish(Status::not_converged, fmt::format("{} = {} in iteration {}", what, value, iteration_));
  }

  TangentialSolution finish(Status status, const std::string& message) {
    const ArrayXd s = slip();
    const ArrayXd size = norms(L_ > 0.0 ? ArrayXd(q_ - s / L_) : q_);
    const ArrayXd& bound = problem_.friction_bound;
    return {.status = status,
            .message = message,
            .traction = q_,
            .elastic_displacement = Kq_,
            .slip = s,
            .stick = (bound > 0.0 && size <= bound).cast<double>(),
            .twist = phi_,
            .change = gap_,
            .iterations = iteration_};
  }

  LinearOperator& op_;
  const TangentialProblem& problem_;
  const ProjectedGradientOptions& options_;
  const ArrayXd t_;        // (-x2, x1)
  const ArrayXd load_;     // g
  const ArrayXd contact_;  // 1 where tractions may be, both components
  ArrayXd q_, Kq_, q_old_, Kq_old_;
  ArrayXd y_, Ky_;  // the extrapolated point, where the gradient is taken
  double L_ = 0.0;  // bounds the curvature: 1/L is the step
  double most_momentum_ = 1.0;
  const MotionField rotation_;
  const FrictionDiscs discs_;
  const LoadBalance<FrictionDiscs> balance_;
  Coefficients alpha_ = Coefficients::Zero(1);
  double phi_ = 0.0, theta_ = 1.0;
  double energy_ = 0.0, gap_ = 0.0;
  double least_gap_ = std::numeric_limits<double>::infinity();
  int iteration_ = 0;
  int progressed_ = 0;  // when the least gap was reached
};

}  // namespace

TangentialSolution solve_by_projected_gradient(LinearOperator& op, const TangentialProblem& problem,
                                               const ProjectedGradientOptions& options) {
  require_valid(problem, op.grid());
  return ProjectedGradient(op, problem, options).run();
}

}  // namespace slipstick::solver
