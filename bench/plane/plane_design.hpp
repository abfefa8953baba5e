#pragma once

#include <string>
#include <vector>

#include "solver/grid/grid.hpp"

namespace slipstick::bench {

/// What a solve on a grid leaves to choose, in the words of scene files.
struct PlaneChoice {
  std::string method = "coulomb";
  std::string op = "dcfft";
  std::string model = "auto";
  std::string pressure = "solved";
  solver::Index cells = 128;  ///< along each side
  double tolerance = 1e-8;

  bool operator==(const PlaneChoice&) const = default;
};

/// As --set takes them, one thread.
std::vector<std::string> overrides(const PlaneChoice& choice);

/// Parts of the limit moment at which the paper's sphere is solved.
std::vector<double> plane_moment_ratios(bool quick);

/// What is tried at one of them: mesh and tolerance in all combinations for each method, and around the
/// default each other choice on several meshes (at one moment ratio, or the design would take an hour). No
/// choice twice.
std::vector<PlaneChoice> plane_design(double moment_ratio, bool quick);

}  // namespace slipstick::bench
