#include "convergence/orders/limit.hpp"

#include <fmt/core.h>
#include <gsl/gsl_cdf.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "solver/newton/coefficients.hpp"
#include "solver/scene/bracketed_root.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Meshes = std::vector<MeshSample>;

// Orders that the least-squares method extrapolates with, and up to which it trusts them (Eca and Hoekstra).
constexpr double kMinOrder = 0.5;
constexpr double kMaxOrder = 2.0;
constexpr double kTrustedOrder = 2.1;
constexpr double kTrusted = 1.25;  // Roache's safety factors
constexpr double kCautious = 3.0;

double safety_factor(double order) { return order >= kMinOrder && order <= kTrustedOrder ? kTrusted : kCautious; }

double range(const Meshes& meshes) {
  const auto [low, high] = std::ranges::minmax(meshes, {}, &MeshSample::value);
  return high.value - low.value;
}

/// Richardson's order and limit of three values.
struct Extrapolation {
  double order;
  double left;  ///< distance of the finest value from the limit, signed
};

/// The order p of values = limit + C size^p with the given ratio (coarse - middle)/(middle - fine), which grows with p.
Extrapolation extrapolation(const MeshSample& coarse, const MeshSample& middle, const MeshSample& fine) {
  const double ratio = (coarse.value - middle.value) / (middle.value - fine.value);
  const double coarser = std::log(coarse.size / middle.size);
  const double finer = std::log(middle.size / fine.size);
  if (!(ratio > 0.0) || std::isinf(ratio)) return {kNaN, kNaN};
  const double at_zero = coarser / finer;  // there the ratio is a limit
  const auto excess = [&](double order) {
    const double at = order == 0.0 ? at_zero : std::expm1(order * coarser) / -std::expm1(-order * finer);
    return std::log(at / ratio);
  };
  constexpr double kMaxOrder = 100.0;
  const double order = ratio == at_zero              ? 0.0
                       : !(excess(kMaxOrder) > 0.0)  ? kMaxOrder
                       : !(excess(-kMaxOrder) < 0.0) ? -kMaxOrder
                                                     : solver::bracketed_root(excess, -kMaxOrder, kMaxOrder);
  return {order, (middle.value - fine.value) / std::expm1(order * finer)};
}

/// Empty, unless the order of the finest three meshes is lower than the order of the three before.
std::string fall_of_order(const Meshes& meshes) {
  if (meshes.size() <= kMinMeshes) return "";
  const auto finest = meshes.end() - kMinMeshes;
  const double now = extrapolation(finest[0], finest[1], finest[2]).order;
  const double before = extrapolation(finest[-1], finest[0], finest[1]).order;
  if (!(before > now + kOrderMargin)) return "";
  return fmt::format("the order still falls, from {:.2f} to {:.2f} on the finest meshes", before, now);
}

/// The verdict by the values; if they do not decide it, by the interval of the order.
Order judged(Order order, const Meshes& meshes, double expected, const std::string& left_out) {
  order = judged_by_interval(order, expected);
  const MeshSample& finest = meshes.back();
  const MeshSample& before = meshes[meshes.size() - 2];
  const double noise = resolution(finest) + resolution(before);
  if (is_non_monotone(meshes)) {
    order.verdict = OrderVerdict::oscillatory;
    order.why = "the values turn back from mesh to mesh";
  } else if (!(std::abs(finest.value - before.value) > noise)) {
    order.verdict = OrderVerdict::floor;
    order.why = fmt::format("the values of the two finest meshes differ by {:.2g}, which noise and scatter hide",
                            std::abs(finest.value - before.value));
  } else if (std::isnan(order.value)) {
    order.why = "the changes from mesh to mesh do not shrink like a power of the size";
  } else if (const std::string falls = fall_of_order(meshes);
             order.verdict == OrderVerdict::superconvergent && !falls.empty()) {
    order.verdict = OrderVerdict::preasymptotic;
    order.why = falls;
  }
  if (!left_out.empty()) order.why += "; " + left_out;
  return order;
}

/// value = coefficients[0] + sum of coefficients[k] (size/coarsest size)^powers[k - 1].
struct PowerFit {
  std::vector<double> powers;
  bool weighted;
  VectorXd coefficients;
  double deviation;  ///< standard deviation of the residuals
};

ArrayXd column(const Meshes& meshes, double MeshSample::*member) {
  ArrayXd values(static_cast<Eigen::Index>(meshes.size()));
  for (Eigen::Index i = 0; i < values.size(); ++i) values[i] = meshes[static_cast<std::size_t>(i)].*member;
  return values;
}

/// Mean 1.
ArrayXd fit_weights(const ArrayXd& sizes, bool weighted) {
  if (!weighted) return ArrayXd::Ones(sizes.size());
  return sizes.inverse() / sizes.inverse().mean();
}

/// fitted: powers that were found from the same values, which cost a degree of freedom each.
PowerFit power_fit(const Meshes& meshes, const std::vector<double>& powers, bool weighted, int fitted = 0) {
  const ArrayXd sizes = column(meshes, &MeshSample::size) / meshes.front().size;
  const ArrayXd values = column(meshes, &MeshSample::value) - meshes.back().value;
  const ArrayXd roots = fit_weights(sizes, weighted).sqrt();
  MatrixXd terms(sizes.size(), static_cast<Eigen::Index>(powers.size()) + 1);
  terms.col(0) = roots;
  for (std::size_t k = 0; k < powers.size(); ++k) {
    terms.col(static_cast<Eigen::Index>(k) + 1) = sizes.pow(powers[k]) * roots;
  }
  VectorXd coefficients = solver::least_squares(terms, (values * roots).matrix());
  const double squares = (terms * coefficients - (values * roots).matrix()).squaredNorm();
  coefficients[0] += meshes.back().value;
  const auto left = static_cast<double>(terms.rows() - terms.cols() - fitted);
  return {powers, weighted, coefficients, std::sqrt(squares / left)};
}

/// The power of least deviation, by successive refinement of its logarithm; none at an end of the range.
std::optional<PowerFit> fit_with_order(const Meshes& meshes, bool weighted) {
  constexpr double least = 0.02;  // a power this small looks like a logarithm
  constexpr double most = 100.0;
  constexpr int steps = 20;
  constexpr double close = 1e-13;
  double low = std::log(least);
  double high = std::log(most);
  double at = high;
  PowerFit best = power_fit(meshes, {most}, weighted, 1);
  while (high - low > close) {
    const double step = (high - low) / steps;
    for (int i = 0; i <= steps; ++i) {
      const PowerFit fit = power_fit(meshes, {std::exp(low + step * i)}, weighted, 1);
      if (!(fit.deviation < best.deviation)) continue;
      best = fit;
      at = low + step * i;
    }
    low = std::max(low, at - step);
    high = std::min(high, at + step);
  }
  const double distance = std::min(at - std::log(least), std::log(most) - at);
  return distance > close ? std::optional(best) : std::nullopt;
}

PowerFit better(const PowerFit& one, const PowerFit& other) { return other.deviation < one.deviation ? other : one; }

PowerFit best_of(const Meshes& meshes, const std::vector<std::vector<double>>& candidates) {
  PowerFit best = power_fit(meshes, candidates.front(), false);
  for (const auto& powers : candidates) {
    for (const bool weighted : {false, true}) best = better(best, power_fit(meshes, powers, weighted));
  }
  return best;
}

/// The order of the smaller deviation, weighted or not; none where neither fit has one.
std::optional<PowerFit> best_with_order(const Meshes& meshes) {
  const auto alike = fit_with_order(meshes, false);
  const auto weighted = fit_with_order(meshes, true);
  if (alike && weighted) return better(*alike, *weighted);
  return alike ? alike : weighted;
}

/// Half the 95 % interval of a fitted order, the fit taken as linear about it.
double half_interval(const PowerFit& fit, const Meshes& meshes) {
  const ArrayXd sizes = column(meshes, &MeshSample::size) / meshes.front().size;
  const ArrayXd roots = fit_weights(sizes, fit.weighted).sqrt();
  const ArrayXd power = sizes.pow(fit.powers[0]);
  MatrixXd slopes(sizes.size(), 3);
  slopes << roots, power * roots, fit.coefficients[1] * power * sizes.log() * roots;
  const double left = static_cast<double>(sizes.size()) - 3.0;
  return gsl_cdf_tdist_Pinv(kBothSides, left) * fit.deviation * solver::pseudo_inverse(slopes).row(2).norm();
}

Order order_of(const std::optional<PowerFit>& fit, const Meshes& meshes) {
  if (!fit) return {kNaN, kNaN, kNaN, kNaN, OrderVerdict::preasymptotic, ""};
  const double order = fit->powers[0];
  const double half = half_interval(*fit, meshes);
  const double constant = fit->coefficients[1] * std::pow(meshes.front().size, -order);
  return {order, order - half, order + half, constant, OrderVerdict::asymptotic, "", sizes_of(meshes)};
}

/// The fit that the method extrapolates with.
PowerFit chosen_fit(const std::optional<PowerFit>& with_order, const Meshes& meshes) {
  if (with_order && with_order->powers[0] > kMaxOrder) return best_of(meshes, {{1.0}, {2.0}});
  if (with_order && with_order->powers[0] >= kMinOrder) return *with_order;
  return best_of(meshes, {{1.0}, {2.0}, {1.0, 2.0}});
}

std::string terms_text(std::span<const double> powers) {
  std::string terms;
  for (const double power : powers) terms += fmt::format("{}h^{:.3g}", terms.empty() ? "" : " and ", power);
  return terms;
}

std::string method_of(const PowerFit& fit, bool with_order) {
  return fmt::format("least squares with {}{}{}", terms_text(fit.powers), with_order ? ", fitted" : ", given",
                     fit.weighted ? ", weighted by 1/h" : "");
}

/// The weights of `powers.size() + 1` meshes whose weighted sum has no error in these powers.
VectorXd extrapolation_weights(const Meshes& meshes, const std::vector<double>& powers) {
  const auto count = static_cast<Eigen::Index>(meshes.size());
  const ArrayXd sizes = column(meshes, &MeshSample::size) / meshes.back().size;
  MatrixXd terms(count, count);
  terms.row(0).setOnes();
  for (Eigen::Index k = 1; k < count; ++k) {
    terms.row(k) = sizes.pow(powers[static_cast<std::size_t>(k) - 1]).matrix().transpose();
  }
  return solver::least_squares(terms, VectorXd::Unit(count, 0));
}

/// A limit by the first `count` powers, from the `count` + 1 meshes that end before `end`.
struct Extrapolated {
  double value;
  double doubt;  ///< noise and scatter of the meshes
};

Extrapolated extrapolated(const Meshes& all, std::size_t end, const std::vector<double>& powers, std::size_t count) {
  const auto last = all.begin() + static_cast<std::ptrdiff_t>(end);
  const Meshes meshes(last - static_cast<std::ptrdiff_t>(count + 1), last);
  const VectorXd weights = extrapolation_weights(meshes, powers);
  Extrapolated sum{0.0, 0.0};
  for (std::size_t i = 0; i < meshes.size(); ++i) {
    const double weight = weights[static_cast<Eigen::Index>(i)];
    sum.value += weight * meshes[i].value;
    sum.doubt += std::abs(weight) * uncertainty(meshes[i]);
  }
  return sum;
}

/// Uncertainty of the finest mesh by the method's rules.
double grid_uncertainty(const PowerFit& fit, double order, const Meshes& meshes) {
  const double finest = meshes.back().size / meshes.front().size;
  double fitted = 0.0;
  for (std::size_t k = 0; k < fit.powers.size(); ++k) {
    fitted += fit.coefficients[static_cast<Eigen::Index>(k) + 1] * std::pow(finest, fit.powers[k]);
  }
  const double residual = std::abs(meshes.back().value - fit.coefficients[0] - fitted);
  const double mean_change = range(meshes) / static_cast<double>(meshes.size() - 1);
  if (fit.deviation < mean_change) {
    return safety_factor(order) * std::abs(fitted) + fit.deviation + residual;
  }
  if (mean_change == 0.0) return 0.0;
  return kCautious * fit.deviation / mean_change * (std::abs(fitted) + fit.deviation + residual);
}

/// An extrapolation from three meshes, with the uncertainties of order and limit by the uncertainty of each value.
struct Propagated {
  Extrapolation found;
  double order_uncertainty;
  double limit_uncertainty;
};

Propagated propagated(const Meshes& three) {
  const auto found = extrapolation(three[0], three[1], three[2]);
  double order_squares = 0.0;
  double limit_squares = 0.0;
  for (std::size_t i = 0; i < three.size(); ++i) {
    Meshes moved = three;
    moved[i].value += uncertainty(three[i]);
    const Extrapolation other = extrapolation(moved[0], moved[1], moved[2]);
    order_squares += std::pow(other.order - found.order, 2);
    limit_squares += std::pow(moved[2].value - other.left - (three[2].value - found.left), 2);
  }
  return {found, std::sqrt(order_squares), std::sqrt(limit_squares)};
}

/// Too few values for an order.
Limit limit_of_few(const MeshSequence& found, std::size_t asked, double expected) {
  const Meshes& meshes = found.meshes;
  const Order order = order_of_few(found, asked);
  if (meshes.empty()) return {kNaN, kNaN, order, "none"};
  const MeshSample& finest = meshes.back();
  if (meshes.size() == 1) return {finest.value, kNaN, order, "finest mesh"};
  const double left = range(meshes) / std::expm1(expected * std::log(meshes[0].size / finest.size));
  return {finest.value, kCautious * left + uncertainty(finest), order, "finest mesh"};
}

}  // namespace

Limit least_squares_limit(const std::vector<MeshSample>& values, double expected) {
  const auto [meshes, left_out] = coarsest_first(values);
  if (meshes.size() <= kMinMeshes) return richardson_limit(values, expected);
  const auto with_order = best_with_order(meshes);
  const PowerFit fit = chosen_fit(with_order, meshes);
  const bool fitted = with_order && fit.powers == with_order->powers;
  Order order = judged(order_of(with_order, meshes), meshes, expected, left_out);
  if (!fitted) order.constant = kNaN;
  return {fit.coefficients[0], grid_uncertainty(fit, order.value, meshes) + uncertainty(meshes.back()), order,
          method_of(fit, fitted)};
}

Limit richardson_limit(const std::vector<MeshSample>& values, double expected) {
  constexpr double most_order = 3.0;  // piecewise constant fields give 2, with luck somewhat more
  const MeshSequence sequence = coarsest_first(values);
  const auto& [meshes, left_out] = sequence;
  if (meshes.size() < kMinMeshes) return limit_of_few(sequence, values.size(), expected);
  const Meshes three(meshes.end() - kMinMeshes, meshes.end());
  const auto [found, order_doubt, limit_doubt] = propagated(three);
  const double constant = found.left / std::pow(three.back().size, found.order);
  const Order fitted{found.order,    found.order - order_doubt, found.order + order_doubt,
                     constant,       OrderVerdict::asymptotic,  "",
                     sizes_of(three)};
  Order order = judged(fitted, meshes, expected, left_out);
  const double finest = three.back().value;
  if (!(found.order >= kMinOrder && found.order <= most_order)) {
    order.constant = kNaN;
    return {finest, kCautious * range(three) + uncertainty(three.back()), order, "finest mesh"};
  }
  return {finest - found.left, safety_factor(found.order) * std::abs(found.left) + limit_doubt, order,
          fmt::format("Richardson with h^{:.3g}", found.order)};
}

Limit expansion_limit(const std::vector<MeshSample>& values, const std::vector<double>& powers, double expected) {
  constexpr double kAgreement = 2.0;  // the uncertainty over the distance of successive extrapolations
  const auto [meshes, left_out] = coarsest_first(values);
  const std::size_t all = meshes.size();
  if (all < kMinMeshes) return least_squares_limit(values, expected);
  const std::size_t count = std::min(powers.size(), all - 2);
  const auto [limit, doubt] = extrapolated(meshes, all, powers, count);
  const double without_finest = extrapolated(meshes, all - 1, powers, count).value;
  const double with_one_less = extrapolated(meshes, all, powers, count - 1).value;
  const double change = std::max(std::abs(limit - without_finest), std::abs(limit - with_one_less));
  std::vector<MeshSample> errors = values;
  for (MeshSample& error : errors) error.value -= limit;
  return {limit, kAgreement * change + doubt, fit_order(errors, expected),
          "extrapolation with " + terms_text(std::span(powers).first(count))};
}

}  // namespace slipstick::convergence
