#include "solver/newton/load_balance.hpp"

#include <algorithm>

#include "solver/newton/admissible.hpp"

namespace slipstick::solver {
namespace {

constexpr double kLoadRounding = 1e-14;
/// Where rounding allows no better.
constexpr double kPoorRounding = 1e-12;
constexpr int kBracketIterations = 200;
constexpr int kNewtonIterations = 200;
/// Parts of the majorant.
constexpr double kMinDamping = 1e-12;
constexpr double kMoreDamping = 100.0;
/// The longest step, over the size of the field.
constexpr double kMaxStride = 2.0;
/// A step is accepted if it reduces the imbalance by a twentieth, or the potential by this part of the linear
/// prediction. Near the limit load Newton steps reduce by a quarter only, and rounding hides the decrease.
constexpr double kGoodReduction = 0.95;
constexpr double kArmijo = 1e-4;

}  // namespace

template <class Set>
LoadBalance<Set>::LoadBalance(const Set& set, const std::vector<Condition>& conditions) : set_(set) {
  for (const auto& [c, load] : conditions) {
    c_.push_back(c);
    load_.conservativeResize(load_.size() + 1);
    load_[load_.size() - 1] = load;
  }
  majorant_.resize(load_.size(), load_.size());
  for (Eigen::Index k = 0; k < load_.size(); ++k) {
    for (Eigen::Index l = 0; l < load_.size(); ++l) majorant_(k, l) = product(k, field(l));
  }
}

/// The product of the k-th condition's field with values.
template <class Set>
template <typename Values>
double LoadBalance<Set>::product(Eigen::Index k, const Values& values) const {
  return set_.sweep().template sum<double>([&](Eigen::Index first, Eigen::Index last, double& sum) {
    for (Eigen::Index start = first; start < Set::kComponents * set_.cells(); start += set_.cells()) {
      sum += field(k).dot(start, values.segment(start, last - first));
    }
  });
}

template <class Set>
void LoadBalance<Set>::add(const Coefficients& x, Eigen::ArrayXd& y) const {
  set_.sweep().each([&](Eigen::Index first, Eigen::Index last) {
    for (Eigen::Index k = 0; k < load_.size(); ++k) {
      for (Eigen::Index start = first; start < y.size(); start += set_.cells()) {
        field(k).add_to(y.segment(start, last - first), start, x[k]);
      }
    }
  });
}

template <class Set>
bool LoadBalance<Set>::solve(const Eigen::ArrayXd& y, Coefficients& x) const {
  const std::span<const MotionField* const> c(c_);
  if (solve_along(y, c, x, true)) return true;
  Coefficients missing = load_;
  for (Eigen::Index k = 0; k < load_.size(); ++k) missing[k] -= product(k, y);
  x = least_solution(majorant_, missing);
  return solve_along(y, c, x, true);
}

template <class Set>
template <typename Direction>
bool LoadBalance<Set>::solve_along(const Eigen::ArrayXd& y, std::span<const Direction* const> w,
                                   Coefficients& x, bool own) const {
  if (count() == 0) return true;
  if (count() == 1) return solve_one(y, *w[0], x[0]);
  if constexpr (Set::kComponents == 2) {  // scalar fields have one condition
    return count() == 2 ? solve_several<2>(y, w, x, own) : solve_several<3>(y, w, x, own);
  }
  return false;
}

template <class Set>
template <int M, typename Direction>
LoadsAlong<M> LoadBalance<Set>::evaluate(const Eigen::ArrayXd& y, std::span<const Direction* const> w,
                                         const Eigen::Vector<double, M>& x) const {
  ++evaluations_;
  std::array<const Direction*, M> directions;
  std::array<const MotionField*, M> fields;
  for (std::size_t k = 0; k < M; ++k) {
    directions[k] = w[k];
    fields[k] = c_[k];
  }
  return set_.template loads_along<M>(y, directions, x, fields);
}

/// Newton's method in a bracket.
template <class Set>
template <typename Direction>
bool LoadBalance<Set>::solve_one(const Eigen::ArrayXd& y, const Direction& w, double& x) const {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  double stride = 0.0;
  double last = std::numeric_limits<double>::infinity();
  const Direction* const direction = &w;
  for (int i = 0; i < kBracketIterations; ++i) {
    const LoadsAlong<1> at =
        evaluate<1>(y, std::span<const Direction* const>(&direction, 1), Eigen::Vector<double, 1>(x));
    const double excess = at.load[0] - load_[0];
    if (std::abs(excess) <= kLoadRounding * known_to(at, 0)) return true;
    // Where rounding allows no better: a bracket would be halved as often as its numbers have bits.
    if (std::abs(excess) <= kPoorRounding * known_to(at, 0) && !(std::abs(excess) < kGoodReduction * last))
      return true;
    last = std::abs(excess);
    if (!std::isfinite(excess)) return false;
    (excess < 0.0 ? low : high) = x;
    const double slope = at.slope(0, 0);
    double next = x - excess / slope;
    if (slope > 0.0) stride = std::max(stride, std::abs(next - x));
    if (!(slope > 0.0) || !(next > low && next < high)) {
      const bool bracketed = std::isfinite(low) && std::isfinite(high);
      stride = stride > 0.0 ? 2.0 * stride : 1.0;
      next = bracketed ? 0.5 * (low + high) : x + (excess < 0.0 ? stride : -stride);
    }
    if (next == x || !(high - low > std::numeric_limits<double>::epsilon() * std::abs(x))) return true;
    x = next;
  }
  return false;
}

/// The scale of a load's rounding: |load|, or the cells' contributions of both signs, whose sum |c_k.P| is
/// bounded by Cauchy's inequality.
template <class Set>
template <int M>
double LoadBalance<Set>::known_to(const LoadsAlong<M>& at, int k) const {
  return std::max(std::abs(load_[k]), std::sqrt(majorant_(k, k) * at.carried));
}

/// The largest part of a load that is missing.
template <class Set>
template <int M>
double LoadBalance<Set>::imbalance(const LoadsAlong<M>& at) const {
  double worst = 0.0;
  for (int k = 0; k < M; ++k) {
    const double missing = std::abs(load_[k] - at.load[k]);
    // A single cell on the axis carries no moment, and need not.
    const double part = missing == 0.0 ? 0.0 : missing / known_to(at, k);
    worst = part <= worst ? worst : part;  // keeps NaN
  }
  return worst;
}

/// Newton's method with a line search. Far out, where the load hardly changes with x, steps overshoot: they
/// are limited to the size of the field, and a part of the majorant is added to the matrix, if necessary all
/// of it, with which a step always descends.
template <class Set>
template <int M, typename Direction>
bool LoadBalance<Set>::solve_several(const Eigen::ArrayXd& y, std::span<const Direction* const> w,
                                     Coefficients& x_out, bool own) const {
  using Vector = Eigen::Vector<double, M>;
  using Matrix = Eigen::Matrix<double, M, M>;
  const Matrix majorant = majorant_;
  const Vector load = load_;
  Vector x = x_out;
  LoadsAlong<M> at = evaluate<M>(y, w, x);
  double damping = kMinDamping;
  for (int i = 0; i < kNewtonIterations; ++i) {
    const double missing = imbalance(at);
    if (missing <= kLoadRounding) break;
    if (!std::isfinite(missing)) return false;
    const Vector r = load - at.load;
    bool accepted = false;
    for (; !accepted && damping <= 1.0; damping *= kMoreDamping) {
      Vector step = least_solution(at.slope + damping * majorant, r);
      const double stride = step.dot(majorant * step) / (kMaxStride * kMaxStride * at.square);
      if (stride > 1.0) step /= std::sqrt(stride);
      const LoadsAlong<M> next = evaluate<M>(y, w, Vector(x + step));
      const double decrease = at.potential - next.potential + load.dot(step);
      const double rounding = kLoadRounding * (std::abs(at.potential) + std::abs(next.potential));
      accepted =
          imbalance(next) < kGoodReduction * missing || (own && decrease > kArmijo * r.dot(step) + rounding);
      if (!accepted) continue;
      x += step;
      at = next;
    }
    if (!accepted) break;
    damping = std::max(damping / (kMoreDamping * kMoreDamping), kMinDamping);
  }
  x_out = x;
  if (imbalance(at) <= kPoorRounding) return true;
  // Where y is all but taken away, as when a load returns to nothing, what is left is its rounding.
  const double square =
      set_.sweep().template sum<double>([&](Eigen::Index first, Eigen::Index last, double& sum) {
        for (Eigen::Index start = first; start < y.size(); start += set_.cells())
          sum += y.segment(start, last - first).square().sum();
      });
  const double known = kLoadRounding * std::sqrt(square);
  return ((load - at.load).cwiseAbs().array() <= known * majorant.diagonal().array().sqrt()).all();
}

template class LoadBalance<FrictionDiscs>;
template class LoadBalance<PositivePressures>;
template bool LoadBalance<FrictionDiscs>::solve_along(const Eigen::ArrayXd&,
                                                      std::span<const Eigen::ArrayXf* const>, Coefficients&,
                                                      bool) const;
template bool LoadBalance<PositivePressures>::solve_along(const Eigen::ArrayXd&,
                                                          std::span<const Eigen::ArrayXf* const>,
                                                          Coefficients&, bool) const;

}  // namespace slipstick::solver
