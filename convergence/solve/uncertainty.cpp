#include "convergence/solve/uncertainty.hpp"

#include <fmt/ranges.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>
#include <utility>

#include "convergence/results/quantity.hpp"
#include "convergence/runs/failed_runs.hpp"
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
/// Relative steps of central differences, of exact answers and on a grid (see uncertainty_json()), and how
/// often a step is quartered where a neighbour has no answer.
constexpr double kExactStep = 1e-5;
constexpr double kGridStep = 2e-2;
constexpr int kSmallerSteps = 4;

/// An output is rounding where it is such a part of its companion: 1e-17 or so in the scenes of symmetry.
constexpr double kBesideCompanion = 1e-12;

/// Less of an output, relative, is rounding: the inputs do not change it.
constexpr double kVaries = 1e-9;

/// Percentages stand while outputs at one standard uncertainty are as near to the derivative's, over their
/// own.
constexpr double kLinear = 0.1;
/// Draws in all: exact ones take 0.1 ms each; others, on so many cells a side at most, some 10 ms.
constexpr std::size_t kExactDraws = 16384;
constexpr std::size_t kGridDraws = 1024;
constexpr int kFewCells = 64;
constexpr std::array<std::pair<const char*, double>, 3> kQuantiles{
    {{"5 %", 0.05}, {"50 %", 0.5}, {"95 %", 0.95}}};
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

/// Solves of a scene with other inputs.
struct Neighbours {
  const std::vector<UncertainInput>& inputs;
  const SolveWith& solve;
  std::vector<std::string> overrides;
  Json centre;  ///< at the scene's own inputs
  bool exact;

  /// The result with each input off by a part of itself; "message" says why there is no answer.
  Json at(const std::vector<double>& off) const {
    std::vector<std::string> changed = overrides;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      changed.push_back(fmt::format("{}={:.16e}", inputs[i].key, inputs[i].value * (1 + off[i])));
    }
    try {
      return solve(changed);
    } catch (const solver::InputError& error) {
      return Json{{"message", error.what()}};
    }
  }
  Json at(std::size_t input, double off) const {
    std::vector<double> all(inputs.size(), 0.0);
    all[input] = off;
    return at(all);
  }
};

/// Exact where the result knows the exact answer, else on few cells, and on the scene's own if those do not
/// do. One body's modulus alone makes materials dissimilar; what the pressure then moves is radial and enters
/// the torsion by its square, so that an exact answer, which does not know it, still has the derivative.
Neighbours neighbours(const Json& result, const std::vector<UncertainInput>& inputs, const SolveWith& solve) {
  Neighbours made{.inputs = inputs, .solve = solve, .overrides = {}, .centre = result, .exact = false};
  const auto takes = [&](std::vector<std::string> overrides) {
    made.overrides = std::move(overrides);
    made.centre = made.at(std::vector<double>(inputs.size(), 0.0));
    return is_converged(made.centre);
  };
  made.exact = result.value("method", "") == "exact" || std::isfinite(number_at(result, "twist_error")) ||
               std::isfinite(number_at(result, "displacement_error"));
  if (made.exact && takes({"solver.model=\"exact\"", "contact.coupling=\"none\""})) return made;
  made.exact = false;
  const double size[] = {number_at(result, "cells[0]"), number_at(result, "cells[1]")};
  const double larger = std::fmax(size[0], size[1]) / kFewCells;
  if (larger > 1 && takes({fmt::format("grid.cells=[{:.0f},{:.0f}]", size[0] / larger, size[1] / larger)})) {
    return made;
  }
  made.overrides.clear();
  made.centre = result;
  return made;
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

Pair pair_at(const Neighbours& near, std::size_t input) {
  double step = near.exact ? kExactStep : kGridStep;
  for (int smaller = 0; smaller <= kSmallerSteps; ++smaller, step /= 4) {
    Pair pair{.above = near.at(input, step), .below = near.at(input, -step), .step = step};
    if (is_converged(pair.above) && is_converged(pair.below)) return pair;
  }
  throw solver::InputError(fmt::format("--uncertain {}", near.inputs[input].key),
                           fmt::format("no solve within {:.2g} of its value converges; allowed: inputs "
                                       "whose neighbours can be solved",
                                       4 * step));
}

void set_numerical(Json& output, const Json& result, const std::string& name, bool exact) {
  const std::string whole = name.substr(0, name.find('['));
  double error = std::abs(number_at(result, (whole == "twist_angle" ? "twist" : whole) + "_error"));
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
  if (output["numerical"].is_null()) return "the error of mesh and steps is not known";
  const double numerical = output["numerical"].get<double>();
  const std::string size = "mesh and steps leave " + percent(numerical);
  if (numerical <= kNegligible * inputs) return size + ": refinement would not reduce the uncertainty";
  if (inputs <= kNegligible * numerical)
    return size + ": a finer mesh or shorter steps matter more than better inputs";
  return size + ": both matter";
}

/// Whether nothing but rounding is there: of a motion or moment beside another, and a limit without a moment.
bool is_rounding(const Json& result, std::string_view name, double value) {
  const double twist = std::abs(number_at(result, "twist_angle")) * number_at(result, "contact_radius");
  const double moment = std::abs(number_at(result, "moment")) / number_at(result, "moment_limit");
  const double displacement =
      std::hypot(number_at(result, "displacement[0]"), number_at(result, "displacement[1]"));
  if (name == "twist_angle") return twist <= kBesideCompanion * displacement;
  if (name.starts_with("displacement"))
    return std::abs(value) <= kBesideCompanion * std::fmax(displacement, twist);
  return name.starts_with("moment") && !(moment > kBesideCompanion);
}

/// Whether the derivatives do: each input alone, at one standard uncertainty, and at three there are answers.
bool is_linear(const Json& outputs, const Neighbours& near) {
  for (std::size_t i = 0; i < near.inputs.size(); ++i) {
    const double relative = near.inputs[i].relative;
    for (const double sign : {-1.0, 1.0}) {
      if (!is_converged(near.at(i, 3 * sign * relative))) return false;
      const Json found = near.at(i, sign * relative);
      for (const auto& [name, output] : outputs.items()) {
        const double centre = number_at(near.centre, name);
        const double change = number_at(found, name) / centre - 1;
        const double part = sign * output["parts"][i]["part"].get<double>();
        const double standard = output["relative"].get<double>();
        if (standard > kVaries && !(std::abs(change - part) <= kLinear * standard)) return false;
      }
    }
  }
  return true;
}

/// Off by such parts are the inputs in a draw: evenly spread points of a cube (Roberts' sequence, 2018), as
/// deviates of normal distributions.
std::vector<double> offsets(std::size_t draw, const std::vector<UncertainInput>& inputs) {
  double root = 2;  // of root^(inputs + 1) = root + 1
  for (int i = 0; i < 64; ++i) root = std::pow(1 + root, 1.0 / (static_cast<double>(inputs.size()) + 1));
  std::vector<double> off;
  double place = static_cast<double>(draw + 1);
  for (const UncertainInput& input : inputs) {
    place /= root;
    off.push_back(input.relative * gsl_cdf_ugaussian_Pinv(std::fmod(place + 0.5, 1.0)));
  }
  return off;
}

bool slides(const Json& found) {
  const std::string why = found.value("message", "");
  return why.find("gross slip") != std::string::npos || why.find("slips everywhere") != std::string::npos ||
         number_at(found, "limit.factor") <= 1 + 1e-6;
}

/// Draws all inputs, and gives each output the quantiles of the draws that have an answer.
Json draw(const Neighbours& near, Json& outputs) {
  const std::size_t number = near.exact ? kExactDraws : kGridDraws;
  std::size_t sliding = 0, failed = 0;
  std::string why;
  std::map<std::string, std::vector<double>> drawn;
  for (std::size_t i = 0; i < number; ++i) {
    const Json found = near.at(offsets(i, near.inputs));
    if (is_converged(found)) {
      for (const auto& [name, output] : outputs.items()) {
        const double scale = near.exact ? 1 : output["value"].get<double>() / number_at(near.centre, name);
        const double value = scale * number_at(found, name);
        if (std::isfinite(value)) drawn[name].push_back(value);
      }
    } else if (slides(found)) {
      ++sliding;
    } else {
      ++failed;
      why = found.value("message", "not converged");
    }
  }
  for (auto& [name, values] : drawn) {
    std::ranges::sort(values);
    for (const auto& [word, below] : kQuantiles) {
      outputs[name]["quantiles"][word] =
          gsl_stats_quantile_from_sorted_data(values.data(), 1, values.size(), below);
    }
  }
  const auto part = [&](std::size_t count) {
    return static_cast<double>(count) / static_cast<double>(number);
  };
  Json draws{{"number", number}, {"exact", near.exact}, {"sliding", part(sliding)}, {"failed", part(failed)}};
  if (failed > 0) draws["failed_reason"] = why;
  return draws;
}

/// A sentence on the twist, or on the first output that the inputs change.
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

std::string draws_text(const Json& draws) {
  const auto part = [&](const char* name) {
    return fmt::format("{:.1f} %", 100 * draws[name].get<double>());
  };
  std::string text =
      fmt::format("from 5 % to 95 % of {} draws{}", draws["number"].get<int>(),
                  draws["exact"].get<bool>() ? ", solved exactly" : " on at most 64 cells a side");
  if (draws["sliding"].get<double>() > 0) {
    text += fmt::format("; {} of the draws slide altogether: they have no answer and take no part",
                        part("sliding"));
  }
  if (draws["failed"].get<double>() > 0) {
    text += fmt::format("; {} have no other answer: {}", part("failed"),
                        draws["failed_reason"].get<std::string>());
  }
  return text_line("draws", text);
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
  const Neighbours near = neighbours(result, inputs, solve);
  std::vector<Pair> pairs;
  found["inputs"] = Json::array();
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    pairs.push_back(pair_at(near, i));
    found["inputs"].push_back({{"key", inputs[i].key},
                               {"value", inputs[i].value},
                               {"relative", inputs[i].relative},
                               {"step", pairs[i].step}});
  }
  Json outputs = Json::object();
  for (const auto& [name, words] : kOutputs) {
    const double value = number_at(result, name);
    if (std::isnan(value) || value == 0.0 || is_rounding(result, name, value)) continue;
    Json output{{"value", value}};
    double squares = 0;
    Json parts = Json::array();
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const double slope = pairs[i].slope(name, number_at(near.centre, name));
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
  if (!is_linear(outputs, near)) found["draws"] = draw(near, outputs);
  found["sentence"] = sentence(outputs, inputs, exact);
  found["outputs"] = std::move(outputs);
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
    const double relative = output["relative"].get<double>();
    std::string range = percent(relative > kVaries ? relative : 0) + " of " + short_text(output["value"]);
    if (output.contains("quantiles") && relative > kVaries) {
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
