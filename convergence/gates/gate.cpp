#include "convergence/gates/gate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <regex>
#include <utility>

#include "convergence/results/markup.hpp"
#include "convergence/runs/run_spec.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/misspelling.hpp"

namespace slipstick::convergence {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The relative error of the reference that stands in one object of a result.
const Json* stated_reference_error(const Json& object) {
  if (!object.is_object()) return nullptr;
  if (const auto direct = object.find("reference_uncertainty"); direct != object.end()) return &*direct;
  const auto exact = object.find("exact");
  if (exact == object.end() || !exact->is_object()) return nullptr;
  const auto stated = exact->find("relative_uncertainty");
  return stated == exact->end() ? nullptr : &*stated;
}

/// The interval of a bound that needs no other result.
std::optional<Interval> own_interval(const Bound& bound) {
  if (const auto* below = std::get_if<Below>(&bound)) return Interval{-below->size, below->size};
  const auto* interval = std::get_if<Interval>(&bound);
  return interval ? std::optional(*interval) : std::nullopt;
}

double half_width(const Interval& interval) { return 0.5 * (interval.high - interval.low); }

/// Distance of a value from the middle over half the width; 0 or infinite where the bound has no middle.
double factor_of(const Judgement& judgement) {
  const Json& value = judgement.value;
  if (const auto* equals = std::get_if<Equals>(&judgement.gate.bound)) return value == equals->value ? 0.0 : kInfinity;
  if (!value.is_number() || !judgement.interval) return kInfinity;
  const double number = value.get<double>();
  const auto [low, high] = *judgement.interval;
  if (std::isfinite(high)) return std::abs(number - 0.5 * (high + low)) / half_width(*judgement.interval);
  if (number > 0.0 && low > 0.0) return low / number;
  return number > low ? 0.0 : kInfinity;
}

bool holds(const Judgement& judgement) {
  const Json& value = judgement.value;
  if (const auto* equals = std::get_if<Equals>(&judgement.gate.bound)) return value == equals->value;
  if (!value.is_number() || !judgement.interval) return false;
  const double number = value.get<double>();
  return number > judgement.interval->low && number < judgement.interval->high;
}

/// Why a gate is narrower than the errors allow; empty where it is wide enough.
std::string too_tight(const Judgement& judgement, const Json& result) {
  const Gate& gate = judgement.gate;
  const bool is_bounded = judgement.interval && std::isfinite(judgement.interval->high);
  if (!is_bounded || std::holds_alternative<Published>(gate.bound)) return "";
  double reference = reference_error(result, gate.quantity);
  if (std::isnan(reference) && std::holds_alternative<ResultSource>(gate.source)) reference = 0.0;
  if (std::isnan(reference)) {
    return "the result does not state the uncertainty of the exact answer, so the gate may be narrower than "
           "it";
  }
  const double needed = kGateMargin * (reference + gate.platform_spread);
  const double tolerance = half_width(*judgement.interval);
  if (tolerance >= needed) return "";
  return fmt::format(
      "narrower than its reference allows: the half width is {:.3g} and must be at least {:.3g}, {:g} times "
      "the sum of reference error {:.2g} and platform spread {:.2g}",
      tolerance, needed, kGateMargin, reference, gate.platform_spread);
}

std::string because(const std::string& reason) { return reason.empty() ? "" : ": " + reason; }

/// The noun for the work that made a result.
std::string maker(const GateSource& source) {
  if (std::holds_alternative<SceneSource>(source)) return "solve";
  return std::holds_alternative<StudySource>(source) ? "study" : "run";
}

bool is_value(const FoundQuantity& found) {
  return found.value != nullptr && !found.value->is_null() && !found.value->is_structured();
}

/// Whether the result knows no such name, not even as one without a value.
bool is_unknown(const FoundQuantity& found) { return found.value == nullptr && found.reason.empty(); }

/// Why there is no number: the reason that the result gives, or the nearest name that it has.
std::string missing_text(const Gate& gate, const Json& result, const FoundQuantity& found) {
  if (!is_unknown(found)) return fmt::format("{} is not a number{}", gate.quantity, because(found.reason));
  if (is_failed(result)) {
    return fmt::format("there is no {}: the {} {}{}", gate.quantity, maker(gate.source),
                       text_at(result, "status") == "failed" ? "failed" : "was refused",
                       because(text_at(result, "message")));
  }
  return fmt::format("the result has no {}; the nearest is {}", gate.quantity,
                     solver::nearest_word(gate.quantity, quantity_paths(result)));
}

std::string out_of_bounds_text(const Judgement& judgement) {
  const Json& value = judgement.value;
  const bool has_factor = std::holds_alternative<Below>(judgement.gate.bound) && std::isfinite(judgement.factor);
  return fmt::format("{} is {}, must be {}{}", judgement.gate.quantity,
                     value.is_number() ? number_text(value.get<double>()) : value.dump(), bound_text(judgement),
                     has_factor ? fmt::format(": {:.3g} times the bound", judgement.factor) : "");
}

/// Why the solve, or runs of the study, have no result; empty where all have one.
std::string died(const Gate& gate, const Json& result) {
  if (!std::holds_alternative<ResultSource>(gate.source) && text_at(result, "status") == "failed") {
    return fmt::format("the {} failed{}", maker(gate.source), because(text_at(result, "message")));
  }
  return result.is_object() ? failed_runs_text(result) : "";
}

/// The message of a solve that did not reach its tolerance; empty where it did.
std::string unfinished(const Gate& gate, const Json& result) {
  if (gate.quantity == "status" || text_at(result, "status") != "not_converged") return "";
  return "the solve did not reach its tolerance" + because(text_at(result, "message"));
}

Outcome outcome_of(GateStatus status, bool held) {
  if (status == GateStatus::report_only) return Outcome::reported;
  if (status == GateStatus::active) return held ? Outcome::passed : Outcome::failed;
  return held ? Outcome::passed_unexpectedly : Outcome::failed_as_expected;
}

Judgement judge_by(Judgement judgement, const Json& result) {
  const Gate& gate = judgement.gate;
  const FoundQuantity found = find_quantity(result, gate.quantity);
  if (is_value(found)) judgement.value = *found.value;
  judgement.why = died(gate, result);
  if (!judgement.why.empty()) {
    judgement.outcome = Outcome::failed;
    return judgement;
  }
  judgement.factor = factor_of(judgement);
  if (is_value(found)) judgement.why = too_tight(judgement, result);
  if (!judgement.why.empty()) return judgement;
  if (!is_value(found)) {
    judgement.why = missing_text(gate, result, found);
  } else {
    judgement.why = holds(judgement) ? unfinished(gate, result) : out_of_bounds_text(judgement);
  }
  judgement.outcome = outcome_of(gate.status, judgement.why.empty());
  const bool is_published = std::holds_alternative<Published>(gate.bound);
  if (judgement.outcome == Outcome::passed_unexpectedly) {
    judgement.why = is_published ? "agrees with the published number: remove `differs`"
                                 : "expected to fail, and holds: remove the gate, or make it active";
  }
  const bool no_number = is_published && (!std::isfinite(judgement.factor) || !unfinished(gate, result).empty());
  if (judgement.outcome == Outcome::failed_as_expected && (is_unknown(found) || no_number)) {
    judgement.outcome = Outcome::failed;  // a misspelt quantity is not the expected failure
  }
  return judgement;
}

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
  const std::optional<double> error = relative ? *relative * std::abs(found.value->get<double>()) : own_error(found);
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

/// Judges by an interval that was found for the bound.
Judgement judge_within(const Gate& gate, const Interval& interval, const Json& result) {
  Judgement judgement = refuse(gate, "");
  judgement.interval = interval;
  return judge_by(std::move(judgement), result);
}

Judgement judge_relative(const Gate& gate, const Json& result, const Json& other) {
  const auto& [file, within] = std::get<RelativeTo>(gate.bound);
  const FoundQuantity found = find_quantity(other, gate.quantity);
  std::string why = died(gate, other);
  if (why.empty()) why = is_value(found) ? unfinished(gate, other) : missing_text(gate, other, found);
  if (why.empty() && !(found.value->is_number() && std::abs(found.value->get<double>()) > 0.0)) {
    why = fmt::format("{} is {}", gate.quantity, found.value->dump());
  }
  if (!why.empty()) throw solver::InputError(file.string(), why + "; allowed: a number that is not zero");
  const double number = found.value->get<double>();
  const double allowed = within * std::abs(number);
  return judge_within(gate, {number - allowed, number + allowed}, result);
}

Judgement judge_published(const Gate& gate, const Json& result) {
  const auto& published = std::get<Published>(gate.bound);
  const double own_error = error_of_ours(gate, result);
  Judgement judgement = judge_within(gate, interval_of(published, own_error), result);
  judgement.own_error = own_error;
  const bool within = judgement.outcome == Outcome::passed || judgement.outcome == Outcome::passed_unexpectedly;
  const double half_units = own_number(judgement).value_or(OwnNumber{}).half_units;
  const double half_unit = published.number.half_unit;
  const bool known = half_units * half_unit <= half_unit + published.argument_error;
  const bool undecided = published.expected == Comparison::undecided;
  if (within && !known) {
    judgement.outcome = undecided ? Outcome::reported : Outcome::refused;
    judgement.why = fmt::format(
        "our own error is {:.3g} half units of the last printed digit, too large for a comparison{}", half_units,
        undecided ? ": " + published.why : "; reduce our error, or give the reason in `undecided`");
  } else if (undecided && judgement.outcome == Outcome::passed) {
    judgement.outcome = Outcome::passed_unexpectedly;
    judgement.why = "agrees with the published number: remove `undecided`";
  }
  return judgement;
}

/// The reason of the gate file, where it expects this comparison.
std::string reason_for(const Published& published, Comparison comparison) {
  return published.expected == comparison ? published.why : "";
}

}  // namespace

std::string to_string(Outcome outcome) {
  constexpr std::array kWords{"passed", "failed", "failed as expected", "passed unexpectedly", "reported", "refused"};
  return kWords.at(static_cast<std::size_t>(outcome));
}

bool is_error(const std::string& quantity) { return quantity.find("error") != std::string::npos; }

double reference_error(const Json& result, const std::string& quantity) {
  if (!is_error(quantity)) return 0.0;
  const std::vector<const Json*> within = find_quantity(result, quantity).within;
  for (auto object = within.rbegin(); object != within.rend(); ++object) {
    const Json* const stated = stated_reference_error(**object);
    if (stated != nullptr) return stated->is_number() ? stated->get<double>() : kNaN;
  }
  return kNaN;
}

Judgement judge(const Gate& gate, const Json& result, const Json* other) {
  if (std::holds_alternative<Published>(gate.bound)) return judge_published(gate, result);
  return other != nullptr ? judge_relative(gate, result, *other) : judge_by(refuse(gate, ""), result);
}

Judgement refuse(const Gate& gate, const std::string& why) {
  Judgement judgement;
  judgement.gate = gate;
  judgement.interval = own_interval(gate.bound);
  judgement.factor = kInfinity;
  judgement.why = why;
  return judgement;
}

int exit_code(const std::vector<Judgement>& judgements) {
  const auto any = [&](Outcome outcome) {
    return std::ranges::find(judgements, outcome, &Judgement::outcome) != judgements.end();
  };
  if (judgements.empty() || any(Outcome::refused)) return 2;
  return any(Outcome::failed) || any(Outcome::passed_unexpectedly) ? 1 : 0;
}

std::string bound_text(const Judgement& judgement) {
  struct Text {
    const std::optional<Interval>& known;
    std::string operator()(const Below& below) const { return fmt::format("below {} in size", below.size); }
    std::string operator()(const Interval& interval) const {
      return std::isfinite(interval.high) ? fmt::format("between {} and {}", interval.low, interval.high)
                                          : fmt::format("above {}", interval.low);
    }
    std::string operator()(const Equals& equals) const {
      return "equal to " +
             (equals.value.is_number() ? fmt::format("{}", equals.value.get<double>()) : equals.value.dump());
    }
    std::string operator()(const RelativeTo& relative) const {
      const std::string other =
          known ? fmt::format("{:.7g}, the value", 0.5 * (known->high + known->low)) : "the value";
      return fmt::format("within {:g} of {} of {}", relative.within, other, relative.file.filename().string());
    }
    std::string operator()(const Published& published) const {
      return fmt::format("the published {} ({})", published.number.text, published.source);
    }
  };
  return std::visit(Text{judgement.interval}, judgement.gate.bound);
}

std::string rerun_command(const Gate& gate) {
  const auto* const result = std::get_if<ResultSource>(&gate.source);
  const bool elsewhere = result != nullptr && !result->folder.empty();
  return fmt::format("slipstick gate {}{} --only {}", shell_word(gate.file.string()),
                     elsewhere ? " --results " + shell_word(result->folder.string()) : "", shell_word(gate.id));
}

std::filesystem::path file_of(const GateSource& source) {
  return std::visit(
      [](const auto& each) -> std::filesystem::path {
        if constexpr (requires { each.file; }) return each.file;
        return {};
      },
      source);
}

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
  return OwnNumber{shown, judgement.own_error * scale, judgement.own_error * scale / published.number.half_unit};
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
