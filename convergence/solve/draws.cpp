#include "convergence/solve/draws.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include "convergence/results/quantity.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

/// Percentages stand while outputs at one standard uncertainty are as near to the derivative's, over their
/// own.
constexpr double kLinear = 0.1;
/// Draws in all: exact ones take 0.2 ms each; others, on so many cells a side at most, some 10 ms.
constexpr std::size_t kExactDraws = 4096;
constexpr std::size_t kGridDraws = 256;
constexpr int kDrawCells = 64;
constexpr std::array<std::pair<const char*, double>, 3> kQuantiles{
    {{"5 %", 0.05}, {"50 %", 0.5}, {"95 %", 0.95}}};

/// Solves of a scene with other inputs, exact or on few cells.
struct DrawSolver {
  const std::vector<UncertainInput>& inputs;
  const SolveWith& solve;
  std::vector<std::string> overrides;
  Json centre;  ///< at the scene's own inputs
  bool exact;

  /// The result with each input so many standard uncertainties off; without an answer "message" says why.
  Json at(const std::vector<double>& off) const {
    std::vector<std::string> changed = overrides;
    for (std::size_t i = 0; i < inputs.size(); ++i) {
      const UncertainInput& input = inputs[i];
      changed.push_back(fmt::format("{}={:.16e}", input.key, input.value * (1 + off[i] * input.relative)));
    }
    try {
      return solve(changed);
    } catch (const solver::InputError& error) {
      return Json{{"message", error.what()}};
    }
  }
};

DrawSolver draw_solver(const Json& result, const std::vector<UncertainInput>& inputs,
                       const SolveWith& solve) {
  DrawSolver made{.inputs = inputs, .solve = solve, .overrides = {}, .centre = result, .exact = false};
  const auto takes = [&](std::vector<std::string> overrides) {
    made.overrides = std::move(overrides);
    Json centre = made.at(std::vector<double>(inputs.size(), 0.0));
    if (!converged(centre)) return false;
    made.centre = std::move(centre);
    return true;
  };
  const bool known = result.value("method", "") == "exact" ||
                     std::isfinite(number_at(result, "twist_angle_error")) ||
                     std::isfinite(number_at(result, "displacement_error"));
  made.exact = known && takes({"solver.model=\"exact\"", "contact.coupling=\"none\""});
  if (made.exact) return made;
  const double cells = std::fmax(number_at(result, "cells[0]"), number_at(result, "cells[1]"));
  const auto fewer = [&](const char* side) {
    return std::lround(number_at(result, side) * kDrawCells / cells);
  };
  if (cells > kDrawCells &&
      takes({fmt::format("grid.cells=[{},{}]", fewer("cells[0]"), fewer("cells[1]"))})) {
    return made;
  }
  made.overrides.clear();
  return made;
}

/// Whether the derivatives do: each input alone, at one standard uncertainty, and at three there are answers.
bool is_linear(const Json& outputs, const DrawSolver& solver) {
  for (std::size_t i = 0; i < solver.inputs.size(); ++i) {
    for (const double sign : {-1.0, 1.0}) {
      std::vector<double> off(solver.inputs.size(), 0.0);
      off[i] = 3 * sign;
      if (!converged(solver.at(off))) return false;
      off[i] = sign;
      const Json found = solver.at(off);
      for (const auto& [name, output] : outputs.items()) {
        const double centre = number_at(solver.centre, name);
        const double change = number_at(found, name) / centre - 1;
        const double part = sign * output["parts"][i]["part"].get<double>();
        const double standard = output["relative"].get<double>();
        if (standard > kVaries && !(std::abs(change - part) <= kLinear * standard)) return false;
      }
    }
  }
  return true;
}

/// So many standard uncertainties are the part below of a normal distribution.
double normal_quantile(double below) {
  double low = -9, high = 9;
  for (int halvings = 0; halvings < 60; ++halvings) {
    const double middle = (low + high) / 2;
    (std::erfc(-middle / std::numbers::sqrt2) / 2 < below ? low : high) = middle;
  }
  return low;
}

/// Evenly spread points of a cube (Roberts' sequence, 2018): parts below of each input, in each draw.
std::vector<double> deviates(std::size_t draw, std::size_t inputs) {
  double root = 2;  // of root^(inputs + 1) = root + 1
  for (int i = 0; i < 64; ++i) root = std::pow(1 + root, 1.0 / (static_cast<double>(inputs) + 1));
  std::vector<double> off;
  for (std::size_t i = 1; i <= inputs; ++i) {
    const double place = 0.5 + static_cast<double>(draw + 1) * std::pow(root, -static_cast<double>(i));
    off.push_back(normal_quantile(place - std::floor(place)));
  }
  return off;
}

bool slides(const Json& found) {
  const std::string why = found.value("message", "");
  return why.find("gross slip") != std::string::npos || why.find("slips everywhere") != std::string::npos ||
         number_at(found, "limit.factor") <= 1 + 1e-6;
}

double quantile(const std::vector<double>& sorted, double below) {
  const double place = below * static_cast<double>(sorted.size() - 1);
  const auto from = static_cast<std::size_t>(place);
  return std::lerp(sorted[from], sorted[std::min(from + 1, sorted.size() - 1)],
                   place - static_cast<double>(from));
}

/// Draws all inputs, and gives each output the quantiles of the draws that have an answer.
Json draw(const DrawSolver& solver, Json& outputs) {
  const std::size_t number = solver.exact ? kExactDraws : kGridDraws;
  std::size_t sliding = 0, failed = 0;
  std::string why;
  std::map<std::string, std::vector<double>> drawn;
  for (std::size_t i = 0; i < number; ++i) {
    const Json found = solver.at(deviates(i, solver.inputs.size()));
    if (converged(found)) {
      for (const auto& [name, output] : outputs.items()) {
        const double scale =
            solver.exact ? 1 : output["value"].get<double>() / number_at(solver.centre, name);
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
    for (const auto& [word, below] : kQuantiles) outputs[name]["quantiles"][word] = quantile(values, below);
  }
  const auto part = [&](std::size_t count) {
    return static_cast<double>(count) / static_cast<double>(number);
  };
  Json draws{
      {"number", number}, {"exact", solver.exact}, {"sliding", part(sliding)}, {"failed", part(failed)}};
  if (failed > 0) draws["failed_reason"] = why;
  return draws;
}

}  // namespace

bool converged(const Json& result) { return result.value("status", "") == "converged"; }

Json draw_inputs(const Json& result, const std::vector<UncertainInput>& inputs, const SolveWith& solve,
                 Json& outputs) {
  const DrawSolver solver = draw_solver(result, inputs, solve);
  return is_linear(outputs, solver) ? Json() : draw(solver, outputs);
}

std::string draws_text(const Json& draws) {
  const auto part = [&](const char* name) {
    return fmt::format("{:.1f} %", 100 * draws[name].get<double>());
  };
  std::string text = fmt::format("from 5 % to 95 % of {} draws{}", draws["number"].get<int>(),
                                 draws["exact"].get<bool>() ? ", solved exactly" : "");
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

}  // namespace slipstick::convergence
