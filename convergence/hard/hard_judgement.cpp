#include "convergence/hard/hard_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "convergence/results/quantity.hpp"

namespace slipstick::convergence {
namespace {

/// A converged answer balances its loads to this, relative: rounding of sums over 1e6 cells, and room.
constexpr double kBalanced = 1e-8;
/// A stated uncertainty counts as at least this, relative: rounding and the stopping test leave as much.
constexpr double kMinUncertainty = 1e-6;

/// Answers that differ by less are one answer: what the literature calls good agreement.
constexpr double kAgree = 0.01;
/// Slip opposes traction where its mean angle from there, weighted by slip, is less: degrees.
constexpr double kOpposed = 1.0;
/// Below this part of the energy the slip that is turned is that of rounding and of the stopping test.
constexpr double kNoticed = 1e-6;

std::string text(const Json& json, const char* key) {
  return json.contains(key) && json[key].is_string() ? json[key].get<std::string>() : "";
}

/// The certificate's members against what the tolerance promises; empty: all are kept.
std::string broken_promise(const Json& result) {
  const double gap = number_at(result, "certificate.gap");
  const double rounding = number_at(result, "certificate.rounding");
  const double tolerance = number_at(result, "tolerance");
  const double allowed = std::max(tolerance, std::isnan(rounding) ? 0.0 : rounding);
  if (text(result, "method") != "paper" && !(gap <= allowed)) {
    return fmt::format("its gap is {:.3g}, above {:.3g}", gap, allowed);
  }
  for (const char* member : {"moment", "force", "friction_bound"}) {
    const double missed = number_at(result, std::string("certificate.") + member);
    if (!(missed <= kBalanced)) return fmt::format("certificate.{} is {:.3g}", member, missed);
  }
  return "";
}

/// The largest error that the exact side knows of the contact's motion and load.
double exact_error(const Json& result) {
  double largest = std::numeric_limits<double>::quiet_NaN();
  for (const char* path : {"twist_error", "moment_error", "displacement_error"}) {
    const double error = std::abs(number_at(result, path));
    if (std::isnan(largest) || error > largest) largest = error;
  }
  return largest;
}

/// Infinite where a result says why its mesh resolves nothing; NaN where it says neither.
double stated_uncertainty(const Json& result) {
  const double said = number_at(result, "resolved.uncertainty");
  if (!std::isnan(said)) return std::max(said, kMinUncertainty);
  const bool explained =
      result.contains("resolved") && !text(result["resolved"], "uncertainty_reason").empty();
  return explained ? std::numeric_limits<double>::infinity() : said;
}

/// The number of a variant over that of the first view.
double factor(const char* path, Variant variant) {
  constexpr double millimetres = 1e3;
  const std::string name = path;
  if (variant == Variant::mirrored || variant == Variant::exchanged) {
    return name == "twist_angle" || name == "moment" ? -1.0 : 1.0;
  }
  if (variant != Variant::in_other_units) return 1.0;
  return name == "twist_angle" || name == "normal_load" ? 1.0 : millimetres;
}

/// How far the normal contact of one answer is from that of another, relative.
double pressure_difference(const Json& result, const Json& other) {
  double largest = 0.0;
  for (const char* path : {"normal_load", "contact_radius", "approach", "peak_pressure"}) {
    const double difference = std::abs(number_at(other, path) / number_at(result, path) - 1.0);
    if (!std::isnan(number_at(result, path)) && !(difference <= largest)) largest = difference;
  }
  return largest;
}

}  // namespace

std::string to_string(HardVerdict verdict) {
  constexpr std::array words{"certified", "refused", "not_converged", "wrong"};
  return words[static_cast<std::size_t>(verdict)];
}

JudgedCase judge_alone(const Json& result) {
  const std::string status = text(result, "status");
  const std::string message = text(result, "message");
  if (status == "refused" && !message.empty()) return {HardVerdict::refused, message, Json::object()};
  if (status == "refused") return {HardVerdict::wrong, "refused without a reason", Json::object()};
  if (status == "failed") return {HardVerdict::wrong, "it died: " + message, Json::object()};
  Json numbers;
  for (const char* key :
       {"operator_applications", "pressure_applications", "seconds.total", "slip_direction.mean"}) {
    set_number(numbers, key, number_at(result, key), "the result has none");
  }
  if (result.contains("safeguards")) numbers["safeguards"] = result["safeguards"];
  if (status != "converged") return {HardVerdict::not_converged, message, numbers};

  const double error = exact_error(result);
  const double uncertainty = stated_uncertainty(result);
  set_number(numbers, "error", error, "no exact answer is known");
  set_number(numbers, "uncertainty", uncertainty, "no size: the stick area lies within a cell");
  set_number(numbers, "certificate.gap", number_at(result, "certificate.gap"), "the result has none");
  if (const std::string broken = broken_promise(result); !broken.empty()) {
    return {HardVerdict::wrong, broken, numbers};
  }
  if (std::isnan(uncertainty)) return {HardVerdict::wrong, "it states no uncertainty", numbers};
  if (error > uncertainty) {
    return {HardVerdict::wrong,
            fmt::format("it is {:.3g} from the exact answer, and says {:.3g}", error, uncertainty), numbers};
  }
  return {HardVerdict::certified, "", numbers};
}

/// The size to compare a number with where it is zero, or would be without rounding.
double natural_size(const Json& result, const std::string& path) {
  const double limit = number_at(result, "moment_limit");
  const double radius = number_at(result, "contact_radius");
  const double force = std::hypot(number_at(result, "force[0]"), number_at(result, "force[1]"));
  const double shift = std::hypot(number_at(result, "displacement[0]"), number_at(result, "displacement[1]"));
  const auto or_nothing = [](double size) { return std::isfinite(size) ? size : 0.0; };
  // A state that has come back to nothing is measured by the energy of its certificate.
  const double energy =
      std::fmax(number_at(result, "elastic_energy"), number_at(result, "certificate.energy"));
  if (path == "elastic_energy") return or_nothing(energy);
  if (path == "moment")
    return or_nothing(force * radius) + or_nothing(energy * radius / number_at(result, "approach"));
  if (path != "twist_angle") return 0.0;
  return or_nothing(energy / limit) + or_nothing(shift / radius);
}

double main_value(const Json& result) {
  const std::string path = result["resolved"].value("number", "");
  const double value = number_at(result, path);
  const double size = std::isnan(value)
                          ? std::hypot(number_at(result, path + "[0]"), number_at(result, path + "[1]"))
                          : value;
  const bool nothing_acts = number_at(result, "resolved.absolute") == 0.0;
  return size == 0.0 || nothing_acts ? std::numeric_limits<double>::quiet_NaN() : size;
}

MeshReference judge_by_finer(double value, double absolute, double twice, double four_times) {
  const double error = std::abs(value - four_times);
  const double change = std::abs(twice - four_times);
  const bool claims_nothing = absolute >= std::abs(value);
  const double unit = 1.0 / std::abs(four_times);
  return {unit * error, unit * change,
          error <= absolute + change || (claims_nothing && std::isfinite(error))};
}

double same_answer(const Json& result) {
  constexpr double kSame = 1e-6;
  const double missing = number_at(result, "limit.factor") - 1.0;
  return missing > 0.0 ? kSame + number_at(result, "tolerance") / missing : kSame;
}

double variant_difference(const Json& result, const Json& seen, Variant variant) {
  double largest = 0.0;
  for (const char* path :
       {"twist_angle", "moment", "moment_limit", "normal_load", "contact_radius", "elastic_energy"}) {
    const double first = number_at(result, path);
    const double second = number_at(seen, path);
    if (std::isnan(first) && std::isnan(second)) continue;
    const double expected = factor(path, variant) * first;
    const double scale = std::max({std::abs(expected), std::abs(second), natural_size(seen, path)});
    const double difference = scale > 0.0 ? std::abs(second - expected) / scale : 0.0;
    if (!(difference <= largest)) largest = difference;
    if (std::isnan(largest)) return largest;
  }
  return largest;
}

std::string to_string(MethodVerdict verdict) {
  constexpr std::array words{"agrees", "refused", "not_converged", "other_direction", "other_answer"};
  return words[static_cast<std::size_t>(verdict)];
}

ComparedAnswer compare_answer(const Json& certified, const Json& other) {
  JudgedCase alone = judge_alone(other);
  if (alone.verdict == HardVerdict::refused) return {MethodVerdict::refused, alone.reason, {}};
  if (alone.verdict == HardVerdict::not_converged) {
    return {MethodVerdict::not_converged, alone.reason, alone.numbers};
  }
  const bool foreign = other.contains("program");
  if (alone.verdict == HardVerdict::wrong && !foreign) {
    return {MethodVerdict::other_answer, alone.reason, alone.numbers};
  }
  if (certified.value("status", "") != "converged") {
    return {MethodVerdict::other_answer, "there is no certified answer", alone.numbers};
  }
  const bool pressure = foreign && other["program"]["fields"] == "pressure";
  const double difference =
      pressure ? pressure_difference(certified, other) : variant_difference(certified, other, Variant::none);
  set_number(alone.numbers, "difference", difference, "a number is missing");
  // Another discretisation has another error, and promises no gap on this one.
  const double by_mesh = foreign ? std::fmax(number_at(certified, "resolved.uncertainty"), 0.0) : 0.0;
  if (!(difference <= kAgree + same_answer(certified) + by_mesh)) {
    return {MethodVerdict::other_answer,
            fmt::format("it differs by {:.2g} from the certified answer", difference), alone.numbers};
  }
  const double direction = number_at(alone.numbers, "slip_direction.mean");
  if (foreign && std::isnan(direction)) return {MethodVerdict::agrees, "", alone.numbers};  // nothing slips
  if (!(direction <= kOpposed) && !(number_at(alone.numbers, "certificate.gap") <= kNoticed)) {
    return {MethodVerdict::other_direction,
            fmt::format("its slip is turned by {:.2g} degrees from the reverse of traction", direction),
            alone.numbers};
  }
  return {MethodVerdict::agrees, "", alone.numbers};
}

}  // namespace slipstick::convergence
