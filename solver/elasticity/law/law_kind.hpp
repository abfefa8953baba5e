#pragma once

#include <span>
#include <string>
#include <vector>

#include "solver/elasticity/law/elastic_law.hpp"

namespace slipstick::solver {

/// A number that a law takes from a scene, zero or positive. Its unit is m^of_length Pa^of_stress.
struct LawParameter {
  std::string key;
  std::string unit;
  int of_length;
  int of_stress;
  std::string meaning;
};

/// A law of the table [layer] of a scene, for a layer between the half-spaces.
struct LawKind {
  std::string word;
  std::string meaning;
  std::vector<LawParameter> parameters;
  /// From the half-spaces' law and the parameters, in the same units.
  SharedLaw (*make)(const SharedLaw& bodies, std::span<const double> values);
};

/// All of them, in the order in which the reference has them.
const std::vector<LawKind>& law_kinds();

}  // namespace slipstick::solver
