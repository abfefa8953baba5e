#include "convergence/gates/gate.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "convergence/results/markup.hpp"
#include "convergence/results/quantity.hpp"
#include "convergence/runs/failed_runs.hpp"
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

/// By how much a value may be off before the verdict changes; NaN where it asks for no such thing.
double tolerance(const Gate& gate) {
  if (!gate.below) return kNaN;
  return gate.above ? 0.5 * (*gate.below - *gate.above) : *gate.below;
}

/// Factor of the bound that a number reaches.
double factor_of(const Gate& gate, const Json& value) {
  if (!gate.equals.is_null()) return value == gate.equals ? 0.0 : kInfinity;
  if (!value.is_number()) return kInfinity;
  const double number = value.get<double>();
  if (gate.below && gate.above) {
    return std::abs(number - 0.5 * (*gate.below + *gate.above)) / tolerance(gate);
  }
  if (gate.below) return std::abs(number) / *gate.below;
  if (number > 0.0 && *gate.above > 0.0) return *gate.above / number;
  return number > *gate.above ? 0.0 : kInfinity;
}

bool holds(const Gate& gate, const Json& value) {
  if (!gate.equals.is_null()) return value == gate.equals;
  if (!value.is_number()) return false;
  const double number = value.get<double>();
  if (gate.above && !(number > *gate.above)) return false;
  return !gate.below || (gate.above ? number : std::abs(number)) < *gate.below;
}

/// Why a gate is tighter than what it is judged by allows; empty where it is not.
std::string too_tight(const Gate& gate, const Json& result) {
  if (!gate.below || gate.published) return "";
  double reference = reference_error(result, gate.quantity);
  if (std::isnan(reference) && gate.kind == GateSource::result) reference = 0.0;
  if (std::isnan(reference)) {
    return "the result does not say how uncertain the exact answer is, so nothing says whether the gate is "
           "wide enough";
  }
  const double needed = kGateMargin * (reference + gate.platform_spread);
  if (tolerance(gate) >= needed) return "";
  return fmt::format(
      "tighter than its reference allows: it leaves {:.3g}, and {:.3g} is needed, {:g} times the "
      "reference error {:.2g} and the platform spread {:.2g} together",
      tolerance(gate), needed, kGateMargin, reference, gate.platform_spread);
}

std::string because(const std::string& reason) { return reason.empty() ? "" : ": " + reason; }

std::string word(const Json& result, const char* key) {
  return result.is_object() && result.contains(key) && result[key].is_string()
             ? result[key].get<std::string>()
             : "";
}

/// The work that made a result.
std::string maker(GateSource kind) {
  if (kind == GateSource::scene) return "solve";
  return kind == GateSource::study ? "study" : "run";
}

bool is_value(const FoundQuantity& found) {
  return found.value != nullptr && !found.value->is_null() && !found.value->is_structured();
}

/// Whether the result knows no such name, not even as one without a value.
bool is_unknown(const FoundQuantity& found) { return found.value == nullptr && found.reason.empty(); }

/// Why there is no number: what the result says, or which name comes nearest.
std::string missing_text(const Gate& gate, const Json& result, const FoundQuantity& found) {
  if (!is_unknown(found)) return fmt::format("{} is not a number{}", gate.quantity, because(found.reason));
  if (const std::string status = word(result, "status"); status == "failed" || status == "refused") {
    return fmt::format("there is no {}: the {} {}{}", gate.quantity, maker(gate.kind),
                       status == "failed" ? "failed" : "was refused", because(word(result, "message")));
  }
  return fmt::format("the result has no {}; the nearest is {}", gate.quantity,
                     solver::nearest_word(gate.quantity, quantity_paths(result)));
}

std::string out_of_bounds_text(const Gate& gate, const Json& value) {
  const double factor = factor_of(gate, value);
  const bool has_factor = gate.equals.is_null() && !gate.above && std::isfinite(factor);
  return fmt::format("{} is {}, must be {}{}", gate.quantity,
                     value.is_number() ? number_text(value) : value.dump(), bound_text(gate),
                     has_factor ? fmt::format(": {:.3g} times the bound", factor) : "");
}

/// Why runs are missing that the value rests on, the one of a solve or some of a study's; empty: none is. It
/// says nothing of what the gate asks for, so that nothing else is judged.
std::string died(const Gate& gate, const Json& result) {
  if (gate.kind != GateSource::result && word(result, "status") == "failed") {
    return fmt::format("the {} failed{}", maker(gate.kind), because(word(result, "message")));
  }
  return result.is_object() ? failed_runs_text(result) : "";
}

/// The reason against a number of a solve that did not reach its tolerance; empty where it did.
std::string unfinished(const Gate& gate, const Json& result) {
  if (gate.quantity == "status" || word(result, "status") != "not_converged") return "";
  return "the solve did not reach its tolerance" + because(word(result, "message"));
}

/// Why a gate does not hold; empty where it does.
std::string fault(const Gate& gate, const Json& result, const FoundQuantity& found) {
  if (!is_value(found)) return missing_text(gate, result, found);
  if (!holds(gate, *found.value)) return out_of_bounds_text(gate, *found.value);
  return unfinished(gate, result);
}

Outcome outcome_of(GateStatus status, bool held) {
  if (status == GateStatus::report_only) return Outcome::reported;
  if (status == GateStatus::active) return held ? Outcome::passed : Outcome::failed;
  return held ? Outcome::passed_unexpectedly : Outcome::failed_as_expected;
}

}  // namespace

std::string to_string(Outcome outcome) {
  constexpr std::array kWords{"passed",   "failed", "failed as expected", "passed unexpectedly",
                              "reported", "refused"};
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

Judgement judge(const Gate& gate, const Json& result) {
  Judgement judgement = refuse(gate, died(gate, result));
  const FoundQuantity found = find_quantity(result, gate.quantity);
  if (!judgement.why.empty()) {
    if (is_value(found)) judgement.value = *found.value;
    judgement.outcome = Outcome::failed;
    return judgement;
  }
  if (is_value(found)) {
    judgement.value = *found.value;
    judgement.factor = factor_of(gate, judgement.value);
    judgement.why = too_tight(gate, result);
    if (!judgement.why.empty()) return judgement;
  }
  judgement.why = fault(gate, result, found);
  const bool held = judgement.why.empty();
  judgement.outcome = outcome_of(gate.status, held);
  if (judgement.outcome == Outcome::passed_unexpectedly) {
    judgement.why = gate.published ? "agrees with the published number: remove differs"
                                   : "expected to fail, and holds: remove the entry, or make it active";
  }
  const bool no_number =
      gate.published && (!std::isfinite(judgement.factor) || !unfinished(gate, result).empty());
  if (judgement.outcome == Outcome::failed_as_expected && (is_unknown(found) || no_number)) {
    judgement.outcome = Outcome::failed;  // a misspelt quantity is not the failure that was expected
  }
  return judgement;
}

Gate bounded_by(Gate gate, const Json& other) {
  const FoundQuantity found = find_quantity(other, gate.quantity);
  std::string why = died(gate, other);
  if (why.empty()) why = is_value(found) ? unfinished(gate, other) : missing_text(gate, other, found);
  if (why.empty() && !(found.value->is_number() && std::abs(found.value->get<double>()) > 0.0)) {
    why = fmt::format("{} is {}", gate.quantity, found.value->dump());
  }
  if (!why.empty()) throw solver::InputError(gate.of.string(), why + "; allowed: a number that is not zero");
  const double number = found.value->get<double>();
  gate.below = number + gate.within * std::abs(number);
  gate.above = number - gate.within * std::abs(number);
  return gate;
}

Judgement refuse(const Gate& gate, const std::string& why) {
  Judgement judgement;
  judgement.gate = gate;
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

std::string bound_text(const Gate& gate) {
  if (gate.published)
    return fmt::format("the published {} ({})", gate.published->text, gate.published->source);
  if (!gate.of.empty()) {
    const std::string other =
        gate.below ? fmt::format("{:.7g}, that", 0.5 * (*gate.below + *gate.above)) : "that";
    return fmt::format("within {:g} of {} of {}", gate.within, other, gate.of.filename().string());
  }
  if (gate.equals.is_number()) return fmt::format("equal to {}", gate.equals.get<double>());
  if (!gate.equals.is_null()) return "equal to " + gate.equals.dump();
  if (gate.below && gate.above) return fmt::format("between {} and {}", *gate.above, *gate.below);
  if (gate.below) return fmt::format("below {} in size", *gate.below);
  return fmt::format("above {}", *gate.above);
}

std::string rerun_command(const Gate& gate) {
  return fmt::format(
      "slipstick gate {}{} --only {}", shell_word(gate.file.string()),
      gate.results_folder.empty() ? "" : " --results " + shell_word(gate.results_folder.string()),
      shell_word(gate.id));
}

}  // namespace slipstick::convergence
