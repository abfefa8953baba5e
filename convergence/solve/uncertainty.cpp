#include "convergence/solve/uncertainty.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>
#include <utility>

#include "convergence/results/quantity.hpp"
#include "convergence/solve/draws.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/toml_reader.hpp"

namespace slipstick::convergence {
namespace {

/// Names in results, and for a person.
constexpr std::array<std::pair<const char*, const char*>, 10> kOutputs{
    {{"twist_angle", "twist"},
     {"displacement[0]", "displacement along x1"},
     {"displacement[1]", "displacement along x2"},
     {"moment", "moment"},
     {"moment_limit", "moment limit"},
     {"stick_radius", "stick radius"},
     {"contact_radius", "contact radius"},
     {"peak_pressure", "peak pressure"},
     {"approach", "approach"},
     {"dissipated", "dissipated energy"}}};
constexpr double kExactStep = 1e-3;
constexpr double kGridStep = 2e-2;
constexpr int kSmallerSteps = 4;

/// An output is rounding where it is such a part of its companion: 1e-17 or so in the scenes of symmetry.
constexpr double kRounding = 1e-12;

constexpr double kNormalAt95 = 1.645;  ///< standard uncertainties from the median of a normal distribution
/// Added in squares, a third of the larger changes the sum by 5 %.
constexpr double kNegligible = 1.0 / 3;

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

/// All numbers of the scene that can be uncertain. Zeros have no relative uncertainty; seeds are drawn.
std::vector<UncertainInput> numbers_of(const std::filesystem::path& scene,
                                       const std::vector<std::string>& overrides) {
  solver::SceneReader reader(scene, overrides);
  std::vector<UncertainInput> numbers;
  for (const std::string table : {"upper", "lower", "contact", "load"}) {
    for (const std::string& assignment : reader.assignments(table)) {
      const std::size_t equals = assignment.find('=');
      const std::string name = assignment.substr(0, equals);
      const auto value = number_of(std::string_view(assignment).substr(equals + 1));
      if (!value || *value == 0.0 || name.ends_with("seed")) continue;
      numbers.push_back({.key = table + "." + name, .value = *value, .relative = 0});
    }
  }
  return numbers;
}

double percentage_of(const std::string& word, const std::string& text) {
  const bool percent = text.ends_with('%');
  const auto value = number_of(std::string_view(text).substr(0, text.size() - (percent ? 1 : 0)));
  if (!percent || !value || !(*value > 0 && *value < 100)) {
    throw solver::InputError("--uncertain " + word,
                             "allowed: key=P%, with P above 0 and below 100, as in friction=5%");
  }
  return *value / 100;
}

bool stands_for(const std::string& name, const std::string& key) {
  return key == name || key.ends_with("." + name);
}

/// The result where one input is off by a part of itself. One body's modulus alone makes materials
/// dissimilar; what the pressure then moves is radial and enters the torsion by its square, so that an exact
/// answer, which does not know it, still has the derivative.
Json solve_at(const UncertainInput& input, double off, bool exact, const SolveWith& solve) {
  std::vector<std::string> overrides{fmt::format("{}={:.16e}", input.key, input.value * (1 + off))};
  if (exact) overrides.emplace_back("contact.coupling=\"none\"");
  return solve(overrides);
}

/// Results at symmetric places around an input, for a difference.
struct Pair {
  Json above, below;
  double step;

  /// d ln output / d ln input where output has the value; NaN where it has none.
  double slope(const char* output, double value) const {
    return (number_at(above, output) - number_at(below, output)) / (2 * step * value);
  }
};

Pair pair_at(const UncertainInput& input, double step, bool exact, const SolveWith& solve) {
  for (int smaller = 0;; ++smaller, step /= 4) {
    const bool last = smaller == kSmallerSteps;
    try {
      Pair pair{.above = solve_at(input, step, exact, solve),
                .below = solve_at(input, -step, exact, solve),
                .step = step};
      if (converged(pair.above) && converged(pair.below)) return pair;
    } catch (const solver::InputError&) {
      if (last) throw;
    }
    if (last) {
      throw solver::InputError(fmt::format("--uncertain {}", input.key),
                               fmt::format("no solve within {:.2g} of its value converges; allowed: inputs "
                                           "whose neighbours can be solved",
                                           step));
    }
  }
}

/// What one input makes of all outputs: one pair of results, or two to extrapolate from.
struct Differences {
  std::vector<Pair> pairs;

  double slope(const char* output, double value) const {
    const double coarse = pairs.front().slope(output, value);
    return pairs.size() == 1 ? coarse : (4 * pairs.back().slope(output, value) - coarse) / 3;
  }
};

Differences differences(const UncertainInput& input, bool exact, const SolveWith& solve) {
  Differences found;
  found.pairs.push_back(pair_at(input, exact ? kExactStep : kGridStep, exact, solve));
  if (exact) found.pairs.push_back(pair_at(input, found.pairs.front().step / 2, exact, solve));
  return found;
}

void set_numerical(Json& output, const Json& result, const std::string& name, bool exact) {
  const std::string whole = name.substr(0, name.find('['));
  double error = std::abs(number_at(result, whole + "_error"));
  const FoundQuantity resolved = find_quantity(result, "resolved.number");
  if (std::isnan(error) && resolved.value != nullptr && *resolved.value == whole) {
    error = number_at(result, "resolved.uncertainty");
  }
  set_number(output, "numerical", error,
             exact ? "the exact answer has no mesh; it is within rounding"
                   : "neither an exact value nor an estimate is known");
}

std::string percent(double part) { return fmt::format("{:.2g} %", 100 * part); }

std::string verdict(double inputs, const Json& output, bool exact) {
  if (exact) return "the answer is exact: only better inputs tell more";
  if (output["numerical"].is_null()) return "the mesh's error is not known";
  const double mesh = output["numerical"].get<double>();
  const std::string size = "the mesh " + percent(mesh);
  if (mesh <= kNegligible * inputs) return size + ": a finer mesh tells nothing more";
  if (inputs <= kNegligible * mesh) return size + ": a finer mesh matters more than better inputs";
  return size + ": both matter";
}

/// Whether nothing but rounding is there: of a motion or moment beside another, and a limit without a moment.
bool is_rounding(const Json& result, std::string_view name, double value) {
  const double twist = std::abs(number_at(result, "twist_angle")) * number_at(result, "contact_radius");
  const double moment = std::abs(number_at(result, "moment")) / number_at(result, "moment_limit");
  const double displacement =
      std::hypot(number_at(result, "displacement[0]"), number_at(result, "displacement[1]"));
  if (name == "twist_angle") return twist <= kRounding * displacement;
  if (name.starts_with("displacement")) return std::abs(value) <= kRounding * std::fmax(displacement, twist);
  return name.starts_with("moment") && !(moment > kRounding);
}

/// Of the twist, or of the first output that the inputs change.
std::string sentence(const Json& outputs, const std::vector<UncertainInput>& inputs, bool exact) {
  for (const auto& [name, words] : kOutputs) {
    if (!outputs.contains(name)) continue;
    const Json& output = outputs[name];
    const double relative = output["relative"].get<double>();
    if (!(relative > kVaries)) continue;
    std::size_t largest = 0;
    const auto part = [&](std::size_t i) { return std::abs(output["parts"][i]["part"].get<double>()); };
    for (std::size_t i = 1; i < inputs.size(); ++i) {
      if (part(i) > part(largest)) largest = i;
    }
    const std::string all =
        inputs.size() == 1 ? "" : fmt::format(" (all inputs together {})", percent(relative));
    if (output.contains("quantiles")) {
      const Json& at = output["quantiles"];
      const double spread = at["95 %"].get<double>() - at["5 %"].get<double>();
      return fmt::format(
          "{}'s {} matters most for the {}; {}", inputs[largest].key, percent(inputs[largest].relative),
          words,
          verdict(spread / (2 * kNormalAt95 * std::abs(output["value"].get<double>())), output, exact));
    }
    return fmt::format("{}'s {} makes {} of the {}{}; {}", inputs[largest].key,
                       percent(inputs[largest].relative), percent(part(largest)), words, all,
                       verdict(relative, output, exact));
  }
  return "the inputs change none of the outputs";
}

}  // namespace

std::vector<UncertainInput> uncertain_inputs(const std::filesystem::path& scene,
                                             const std::vector<std::string>& overrides,
                                             const std::vector<std::string>& words) {
  std::vector<UncertainInput> inputs;
  const std::vector<UncertainInput> numbers = numbers_of(scene, overrides);
  for (const std::string& word : words) {
    const std::size_t equals = std::min(word.find('='), word.size());
    const std::string name = word.substr(0, equals);
    const double relative = percentage_of(word, word.substr(std::min(equals + 1, word.size())));
    bool known = false;
    for (UncertainInput number : numbers) {
      if (!stands_for(name, number.key)) continue;
      known = true;
      for (const UncertainInput& input : inputs) {
        if (input.key == number.key) {
          throw solver::InputError("--uncertain " + word, number.key + " is given twice; allowed: once");
        }
      }
      number.relative = relative;
      inputs.push_back(number);
    }
    if (known) continue;
    std::vector<std::string> allowed;
    for (const UncertainInput& number : numbers) allowed.push_back(number.key);
    throw solver::InputError(
        "--uncertain " + word,
        fmt::format("allowed: numbers of the scene that are not zero, {}", fmt::join(allowed, ", ")));
  }
  return inputs;
}

Json uncertainty_json(const Json& result, const std::vector<UncertainInput>& inputs, const SolveWith& solve) {
  const bool exact = result.value("method", "") == "exact";
  Json found;
  std::vector<Differences> made;
  found["inputs"] = Json::array();
  for (const UncertainInput& input : inputs) {
    made.push_back(differences(input, exact, solve));
    found["inputs"].push_back({{"key", input.key},
                               {"value", input.value},
                               {"relative", input.relative},
                               {"step", made.back().pairs.front().step}});
  }
  Json outputs = Json::object();
  for (const auto& [name, words] : kOutputs) {
    const double value = number_at(result, name);
    if (std::isnan(value) || value == 0.0 || is_rounding(result, name, value)) continue;
    Json output{{"value", value}};
    double squares = 0;
    Json parts = Json::array();
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const double slope = made[i].slope(name, value);
      const double part = slope * inputs[i].relative;
      squares += part * part;
      parts.push_back({{"key", inputs[i].key}, {"exponent", slope}, {"part", part}});
    }
    if (!std::isfinite(squares)) continue;
    output["standard"] = std::sqrt(squares) * std::abs(value);
    output["relative"] = std::sqrt(squares);
    set_numerical(output, result, name, exact);
    output["parts"] = std::move(parts);
    outputs[name] = std::move(output);
  }
  Json draws = draw_inputs(result, inputs, solve, outputs);
  found["sentence"] = sentence(outputs, inputs, exact);
  found["outputs"] = std::move(outputs);
  if (!draws.is_null()) found["draws"] = std::move(draws);
  return found;
}

std::string uncertainty_text(const Json& result) {
  const Json& found = result["uncertainty"];
  std::string text;
  for (const auto& [name, words] : kOutputs) {
    if (!found["outputs"].contains(name)) continue;
    const Json& output = found["outputs"][name];
    const std::string numerical = output["numerical"].is_null()
                                      ? ""
                                      : ", numerical error " + percent(output["numerical"].get<double>());
    std::string range = percent(output["relative"].get<double>()) + " of " + short_text(output["value"]);
    if (output.contains("quantiles") && output["relative"].get<double>() > kVaries) {
      const Json& at = output["quantiles"];
      range = fmt::format("{} to {}, median {}", short_text(at["5 %"]), short_text(at["95 %"]),
                          short_text(at["50 %"]));
    }
    text += text_line("uncertain", fmt::format("{} {}{}", words, range, numerical));
  }
  if (found.contains("draws")) text += draws_text(found["draws"]);
  return text + text_line("matters", found["sentence"].get<std::string>());
}

}  // namespace slipstick::convergence
