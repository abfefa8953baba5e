#pragma once

#include <array>
#include <string>
#include <vector>

#include "solver/grid/grid.hpp"

namespace slipstick::bench {

/// The choices that a solve on a grid leaves open, in the words of scene files.
struct PlaneChoice {
  std::string method = "coulomb";
  std::string op = "dcfft";
  std::string model = "auto";
  std::string pressure = "solved";
  solver::Index cells = 128;  ///< along each side
  double tolerance = 1e-8;

  bool operator==(const PlaneChoice&) const = default;
};

/// A choice among words: its key in the plane and in scene files. Everything that goes through the choices
/// goes through this table.
struct ChoiceKey {
  const char* name;
  const char* scene_key;
  std::string PlaneChoice::*word;
};
inline constexpr std::array kChoiceKeys{
    ChoiceKey{"method", "solver.method", &PlaneChoice::method},
    ChoiceKey{"operator", "solver.operator", &PlaneChoice::op},
    ChoiceKey{"model", "solver.model", &PlaneChoice::model},
    ChoiceKey{"pressure", "contact.pressure", &PlaneChoice::pressure},
};

/// The words in the table's order, with a separator between them.
std::string choice_words(const PlaneChoice& choice, const char* separator);

/// As --set takes them, one thread.
std::vector<std::string> overrides(const PlaneChoice& choice);

/// Parts of the limit moment at which the paper's sphere is solved.
std::vector<double> plane_moment_ratios(bool quick);

/// The choices tried at one of them: mesh and tolerance in all combinations for each method, and around the
/// default each other choice on several meshes (at one moment ratio, or the design would take an hour). No
/// choice twice.
std::vector<PlaneChoice> plane_design(double moment_ratio, bool quick);

}  // namespace slipstick::bench
