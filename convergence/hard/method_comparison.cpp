#include "convergence/hard/method_comparison.hpp"

#include <fmt/core.h>

#include <array>
#include <limits>
#include <nlohmann/json.hpp>

#include "convergence/hard/hard_judgement.hpp"
#include "convergence/runs/variant.hpp"

namespace slipstick::convergence {
namespace {

/// Answers that differ by less are one answer: what the literature calls good agreement.
constexpr double kAgree = 0.01;
/// Slip opposes traction where its mean angle from there, weighted by slip, is less: degrees.
constexpr double kOpposed = 1.0;
/// Below this part of the energy the slip that is turned is that of rounding and of the stopping test.
constexpr double kNoticed = 1e-6;

double number_or_nan(const Json& json) {
  return json.is_number() ? json.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

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
  if (alone.verdict == HardVerdict::wrong) return {MethodVerdict::other_answer, alone.reason, alone.numbers};
  if (certified.value("status", "") != "converged") {
    return {MethodVerdict::other_answer, "there is no certified answer", alone.numbers};
  }
  const double difference = variant_difference(certified, other, Variant::none);
  set_number(alone.numbers, "difference", difference, "a number is missing");
  if (!(difference <= kAgree + same_answer(certified))) {
    return {MethodVerdict::other_answer,
            fmt::format("it differs by {:.2g} from the certified answer", difference), alone.numbers};
  }
  const double direction = number_or_nan(alone.numbers["slip_direction.mean"]);
  if (!(direction <= kOpposed) && !(number_or_nan(alone.numbers["certificate.gap"]) <= kNoticed)) {
    return {MethodVerdict::other_direction,
            fmt::format("its slip is turned by {:.2g} degrees from the reverse of traction", direction),
            alone.numbers};
  }
  return {MethodVerdict::agrees, "", alone.numbers};
}

}  // namespace slipstick::convergence
