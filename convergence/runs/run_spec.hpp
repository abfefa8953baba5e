#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "convergence/oracle/oracle.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {

/// How floating-point results are rounded. A solve that is rounded upwards or downwards throughout differs
/// from the usual one by what rounding does to it, at its worst: all roundings lean to the same side.
enum class Rounding { nearest, upward, downward };

/// One solve that a study, a gate or the page asks for: a scene with some keys changed.
struct Point {
  std::filesystem::path scene;
  std::vector<std::string> overrides;  ///< "key=value", as --set takes them
  Rounding rounding = Rounding::nearest;
};

/// A whole file.
std::string read_text(const std::filesystem::path& file);

/// What else is done with the solution of the last step where it is computed.
using Look = std::function<void(Json&, const solver::Solution&, const OracleAnswer&)>;

/// The override that gives a grid so many cells along its longer side, in the shape of the scene's own.
std::string cells_override(const solver::Scene& scene, solver::Index across);

/// All that the answer depends on, the program apart: text of the scene and of the files that it reads,
/// overrides, rounding. Throws InputError for a scene that cannot be read.
std::string question(const Point& point);

/// A point for a person: "paper, grid.cells=[96,96], rounded downward".
std::string run_text(const Point& point);

/// Solves a point and compares it with the exact answer; of a history the last step, with the steps beside
/// it. What the scene asks for and cannot have, gross slip for one, is no exception but a result with status
/// = "refused" and a message. Throws InputError for a scene that cannot be read.
Json solve_point(const Point& point, const Look& look = {});

}  // namespace slipstick::convergence
