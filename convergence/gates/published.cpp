
#include "convergence/gates/gate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <regex>
#include <utility>

#include "convergence/results/quantity.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

/// How far our number may be off, absolute: what the result says of it; none where it says nothing.
std::optional<double> own_error(const FoundQuantity& found) {
  const double size = std::abs(found.value->get<double>());
  for (auto object = found.within.rbegin(); object != found.within.rend(); ++object) {
    if (!(*object)->is_object()) continue;
    for (const auto& [key, unit] : {std::pair{"uncertainty", 1.0}, std::pair{"relative_uncertainty", size}}) {
      const auto stated = (*object)->find(key);
      if (stated != (*object)->end() && stated->is_number()) return unit * stated->get<double>();
    }
  }
  return {};
}

/// The published number from ours, and ours from the published one.
double in_unit_of_publication(const Published& published, double ours) {
  return published.inverse ? published.times / ours : published.times * ours;
}
double in_our_unit(const Published& published, double value) {
  return published.inverse ? published.times / value : value / published.times;
}

/// The gate with bounds on our number.
Gate bounded_by_publication(Gate gate, const Json& result) {
  const FoundQuantity found = find_quantity(result, gate.quantity);
  Published& published = *gate.published;
  if (found.value != nullptr && found.value->is_number()) {
    const double size = std::abs(found.value->get<double>());
    const std::optional<double> error =
        published.relative_error ? *published.relative_error * size : own_error(found);
    if (!error) {
      throw solver::InputError(gate.file.string() + ": " + gate.id, "quantity", gate.quantity,
                               "a number whose own error the result states, as a study's extrapolated values "
                               "and exact answers have one");
    }
    published.own_error = *error;
  }
  const double open = published.half_unit + published.argument_error;
  const double one_end = in_our_unit(published, published.value - open);
  const double other_end = in_our_unit(published, published.value + open);
  gate.above = std::min(one_end, other_end) - published.own_error;
  gate.below = std::max(one_end, other_end) + published.own_error;
  return gate;
}

/// Our own error over half a unit of the last digit.
double own_half_units(const Published& published, double ours) {
  return published.own_error * std::abs(in_unit_of_publication(published, ours) / ours) / published.half_unit;
}

}  // namespace

std::optional<Published> read_printed(const std::string& text) {
  static const std::regex fraction(R"((\d{1,9})/([1-9]\d{0,8}))");
  static const std::regex form(R"(([+-]?\d+(?:\.(\d*))?)(?:[eE]([+-]?\d{1,2}))?)");
  std::smatch parts;
  Published published;
  published.text = text;
  if (std::regex_match(text, parts, fraction)) {
    published.value = std::stod(parts[1]) / std::stod(parts[2]);
    constexpr double kFractionDigits = 12.0;  // as far as exact answers are good
    published.half_unit = 0.5 * std::pow(10.0, -kFractionDigits) * std::abs(published.value);
    return published;
  }
  if (!std::regex_match(text, parts, form)) return {};
  const int exponent = parts[3].matched ? std::stoi(parts[3]) : 0;
  const auto decimals = static_cast<int>(parts[2].length());
  published.value = std::stod(text);
  published.half_unit = 0.5 * std::pow(10.0, exponent - decimals);
  return published;
}

Judgement judge_published(Gate gate, const Json& result) {
  Judgement judgement = judge(bounded_by_publication(std::move(gate), result), result);
  const Published& published = *judgement.gate.published;
  const bool within =
      judgement.outcome == Outcome::passed || judgement.outcome == Outcome::passed_unexpectedly;
  const double own =
      judgement.value.is_number() ? own_half_units(published, judgement.value.get<double>()) : 0.0;
  const bool known = own * published.half_unit <= published.half_unit + published.argument_error;
  if (within && !known) {
    judgement.outcome = published.undecided.empty() ? Outcome::refused : Outcome::reported;
    judgement.why = fmt::format(
        "our own error is {:.3g} half units of the last printed digit: it cannot be compared at its "
        "digits{}",
        own,
        published.undecided.empty() ? "; improve ours, or say why: undecided" : ": " + published.undecided);
  } else if (!published.undecided.empty() && judgement.outcome == Outcome::passed) {
    judgement.outcome = Outcome::passed_unexpectedly;
    judgement.why = "agrees with the published number: remove undecided";
  }
  return judgement;
}

std::string published_outcome(const Judgement& judgement) {
  if (!judgement.gate.published) return "";
  if (judgement.outcome == Outcome::passed) return "agrees";
  if (judgement.outcome == Outcome::failed_as_expected) return "differs";
  if (judgement.outcome != Outcome::reported) return "";
  return judgement.gate.published->undecided.empty() ? "not compared" : "undecided";
}

Json published_json(const Judgement& judgement) {
  const Published& published = *judgement.gate.published;
  Json json{{"text", published.text},
            {"value", published.value},
            {"half_unit", published.half_unit},
            {"source", published.source},
            {"seen", published.seen},
            {"argument_error", published.argument_error},
            {"differs", published.differs},
            {"undecided", published.undecided},
            {"not_compared", published.not_compared},
            {"comparison", published_outcome(judgement)}};
  if (!judgement.value.is_number()) return json;
  const double ours = judgement.value.get<double>();
  const double shown = in_unit_of_publication(published, ours);
  json["ours"] = shown;
  json["own_error"] = published.own_error * std::abs(shown / ours);
  json["own_error_half_units"] = own_half_units(published, ours);
  json["deviation"] = (shown - published.value) / published.half_unit;
  return json;
}

}  // namespace slipstick::convergence
