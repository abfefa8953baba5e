#include "convergence/solve/scene_file.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "solver/input/input_error.hpp"
#include "solver/input/toml_reader.hpp"

namespace slipstick::convergence {
namespace {

std::optional<double> number_of(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return {};
  return value;
}

/// All numbers of the scene that can be uncertain: neither zeros, which have no relative uncertainty, nor
/// seeds of random numbers.
std::vector<UncertainInput> numbers_of(const SceneFile& scene) {
  solver::SceneReader reader(scene.file, scene.overrides);
  std::vector<UncertainInput> numbers;
  for (const std::string table : {"upper", "lower", "contact", "load"}) {
    for (const std::string& assignment : reader.assignments(table)) {
      const std::size_t equals = assignment.find('=');
      const std::string name = assignment.substr(0, equals);
      std::string text = assignment.substr(equals + 1);
      std::erase_if(text, [](char c) { return c == '"' || c == '\''; });  // of a text such as "10 mm"
      const std::size_t blank = std::min(text.find(' '), text.size());
      const auto value = number_of(std::string_view(text).substr(0, blank));
      if (!value || *value == 0.0 || name.ends_with("seed")) continue;
      numbers.push_back({.key = table + "." + name, .value = *value, .unit = text.substr(blank), .relative = 0});
    }
  }
  return numbers;
}

double percentage_of(const std::string& word, const std::string& text) {
  const bool percent = text.ends_with('%');
  const auto value = number_of(std::string_view(text).substr(0, text.size() - (percent ? 1 : 0)));
  if (!percent || !value || !(*value > 0 && *value < 100)) {
    throw solver::InputError("--uncertain " + word, "allowed: key=P%, with P above 0 and below 100, as in friction=5%");
  }
  return *value / 100;
}

bool stands_for(const std::string& name, const std::string& key) { return key == name || key.ends_with("." + name); }

}  // namespace

std::vector<UncertainInput> uncertain_inputs(const SceneFile& scene, const std::vector<std::string>& words) {
  std::vector<UncertainInput> inputs;
  const std::vector<UncertainInput> numbers = numbers_of(scene);
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
    throw solver::InputError("--uncertain " + word, fmt::format("allowed: numbers of the scene that are not zero, {}",
                                                                fmt::join(allowed, ", ")));
  }
  return inputs;
}

}  // namespace slipstick::convergence
