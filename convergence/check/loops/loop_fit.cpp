#include "convergence/check/loops/loop_fit.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

namespace slipstick::convergence {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

Eigen::Map<const Eigen::VectorXd> as_vector(const std::vector<double>& values) {
  return {values.data(), static_cast<Eigen::Index>(values.size())};
}

/// 0 for the 2 % of rows that are farthest off, such as rows at a jump; 1 for the others.
Eigen::ArrayXd rows_that_count(const Eigen::VectorXd& error) {
  std::vector<double> sizes(static_cast<std::size_t>(error.size()));
  Eigen::Map<Eigen::ArrayXd>(sizes.data(), error.size()) = error.array().abs();
  const auto last = static_cast<std::ptrdiff_t>((sizes.size() - 1) * 98 / 100);
  std::ranges::nth_element(sizes, sizes.begin() + last);
  return (error.array().abs() <= sizes[static_cast<std::size_t>(last)]).cast<double>();
}

/// All combinations of parameters that differ from the given ones by a few steps of a factor.
std::vector<LoopParameters> around(const LoopParameters& middle) {
  std::vector<LoopParameters> points{{}};
  for (const double value : middle) {
    std::vector<LoopParameters> longer;
    for (const LoopParameters& point : points) {
      for (int step = -3; step <= 3; ++step) {
        longer.push_back(point);
        longer.back().push_back(value * std::exp(0.4 * step));
      }
    }
    points = longer;
  }
  return points;
}

class Fitter {
 public:
  Fitter(const LoopPath& path, double law_error, const LoopFamily& family)
      : path_(path),
        family_(family),
        range_(range_of(path.twist)),
        moment_range_(range_of(path.moment)),
        floor_(law_error * moment_range_) {}

  LoopHypothesis at(const LoopPath& path, const LoopStart& start, const LoopParameters& parameters) const {
    LoopHypothesis found;
    found.start = start;
    found.parameters = parameters;
    found.moment = family_.moment(path, start, parameters);
    const Eigen::VectorXd own = as_vector(path_.moment);
    Eigen::Map<Eigen::VectorXd> moment(found.moment.data(), own.size());
    Eigen::MatrixX2d columns = Eigen::MatrixX2d::Ones(own.size(), 2);
    if (!start_is_free_ && begins_at_zero(path_)) columns.col(0).setZero();  // rest has no offset
    columns.col(1).setZero();
    if (!family_.beside.empty()) columns.col(1) = as_vector(family_.beside);
    Eigen::ArrayXd counts = Eigen::ArrayXd::Ones(own.size());
    Eigen::Vector2d share = Eigen::Vector2d::Zero();
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::MatrixX2d counted = counts.matrix().asDiagonal() * columns;
      share = (counted.transpose() * columns).ldlt().solve(counted.transpose() * (own - moment));
      counts = rows_that_count(own - moment - columns * share);
    }
    found.offset = share[0];
    found.part = share[1];
    moment += columns * share;
    const Eigen::VectorXd error = moment - own;
    const double rms = trimmed_mean({error.begin(), error.end()});
    constexpr double kLargestPart = 0.8;  // proportion that is added to a law: a larger one hides the law
    constexpr double kPrice = 12.0;       // chi squared that a parameter has to gain
    const auto count = static_cast<double>(parameters.size()) + (family_.beside.empty() ? 0.0 : 1.0) +
                       (start_is_free_ ? 2.0 : 0.0);
    found.residual = rms / (own.array() - found.offset).abs().maxCoeff();
    found.cost = static_cast<double>(own.size()) * std::log(rms * rms + floor_ * floor_) + kPrice * count;
    if (!std::isfinite(found.cost) || found.part < 0.0 || found.part > kLargestPart) found.cost = kInfinity;
    return found;
  }

  LoopHypothesis from(const LoopStart& start, bool start_is_free) {
    start_is_free_ = start_is_free;
    LoopHypothesis best;
    best.cost = kInfinity;
    best.residual = std::numeric_limits<double>::quiet_NaN();
    best.moment.assign(path_.moment.size(), std::numeric_limits<double>::quiet_NaN());
    for (const LoopParameters& parameters : around(family_.middle)) {
      const LoopHypothesis tried = at(path_, start, parameters);
      if (tried.cost < best.cost) best = tried;
    }
    return best.cost < kInfinity ? polish(best) : best;
  }

 private:
  struct Equations {
    Eigen::MatrixXd square;
    Eigen::VectorXd right;
  };

  /// The law after a change of its unknowns: logarithms of parameters; over the range of rotations, the
  /// start's two numbers and the rotations at the reversals.
  LoopHypothesis moved(const LoopHypothesis& from, const Eigen::VectorXd& x) const {
    LoopPath path = path_;
    LoopStart start = from.start;
    LoopParameters parameters = from.parameters;
    Eigen::Index k = 0;
    for (double& value : parameters) value *= std::exp(std::clamp(x[k++], -12.0, 12.0));
    if (start_is_free_) {
      start.shift += range_ * x[k++];
      const double turned = start.turned + range_ * x[k++];
      start.turned = from.start.turned > 0.0 ? std::abs(turned) : 0.0;
    }
    for (std::size_t turn = 1; k < x.size(); ++turn) path.turn_twist[turn] += range_ * x[k++];
    return at(path, start, parameters);
  }

  /// Normal equations of a step from x. The unknowns from `turns` on are measured, with noise.
  Equations equations(const LoopHypothesis& from, const Eigen::VectorXd& x, Eigen::Index turns,
                      const LoopHypothesis& there) const {
    constexpr double kDifference = 1e-6;
    const Eigen::VectorXd error = as_vector(there.moment) - as_vector(path_.moment);
    const Eigen::ArrayXd counts = rows_that_count(error);
    Eigen::MatrixXd slopes(error.size(), x.size());
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      Eigen::VectorXd other = x;
      other[k] += kDifference;
      const LoopHypothesis beyond = moved(from, other);
      slopes.col(k) = counts * (as_vector(beyond.moment) - as_vector(there.moment)).array() / kDifference;
    }
    Equations found{slopes.transpose() * slopes, slopes.transpose() * error};
    const double stiff = std::pow(there.residual * 0.5 * moment_range_ * range_ / path_.twist_noise, 2);
    for (Eigen::Index k = turns; k < x.size(); ++k) {
      found.square(k, k) += stiff;
      found.right[k] += stiff * x[k];
    }
    return found;
  }

  /// Levenberg's and Marquardt's method.
  LoopHypothesis polish(const LoopHypothesis& from) const {
    constexpr std::size_t kMaxTurns = 24;
    constexpr int kMaxSteps = 30;
    constexpr double kMaxDamping = 1e6;
    const bool turns_are_free = path_.twist_noise > 1e-4 * range_ && path_.turns.size() <= kMaxTurns;
    const Eigen::Index fixed = static_cast<Eigen::Index>(from.parameters.size()) + (start_is_free_ ? 2 : 0);
    const Eigen::Index turns =
        turns_are_free ? static_cast<Eigen::Index>(path_.turns.size()) - 2 : Eigen::Index{0};
    Eigen::VectorXd x = Eigen::VectorXd::Zero(fixed + turns);
    LoopHypothesis best = from;
    double damping = 1e-3;
    for (int step = 0; x.size() > 0 && step < kMaxSteps && damping < kMaxDamping; ++step) {
      const Equations here = equations(from, x, fixed, best);
      bool better = false;
      for (; damping < kMaxDamping && !better; damping *= better ? 0.1 : 10.0) {
        Eigen::MatrixXd damped = here.square;
        damped.diagonal() += damping * here.square.diagonal() + Eigen::VectorXd::Constant(x.size(), 1e-300);
        const Eigen::VectorXd next = x - damped.ldlt().solve(here.right);
        if (!next.allFinite()) continue;
        const LoopHypothesis tried = moved(from, next);
        better = tried.cost < best.cost;
        if (!better) continue;
        const bool settled = best.cost - tried.cost < 1e-3;
        best = tried;
        x = next;
        if (settled) return best;
      }
    }
    return best;
  }

  const LoopPath& path_;
  const LoopFamily& family_;
  double range_;
  double moment_range_;
  double floor_;
  bool start_is_free_ = false;
};

}  // namespace

bool begins_at_zero(const LoopPath& path) {
  constexpr double kAtZero = 0.05;  // of the range
  return std::abs(path.twist[0]) <= kAtZero * range_of(path.twist) &&
         std::abs(path.moment[0]) <= kAtZero * range_of(path.moment);
}

std::vector<LoopStart> possible_starts(const LoopPath& path) {
  std::vector<LoopStart> starts{{}};
  if (begins_at_zero(path) && path.turns.size() < 3) return starts;
  const double first = path.twist[0];
  const double range = range_of(path.twist);
  const auto [low, high] = std::ranges::minmax_element(path.twist);
  const double sign = path.turn_twist[1] >= path.turn_twist[0] ? 1.0 : -1.0;
  starts.push_back({-first, 0.0});
  starts.push_back({-0.5 * (*low + *high), 0.5 * range});
  // Elsewhere on first loading; at a reversal; on the way back from one.
  for (const double part : {0.25, 0.5, 1.0, 2.0}) {
    starts.push_back({sign * part * range - first, 0.0});
    starts.push_back({-sign * part * range - first, part * range});
    starts.push_back({-first, part * range});
  }
  return starts;
}

LoopHypothesis fit_family(const LoopPath& path, double law_error, const std::vector<LoopStart>& starts,
                          const LoopFamily& family) {
  constexpr std::size_t kMaxStarts = 3;  // that are tried with every combination of parameters
  Fitter fitter(path, law_error, family);
  LoopHypothesis best = fitter.from(starts[0], false);
  const std::size_t count = family.middle.empty() ? starts.size() : std::min(starts.size(), kMaxStarts);
  for (std::size_t k = 1; k < count; ++k) {
    const LoopHypothesis found = fitter.from(starts[k], true);
    if (found.cost < best.cost) best = found;
  }
  best.name = family.name;
  if (!family.beside.empty()) best.parameters.insert(best.parameters.begin(), best.part);
  if (best.cost < kInfinity) best.sentence = family.sentence(best.parameters);
  return best;
}

}  // namespace slipstick::convergence
