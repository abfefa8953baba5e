#include "convergence/gates/published.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>
#include <utility>
#include <variant>

#include "convergence/results/quantity.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

/// The error that the result states of our number, absolute; none where it states none.
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

double in_unit_of_publication(const Published& published, double ours) {
  return published.inverse ? published.times / ours : published.times * ours;
}
double in_our_unit(const Published& published, double value) {
  return published.inverse ? published.times / value : value / published.times;
}

/// Our own error, absolute; 0 where there is no number.
double error_of_ours(const Gate& gate, const Json& result) {
  const FoundQuantity found = find_quantity(result, gate.quantity);
  if (found.value == nullptr || !found.value->is_number()) return 0.0;
  const auto& relative = std::get<Published>(gate.bound).relative_error;
  const std::optional<double> error =
      relative ? *relative * std::abs(found.value->get<double>()) : own_error(found);
  if (error) return *error;
  throw solver::InputError(gate.file.string() + ": " + gate.id, "quantity", gate.quantity,
                           "a number with an error in the result, such as a study's extrapolated value "
                           "or an exact answer");
}

/// The interval of our number in which it agrees.
Interval interval_of(const Published& published, double own_error) {
  const double open = published.number.half_unit + published.argument_error;
  const double one_end = in_our_unit(published, published.number.value - open);
  const double other_end = in_our_unit(published, published.number.value + open);
  return {std::min(one_end, other_end) - own_error, std::max(one_end, other_end) + own_error};
}

/// The reason of the gate file, where it expects this comparison.
std::string reason_for(const Published& published, Comparison comparison) {
  return published.expected == comparison ? published.why : "";
}

}  // namespace

std::string to_string(Comparison comparison) {
  constexpr std::array kWords{"agrees", "differs", "undecided", "not compared"};
  return kWords.at(static_cast<std::size_t>(comparison));
}

std::optional<PrintedNumber> read_printed(const std::string& text) {
  static const std::regex fraction(R"((\d{1,9})/([1-9]\d{0,8}))");
  static const std::regex form(R"(([+-]?\d+(?:\.(\d*))?)(?:[eE]([+-]?\d{1,2}))?)");
  std::smatch parts;
  if (std::regex_match(text, parts, fraction)) {
    constexpr double kFractionDigits = 12.0;  // accuracy of exact answers
    const double value = std::stod(parts[1]) / std::stod(parts[2]);
    return PrintedNumber{text, value, 0.5 * std::pow(10.0, -kFractionDigits) * std::abs(value)};
  }
  if (!std::regex_match(text, parts, form)) return {};
  const int exponent = parts[3].matched ? std::stoi(parts[3]) : 0;
  const auto decimals = static_cast<int>(parts[2].length());
  return PrintedNumber{text, std::stod(text), 0.5 * std::pow(10.0, exponent - decimals)};
}

std::optional<OwnNumber> own_number(const Judgement& judgement) {
  if (!judgement.value.is_number()) return {};
  const auto& published = std::get<Published>(judgement.gate.bound);
  const double ours = judgement.value.get<double>();
  const double shown = in_unit_of_publication(published, ours);
  const double scale = std::abs(shown / ours);
  return OwnNumber{shown, judgement.own_error * scale,
                   judgement.own_error * scale / published.number.half_unit};
}

Judgement judge_published(const Gate& gate, const Json& result) {
  const auto& published = std::get<Published>(gate.bound);
  const double own_error = error_of_ours(gate, result);
  Judgement judgement = judge_within(gate, interval_of(published, own_error), result);
  judgement.own_error = own_error;
  const bool within =
      judgement.outcome == Outcome::passed || judgement.outcome == Outcome::passed_unexpectedly;
  const double half_units = own_number(judgement).value_or(OwnNumber{}).half_units;
  const double half_unit = published.number.half_unit;
  const bool known = half_units * half_unit <= half_unit + published.argument_error;
  const bool undecided = published.expected == Comparison::undecided;
  if (within && !known) {
    judgement.outcome = undecided ? Outcome::reported : Outcome::refused;
    judgement.why = fmt::format(
        "our own error is {:.3g} half units of the last printed digit, too large for a comparison{}",
        half_units,
        undecided ? ": " + published.why : "; reduce our error, or give the reason in `undecided`");
  } else if (undecided && judgement.outcome == Outcome::passed) {
    judgement.outcome = Outcome::passed_unexpectedly;
    judgement.why = "agrees with the published number: remove `undecided`";
  }
  return judgement;
}

std::optional<Comparison> comparison_of(const Judgement& judgement) {
  const auto* const published = std::get_if<Published>(&judgement.gate.bound);
  if (published == nullptr) return {};
  if (judgement.outcome == Outcome::passed) return Comparison::agrees;
  if (judgement.outcome == Outcome::failed_as_expected) return Comparison::differs;
  if (judgement.outcome != Outcome::reported) return {};
  return published->expected == Comparison::undecided ? Comparison::undecided : Comparison::not_compared;
}

Json published_json(const Judgement& judgement) {
  const auto& published = std::get<Published>(judgement.gate.bound);
  const auto& [text, value, half_unit] = published.number;
  const std::optional<Comparison> comparison = comparison_of(judgement);
  Json json{{"text", text},
            {"value", value},
            {"half_unit", half_unit},
            {"source", published.source},
            {"seen", published.seen},
            {"argument_error", published.argument_error},
            {"differs", reason_for(published, Comparison::differs)},
            {"undecided", reason_for(published, Comparison::undecided)},
            {"not_compared", reason_for(published, Comparison::not_compared)},
            {"comparison", comparison ? to_string(*comparison) : ""}};
  if (const std::optional<OwnNumber> ours = own_number(judgement)) {
    json.update(Json{{"ours", ours->value},
                     {"own_error", ours->error},
                     {"own_error_half_units", ours->half_units},
                     {"deviation", (ours->value - value) / half_unit}});
  }
  return json;
}

}  // namespace slipstick::convergence
