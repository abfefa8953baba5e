#include "convergence/solve/uncertainty.hpp"

#include <fmt/core.h>
#include <gsl/gsl_cdf.h>
#include <gsl/gsl_statistics_double.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string_view>

#include "convergence/results/exact_result.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/cache/solve_cache.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

/// A number of a result whose uncertainty is computed.
struct OutputNumber {
  const char* name;                   ///< path in the result
  const char* words;                  ///< name for a person
  double (*value)(const EndRecord&);  ///< NaN: missing
  Number ErrorsRecord::*error;        ///< against the exact answer; nullptr: none
};
const std::array<OutputNumber, 10> kOutputs{
    {{"twist_angle", "twist", [](const EndRecord& end) -> double { return end.loads.twist_angle; },
      &ErrorsRecord::twist},
     {"displacement[0]", "displacement along x1", [](const EndRecord& end) { return end.loads.displacement.values[0]; },
      &ErrorsRecord::displacement},
     {"displacement[1]", "displacement along x2", [](const EndRecord& end) { return end.loads.displacement.values[1]; },
      &ErrorsRecord::displacement},
     {"moment", "moment", [](const EndRecord& end) -> double { return end.loads.moment; }, &ErrorsRecord::moment},
     {"moment_limit", "moment limit", [](const EndRecord& end) -> double { return end.loads.moment_limit; },
      &ErrorsRecord::moment_limit},
     {"stick_radius", "stick radius", [](const EndRecord& end) -> double { return end.contact.stick_radius; },
      &ErrorsRecord::stick_radius},
     {"contact_radius", "contact radius", [](const EndRecord& end) -> double { return end.contact.contact_radius; },
      &ErrorsRecord::contact_radius},
     {"peak_pressure", "peak pressure", [](const EndRecord& end) -> double { return end.contact.peak_pressure; },
      &ErrorsRecord::peak_pressure},
     {"approach", "approach", [](const EndRecord& end) -> double { return end.contact.approach; }, nullptr},
     {"dissipated", "dissipated energy", [](const EndRecord& end) -> double { return end.energy.dissipated; },
      &ErrorsRecord::dissipated}}};

double value_of(const SolveRecord& record, std::string_view name) {
  return std::ranges::find(kOutputs, name, &OutputNumber::name)->value(record.end);
}

/// Relative steps of central differences, of exact answers and on a grid (see uncertainty_of()), and how
/// often a step is quartered where a neighbour has no answer.
constexpr double kExactStep = 1e-5;
constexpr double kGridStep = 2e-2;
constexpr int kSmallerSteps = 4;

/// Ratio of a motion or moment to its companion at which it is rounding: about 1e-17 in symmetric scenes.
constexpr double kRoundingRatio = 1e-12;

/// Relative uncertainty of an output at which it is rounding: the inputs do not change the output.
constexpr double kVaries = 1e-9;

/// The first-order uncertainty holds if a change of an input by its standard uncertainty changes each output
/// as the derivative predicts, within this part of the output's standard uncertainty.
constexpr double kLinear = 0.1;
/// Number of draws. An exact answer takes 0.1 ms; a grid has at most kFewCells cells a side and takes 10 ms.
constexpr std::size_t kExactDraws = 16384;
constexpr std::size_t kGridDraws = 1024;
constexpr int kFewCells = 64;
constexpr std::array<std::pair<const char*, double>, 3> kQuantiles{{{"5 %", 0.05}, {"50 %", 0.5}, {"95 %", 0.95}}};
constexpr double kNormalAt95 = 1.645;  ///< standard uncertainties from the median of a normal distribution
/// Added in squares, a third of the larger changes the sum by 5 %.
constexpr double kNegligible = 1.0 / 3;

/// Solves of a scene with other inputs.
struct Neighbours {
  const std::vector<UncertainInput>& inputs;
  const SceneFile& scene;
  SolveSceneOptions options;
  std::vector<std::string> overrides = {};
  SolveRecord centre = {};  ///< at the scene's own inputs
  bool exact = false;

  /// The answer with input i multiplied by 1 + off[i].
  SolveRecord at(const std::vector<double>& off) const {
    std::vector<std::string> changed = overrides;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      changed.push_back(fmt::format("{}={:.16e}{}", inputs[i].key, inputs[i].value * (1 + off[i]), inputs[i].unit));
    }
    try {
      const solver::Scene at = scene.read(changed);
      if (at.solver.model == solver::ModelChoice::exact) return exact_record(at, require_oracle(at), 0);
      return solve_scene(at, options).record;
    } catch (const solver::InputError& error) {
      return {.status = RunStatus::refused, .message = error.what()};
    }
  }
  SolveRecord at(std::size_t input, double off) const {
    std::vector<double> all(inputs.size(), 0.0);
    all[input] = off;
    return at(all);
  }
  /// Solves with these overrides from now on, if the scene's own inputs converge so.
  bool take(std::vector<std::string> changed) {
    overrides = std::move(changed);
    centre = at(std::vector<double>(inputs.size(), 0.0));
    return centre.is_converged();
  }
};

/// Chooses how neighbours are solved: exactly where the result has an exact answer; else on few cells; on the
/// scene's own cells if few do not converge. An uncertain modulus of one body makes materials dissimilar. The
/// radial motion that the pressure then causes enters the torsion by its square, so the exact answer without
/// that motion still has the right derivative.
Neighbours neighbours(const SolveRecord& result, const std::vector<UncertainInput>& inputs, const SceneFile& scene,
                      const SolveSceneOptions& options) {
  Neighbours made{.inputs = inputs, .scene = scene, .options = options};
  made.options.cache = std::make_shared<solver::SolveCache>();
  const ErrorsRecord& errors = result.end.errors;
  made.exact = result.is_exact() || std::isfinite(errors.twist) || std::isfinite(errors.displacement);
  if (made.exact && made.take({"solver.model=\"exact\"", "contact.coupling=\"none\""})) return made;
  made.exact = false;
  const auto [n1, n2] = result.problem.cells;
  const double size[] = {static_cast<double>(n1), static_cast<double>(n2)};
  const double larger = std::fmax(size[0], size[1]) / kFewCells;
  if (larger > 1 && made.take({fmt::format("grid.cells=[{:.0f},{:.0f}]", size[0] / larger, size[1] / larger)})) {
    return made;
  }
  made.overrides.clear();
  made.centre = result;
  return made;
}

/// Results at an input's value times 1 + step and 1 - step.
struct CentralDifference {
  SolveRecord above, below;
  double step;

  /// d ln output / d ln input; NaN where an output is missing. value: of the output.
  double slope(const std::string& output, double value) const {
    return (value_of(above, output) - value_of(below, output)) / (2 * step * value);
  }
};

CentralDifference difference_at(const Neighbours& near, std::size_t input) {
  double step = near.exact ? kExactStep : kGridStep;
  for (int smaller = 0; smaller <= kSmallerSteps; ++smaller, step /= 4) {
    CentralDifference made{.above = near.at(input, step), .below = near.at(input, -step), .step = step};
    if (made.above.is_converged() && made.below.is_converged()) return made;
  }
  throw solver::InputError(fmt::format("--uncertain {}", near.inputs[input].key),
                           fmt::format("no solve within {:.2g} of its value converges; allowed: inputs "
                                       "whose neighbours can be solved",
                                       4 * step));
}

/// Relative error of an output against the exact answer, or by mesh and steps; NaN: not known.
double numerical_error(const EndRecord& end, const OutputNumber& number) {
  const double error = number.error == nullptr ? NAN : std::abs(end.errors.*number.error);
  const std::string whole = std::string(number.name).substr(0, std::string_view(number.name).find('['));
  return std::isnan(error) && end.resolution.number == whole ? end.resolution.uncertainty.value : error;
}

std::string percent(double part) { return fmt::format("{:.2g} %", 100 * part); }

/// inputs: relative uncertainty of the output by its inputs.
std::string verdict(double inputs, double numerical, bool exact) {
  if (exact) return "the answer is exact: only better inputs reduce the uncertainty";
  if (!std::isfinite(numerical)) return "the error of mesh and steps is not known";
  const std::string size = "the error of mesh and steps is " + percent(numerical);
  if (numerical <= kNegligible * inputs) return size + ": refinement would not reduce the uncertainty";
  if (inputs <= kNegligible * numerical) return size + ": a finer mesh or shorter steps matter more than better inputs";
  return size + ": both matter";
}

/// Whether an output is only rounding next to its companion: the twist (times the contact radius) next to the
/// displacement, a displacement next to either, a moment next to its limit.
bool is_rounding(const EndRecord& end, std::string_view name, double value) {
  const double twist = std::abs(end.loads.twist_angle) * end.contact.contact_radius;
  const double moment = std::abs(end.loads.moment) / end.loads.moment_limit;
  const double displacement = end.loads.displacement.length();
  if (name == "twist_angle") return twist <= kRoundingRatio * displacement;
  if (name.starts_with("displacement")) return std::abs(value) <= kRoundingRatio * std::fmax(displacement, twist);
  return name.starts_with("moment") && !(moment > kRoundingRatio);
}

/// Whether the first-order uncertainty holds, see kLinear, and each input has answers at three standard
/// uncertainties on either side.
bool is_linear(const std::vector<UncertainOutput>& outputs, const Neighbours& near) {
  for (std::size_t i = 0; i < near.inputs.size(); ++i) {
    const double relative = near.inputs[i].relative;
    for (const double sign : {-1.0, 1.0}) {
      if (!near.at(i, 3 * sign * relative).is_converged()) return false;
      const SolveRecord found = near.at(i, sign * relative);
      for (const UncertainOutput& output : outputs) {
        const double change = value_of(found, output.name) / value_of(near.centre, output.name) - 1;
        const double part = sign * output.parts[i].part;
        if (output.relative > kVaries && !(std::abs(change - part) <= kLinear * output.relative)) return false;
      }
    }
  }
  return true;
}

/// Relative deviations of the inputs in a draw: points of Roberts' sequence (2018), which fills the unit cube
/// evenly, mapped to normal distributions.
std::vector<double> offsets(std::size_t draw, const std::vector<UncertainInput>& inputs) {
  double root = 2;  // solves root^(inputs + 1) = root + 1
  for (int i = 0; i < 64; ++i) root = std::pow(1 + root, 1.0 / (static_cast<double>(inputs.size()) + 1));
  std::vector<double> off;
  double place = static_cast<double>(draw + 1);
  for (const UncertainInput& input : inputs) {
    place /= root;
    off.push_back(input.relative * gsl_cdf_ugaussian_Pinv(std::fmod(place + 0.5, 1.0)));
  }
  return off;
}

bool slides(const SolveRecord& found) {
  const std::string& why = found.message;
  return why.find("gross slip") != std::string::npos || why.find("slips everywhere") != std::string::npos ||
         found.end.loads.limit.factor <= 1 + 1e-6;
}

/// Draws all inputs, and gives each output the quantiles of the draws that have an answer.
Draws draw(const Neighbours& near, std::vector<UncertainOutput>& outputs) {
  Draws draws{.number = near.exact ? kExactDraws : kGridDraws, .exact = near.exact};
  std::size_t sliding = 0, failed = 0;
  std::map<std::string, std::vector<double>> drawn;
  for (std::size_t i = 0; i < draws.number; ++i) {
    const SolveRecord found = near.at(offsets(i, near.inputs));
    if (found.is_converged()) {
      for (const UncertainOutput& output : outputs) {
        const double scale = near.exact ? 1 : output.value / value_of(near.centre, output.name);
        const double value = scale * value_of(found, output.name);
        if (std::isfinite(value)) drawn[output.name].push_back(value);
      }
    } else if (slides(found)) {
      ++sliding;
    } else {
      ++failed;
      draws.failed_reason = found.message.empty() ? "not converged" : found.message;
    }
  }
  for (UncertainOutput& output : outputs) {
    std::vector<double>& values = drawn[output.name];
    std::ranges::sort(values);
    for (const auto& [word, below] : kQuantiles) {
      if (values.empty()) continue;
      output.quantiles.emplace_back(word, gsl_stats_quantile_from_sorted_data(values.data(), 1, values.size(), below));
    }
  }
  draws.sliding = static_cast<double>(sliding) / static_cast<double>(draws.number);
  draws.failed = static_cast<double>(failed) / static_cast<double>(draws.number);
  return draws;
}

/// A sentence on the twist, or on the first output that the inputs change.
std::string sentence(const std::vector<UncertainOutput>& outputs, const std::vector<UncertainInput>& inputs,
                     bool exact) {
  const auto varies = [](const UncertainOutput& output) { return output.relative > kVaries; };
  const auto output = std::ranges::find_if(outputs, varies);
  if (output == outputs.end()) return "the inputs change none of the outputs";
  const auto size = [](const UncertainPart& part) { return std::abs(part.part); };
  const auto largest = std::ranges::max_element(output->parts, {}, size);
  const UncertainInput& input = inputs[static_cast<std::size_t>(largest - output->parts.begin())];
  if (!output->quantiles.empty()) {
    const double spread = output->quantiles.back().second - output->quantiles.front().second;
    const double relative = spread / (2 * kNormalAt95 * std::abs(output->value));
    return fmt::format("{}'s {} matters most for the {}; {}", input.key, percent(input.relative), output->words,
                       verdict(relative, output->numerical, exact));
  }
  const std::string all = inputs.size() == 1 ? "" : fmt::format(" (all inputs together {})", percent(output->relative));
  return fmt::format("{}'s {} makes {} of the {}{}; {}", input.key, percent(input.relative), percent(size(*largest)),
                     output->words, all, verdict(output->relative, output->numerical, exact));
}

std::string draws_text(const Draws& draws) {
  std::string text = fmt::format("from 5 % to 95 % of {} draws{}", draws.number,
                                 draws.exact ? ", solved exactly" : " on at most 64 cells a side");
  if (draws.sliding > 0) {
    text += fmt::format("; {:.1f} % of the draws slide altogether: they have no answer and are left out",
                        100 * draws.sliding);
  }
  if (draws.failed > 0) {
    text += fmt::format("; {:.1f} % fail for other reasons: {}", 100 * draws.failed, draws.failed_reason);
  }
  return text_line("draws", text);
}

}  // namespace

void to_json(Json& json, const UncertainPart& part) {
  json = {{"key", part.key}, {"exponent", part.exponent}, {"part", part.part}};
}

namespace {

Json output_json(const UncertainOutput& output, bool exact) {
  Json json{{"value", output.value}, {"standard", output.standard}, {"relative", output.relative}};
  set_number(json, "numerical", output.numerical,
             exact ? "the exact answer has no mesh; it is within rounding"
                   : "neither an exact value nor an estimate is known");
  json.emplace("parts", output.parts);
  Json quantiles;
  for (const auto& [word, value] : output.quantiles) quantiles[word] = value;
  if (!quantiles.empty()) json.emplace("quantiles", std::move(quantiles));
  return json;
}

}  // namespace

Uncertainty uncertainty_of(const SolveRecord& result, const std::vector<UncertainInput>& inputs, const SceneFile& scene,
                           const SolveSceneOptions& options) {
  Uncertainty found{.exact = result.is_exact(), .inputs = inputs};
  const Neighbours near = neighbours(result, inputs, scene, options);
  std::vector<CentralDifference> differences;
  for (std::size_t i = 0; i < inputs.size(); ++i) {
    differences.push_back(difference_at(near, i));
    found.steps.push_back(differences[i].step);
  }
  for (const OutputNumber& number : kOutputs) {
    const double value = number.value(result.end);
    if (std::isnan(value) || value == 0.0 || is_rounding(result.end, number.name, value)) continue;
    UncertainOutput output{
        .name = number.name, .words = number.words, .value = value, .numerical = numerical_error(result.end, number)};
    double squares = 0;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const double slope = differences[i].slope(number.name, number.value(near.centre.end));
      const double part = slope * inputs[i].relative;
      squares += part * part;
      output.parts.push_back({inputs[i].key, slope, part});
    }
    if (!std::isfinite(squares)) continue;
    output.relative = std::sqrt(squares);
    output.standard = std::sqrt(squares) * std::abs(value);
    found.outputs.push_back(std::move(output));
  }
  if (!is_linear(found.outputs, near)) found.draws = draw(near, found.outputs);
  found.sentence = sentence(found.outputs, inputs, found.exact);
  return found;
}

Json to_json(const Uncertainty& uncertainty) {
  Json inputs = Json::array();
  for (std::size_t i = 0; i < uncertainty.inputs.size(); ++i) {
    const UncertainInput& input = uncertainty.inputs[i];
    inputs.push_back(
        {{"key", input.key}, {"value", input.value}, {"relative", input.relative}, {"step", uncertainty.steps[i]}});
  }
  Json json{{"inputs", std::move(inputs)}};
  if (uncertainty.draws) {
    const Draws& draws = *uncertainty.draws;
    Json drawn{{"number", draws.number}, {"exact", draws.exact}, {"sliding", draws.sliding}, {"failed", draws.failed}};
    if (draws.failed > 0) drawn.emplace("failed_reason", draws.failed_reason);
    json.emplace("draws", std::move(drawn));
  }
  Json outputs = Json::object();
  for (const UncertainOutput& output : uncertainty.outputs) {
    outputs[output.name] = output_json(output, uncertainty.exact);
  }
  json.update({{"sentence", uncertainty.sentence}, {"outputs", std::move(outputs)}});
  return json;
}

std::string uncertainty_text(const Uncertainty& uncertainty) {
  std::string text;
  for (const UncertainOutput& output : uncertainty.outputs) {
    const std::string numerical =
        !std::isfinite(output.numerical) ? "" : ", numerical error " + percent(output.numerical);
    const bool varies = output.relative > kVaries;
    std::string range = percent(varies ? output.relative : 0) + " of " + short_text(output.value);
    if (!output.quantiles.empty() && varies) {
      range = fmt::format("{} to {}, median {}", short_text(output.quantiles[0].second),
                          short_text(output.quantiles[2].second), short_text(output.quantiles[1].second));
    }
    text += text_line("uncertain", fmt::format("{} {}{}", output.words, range, numerical));
  }
  if (uncertainty.draws) text += draws_text(*uncertainty.draws);
  return text + text_line("matters", uncertainty.sentence);
}

}  // namespace slipstick::convergence
