#include "convergence/orders/order.hpp"

#include <fmt/core.h>
#include <gsl/gsl_cdf.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "solver/newton/coefficients.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Meshes = std::vector<MeshSample>;

Order no_order(OrderVerdict verdict, std::string why) { return {kNaN, kNaN, kNaN, kNaN, verdict, std::move(why), {}}; }

/// Standard errors of log |error| as the spread gives them, and the grids that they rest on beyond one a mesh.
struct Scatter {
  ArrayXd errors;  ///< empty: unknown
  double freedom = 0.0;
};

/// The spread of a few grids is uncertain, so half of the variance is the mean of all meshes, relative to the errors.
Scatter scatter(const Meshes& meshes) {
  const auto count = static_cast<Eigen::Index>(meshes.size());
  ArrayXd own(count);
  ArrayXd grids(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const MeshSample& mesh = meshes[static_cast<std::size_t>(i)];
    own[i] = std::pow(mesh.spread / mesh.value, 2);
    grids[i] = mesh.grids;
  }
  const double freedom = (grids - 1.0).sum();
  const double pooled = (own * (grids - 1.0)).sum() / freedom;
  if ((grids < 2.0).any() || !(pooled > 0.0)) return {};
  return {(0.5 * (own + pooled) / grids).sqrt(), freedom};
}

/// A polynomial of log |error| in log size, about the mean of log size.
struct LogFit {
  VectorXd coefficients;  ///< lowest power first
  VectorXd halves;        ///< of their 95 % intervals
};

/// meshes: more than degree + 1, or as many where the scatter is known.
LogFit log_fit(const Meshes& meshes, const Scatter& scatter, Eigen::Index degree) {
  const auto count = static_cast<Eigen::Index>(meshes.size());
  ArrayXd x(count);
  ArrayXd y(count);
  ArrayXd noise(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [size, value, spread, grids, left] = meshes[static_cast<std::size_t>(i)];
    x[i] = std::log(size);
    y[i] = std::log(std::abs(value));
    noise[i] = left / std::abs(value);
  }
  x -= x.mean();
  const bool known = scatter.errors.size() > 0;
  const ArrayXd weights = known ? ArrayXd(scatter.errors.inverse()) : ArrayXd::Ones(count);
  MatrixXd powers(count, degree + 1);
  for (Eigen::Index k = 0; k <= degree; ++k) powers.col(k) = x.pow(static_cast<double>(k)) * weights;
  const MatrixXd solves = solver::pseudo_inverse(powers);
  const VectorXd coefficients = solves * (y * weights).matrix();
  const double squares = (powers * coefficients - (y * weights).matrix()).squaredNorm();
  const auto left = static_cast<double>(count - degree - 1);
  const bool explained = known && (left == 0.0 || squares <= gsl_cdf_chisq_Pinv(kConfidence, left));
  const double deviation = explained ? 1.0 : std::sqrt(squares / left);
  const double quantile = gsl_cdf_tdist_Pinv(kBothSides, explained ? scatter.freedom : left);
  const VectorXd by_noise = solves.cwiseAbs() * (noise * weights).matrix();
  return {coefficients, quantile * deviation * solves.rowwise().norm() + by_noise};
}

/// Whether an error is more than noise and scatter.
bool is_distinguished(const MeshSample& error) { return std::abs(error.value) > resolution(error); }

/// Between the two finest meshes.
double finest_order(const Meshes& meshes) {
  const MeshSample& finest = meshes.back();
  const MeshSample& before = meshes[meshes.size() - 2];
  return std::log(before.value / finest.value) / std::log(before.size / finest.size);
}

/// In words; empty where the finest meshes show the order of all.
std::string drift(const Meshes& meshes, const Scatter& scatter, double order) {
  constexpr std::size_t tellable = 5;  // meshes, which leave a curvature two degrees of freedom
  const double finest = finest_order(meshes);
  if (std::abs(finest - order) <= kOrderMargin) return "";
  if (scatter.errors.size() > 0 || meshes.size() >= tellable) {
    const LogFit curved = log_fit(meshes, scatter, 2);
    if (std::abs(curved.coefficients[2]) <= curved.halves[2]) return "";
  }
  return fmt::format("the order still drifts, to {:.2f} between the two finest meshes", finest);
}

/// Whether the error has stopped falling: an order near zero between the finest meshes, and not by scatter.
bool stands_still(const Meshes& meshes, double expected) {
  const MeshSample& finest = meshes.back();
  const MeshSample& before = meshes[meshes.size() - 2];
  const double due = std::abs(before.value) * std::pow(finest.size / before.size, expected);
  return std::abs(finest_order(meshes)) <= kOrderMargin &&
         !(std::abs(finest.value) - due <= resolution(before) + resolution(finest));
}

/// The meshes from the last change of sign on.
Meshes of_one_sign(const Meshes& meshes) {
  const auto opposite = std::find_if(meshes.rbegin(), meshes.rend(),
                                     [&](const MeshSample& mesh) { return mesh.value * meshes.back().value < 0.0; });
  return {opposite.base(), meshes.end()};
}

bool changes_sign(const Meshes& meshes) { return of_one_sign(meshes).size() < meshes.size(); }

/// Without the coarse meshes on which another term of the error, of the other sign, was the largest; all
/// where the sign changes more than once or too late.
Meshes past_change_of_sign(const Meshes& meshes) {
  const Meshes past = of_one_sign(meshes);
  const Meshes before(meshes.begin(), meshes.end() - std::ssize(past));
  return past.size() >= kMinMeshes && (before.empty() || !changes_sign(before)) ? past : meshes;
}

Meshes magnitudes(Meshes errors) {
  for (MeshSample& error : errors) error.value = std::abs(error.value);
  return errors;
}

/// The reason against a power law, before any interval is looked at; empty: none.
std::pair<OrderVerdict, std::string> obstacle(const Meshes& distinguished, const Meshes& all, double expected) {
  const MeshSample& finest = all.back();
  if (!is_distinguished(finest)) {
    return {OrderVerdict::floor,
            fmt::format("the finest error, {:.2g}, is lost in noise and scatter: less than {:.2g} cannot be "
                        "distinguished from zero",
                        std::abs(finest.value), resolution(finest))};
  }
  if (distinguished.size() < kMinMeshes) return {};
  if (changes_sign(distinguished)) {
    return {OrderVerdict::oscillatory, "the error changes its sign from mesh to mesh"};
  }
  if (stands_still(distinguished, expected)) {
    return {OrderVerdict::floor,
            fmt::format("the error has stopped falling: {:.3g} and {:.3g} on the two finest meshes",
                        distinguished[distinguished.size() - 2].value, distinguished.back().value)};
  }
  if (is_non_monotone(magnitudes(distinguished))) {
    return {OrderVerdict::oscillatory, "the error rises on one mesh and falls on another"};
  }
  return {};
}

Order line_order(const Meshes& meshes, const Scatter& scatter) {
  const LogFit line = log_fit(meshes, scatter, 1);
  double centre = 0.0;
  for (const MeshSample& mesh : meshes) centre += std::log(mesh.size) / static_cast<double>(meshes.size());
  const double order = line.coefficients[1];
  const double constant = std::exp(line.coefficients[0] - order * centre);
  return {.value = order,
          .low = order - line.halves[1],
          .high = order + line.halves[1],
          .constant = std::copysign(constant, meshes.back().value),
          .verdict = OrderVerdict::asymptotic,
          .why = "",
          .sizes = sizes_of(meshes)};
}

std::string in_words(const Order& order) {
  return fmt::format("order {:.2f} ({:.2f} to {:.2f})", order.value, order.low, order.high);
}

/// Why a sample is no number; empty if it is one.
std::string flaw(const MeshSample& sample) {
  const bool number = sample.grids > 0 && std::isfinite(sample.value) && std::isfinite(sample.spread);
  if (!number) return fmt::format("no number at size {:.4g}", sample.size);
  return std::isfinite(sample.noise) ? "" : fmt::format("no noise is known at size {:.4g}", sample.size);
}

}  // namespace

std::string to_string(OrderVerdict verdict) {
  constexpr std::array kWords{"asymptotic", "preasymptotic", "superconvergent", "oscillatory", "floor", "too_few"};
  return kWords.at(static_cast<std::size_t>(verdict));
}

MeshSequence coarsest_first(const std::vector<MeshSample>& samples) {
  MeshSequence sequence;
  for (const MeshSample& sample : samples) {
    if (!(sample.size > 0.0)) throw std::invalid_argument(fmt::format("a mesh of size {}", sample.size));
    const std::string reason = flaw(sample);
    if (reason.empty()) {
      sequence.meshes.push_back(sample);
    } else {
      sequence.left_out += (sequence.left_out.empty() ? "" : ", ") + reason;
    }
  }
  std::ranges::sort(sequence.meshes, std::ranges::greater{}, &MeshSample::size);
  const auto twice = std::ranges::adjacent_find(sequence.meshes, {}, &MeshSample::size);
  if (twice != sequence.meshes.end()) {
    throw std::invalid_argument(fmt::format("two meshes of size {}", twice->size));
  }
  return sequence;
}

double standard_error(const MeshSample& sample) { return sample.spread / std::sqrt(sample.grids); }

double uncertainty(const MeshSample& sample) { return sample.noise + kBelievedScatter * standard_error(sample); }

double resolution(const MeshSample& sample) {
  return std::max(kAboveNoise * sample.noise, kBelievedScatter * standard_error(sample));
}

bool is_non_monotone(const std::vector<MeshSample>& meshes) {
  bool rises = false;
  bool falls = false;
  for (std::size_t i = 0; i + 1 < meshes.size(); ++i) {
    const double step = meshes[i + 1].value - meshes[i].value;
    const double noise = resolution(meshes[i]) + resolution(meshes[i + 1]);
    rises |= step > noise;
    falls |= step < -noise;
  }
  return rises && falls;
}

std::vector<double> sizes_of(const std::vector<MeshSample>& meshes) {
  std::vector<double> sizes;
  for (const MeshSample& mesh : meshes) sizes.push_back(mesh.size);
  return sizes;
}

Order order_of_few(const MeshSequence& found, std::size_t asked) {
  return no_order(OrderVerdict::too_few,
                  fmt::format("{} of {} meshes have a number, {} are needed{}{}", found.meshes.size(), asked,
                              kMinMeshes, found.left_out.empty() ? "" : "; ", found.left_out));
}

Order judged_by_interval(Order order, double expected) {
  const double half = std::max(order.high - order.value, order.value - order.low);
  order.verdict = OrderVerdict::preasymptotic;
  if (std::isnan(expected)) {
    order.why = fmt::format("{} has no expected order to compare with", in_words(order));
  } else if (order.low > expected + kOrderMargin) {
    order.verdict = OrderVerdict::superconvergent;
    order.why = fmt::format("{} lies above the expected {:.4g}", in_words(order), expected);
  } else if (!(half <= kWidestHalf)) {
    order.why = fmt::format("{} is too uncertain to compare with the expected {:.4g}", in_words(order), expected);
  } else if (!(order.high >= expected - kOrderMargin)) {
    order.why = fmt::format("{} lies below the expected {:.4g}", in_words(order), expected);
  } else {
    order.verdict = OrderVerdict::asymptotic;
    order.why = fmt::format("{} agrees with the expected {:.4g}", in_words(order), expected);
  }
  return order;
}

Order fit_order(const std::vector<MeshSample>& errors, double expected) {
  const MeshSequence found = coarsest_first(errors);
  const Meshes& all = found.meshes;
  if (all.size() < kMinMeshes) return order_of_few(found, errors.size());
  std::string also = found.left_out.empty() ? "" : "; " + found.left_out;
  Meshes distinguished;
  std::ranges::copy_if(all, std::back_inserter(distinguished), is_distinguished);
  const std::size_t above = distinguished.size();
  distinguished = past_change_of_sign(distinguished);
  if (distinguished.size() < above) {
    also = fmt::format("; {} coarser, with errors of the other sign, left out{}", above - distinguished.size(), also);
  }
  const auto [verdict, reason] = obstacle(distinguished, all, expected);
  if (distinguished.size() < kMinMeshes) {
    return no_order(
        reason.empty() ? OrderVerdict::too_few : verdict,
        fmt::format("{}{} of {} errors are above noise and scatter, {} are needed{}",
                    reason.empty() ? "" : reason + "; ", distinguished.size(), all.size(), kMinMeshes, also));
  }
  const Scatter known = scatter(distinguished);
  Order order = judged_by_interval(line_order(distinguished, known), expected);
  const std::string drifting = drift(distinguished, known, order.value);
  if (!reason.empty()) {
    order.verdict = verdict;
    order.why = fmt::format("{}; {}", reason, in_words(order));
  } else if (!drifting.empty()) {
    order.verdict = OrderVerdict::preasymptotic;
    order.why = fmt::format("{}; {}", drifting, in_words(order));
  }
  order.why += fmt::format(" over {} meshes{}", distinguished.size(), also);
  return order;
}

}  // namespace slipstick::convergence
