#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/check/loops/loop_contact.hpp"
#include "convergence/check/loops/loop_judgement.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Options of the check of a loop. A good loop follows the exact law.
struct LoopOptions {
  double tolerance;     ///< root mean square of the load's error, over the largest load
  bool strict = false;  ///< a good loop is in the scene's units and signs, too
};

/// A loop under one normal load, in the contact's units, and its judgement.
struct LoopUnderLoad {
  LoopContact contact;
  LoopPath path;
  LoopJudgement judgement = {};
};

/// A loop that was checked.
struct LoopCheck {
  std::string name;  ///< of the scene
  std::filesystem::path file;
  bool of_force;
  double tolerance;
  std::vector<std::string> conventions;  ///< units and signs that differ from the scene's
  std::optional<LoopNumber>
      load_exponent;  ///< d ln(limit)/d ln(normal load), of several loops that all slide
  bool good;
  std::string why;  ///< one sentence
  std::vector<LoopUnderLoad> loads;
};

/// Judges a loop of moment against rotation, or of force against displacement, that any program computed for
/// a scene. The normal loads are the file's, otherwise the scene's. Throws InputError for a loop that cannot
/// be read, and for a scene whose torsion has no exact law.
LoopCheck check_loop(const solver::Scene& scene, const std::filesystem::path& file,
                     const LoopOptions& options);

/// The result in SI units.
Json to_json(const LoopCheck& check);

/// The result in a few lines of text.
std::string loop_text(const LoopCheck& check);

// ---------------------------------------------------------------- its file (loop_record.cpp)

/// Moment and rotation, or tangential force and displacement, row by row in the units of the program that
/// wrote them.
struct LoopRecord {
  std::filesystem::path file;
  bool of_force;
  std::vector<double> time;  ///< empty: not given
  std::vector<double> load;
  std::vector<double> motion;
  std::vector<double> normal_load;  ///< empty: not given
};

/// Whether a file holds a loop, not a field: JSON, or a CSV table without a column x1 but with columns of
/// moments and rotations, or of forces and displacements.
bool is_loop_file(const std::filesystem::path& file);

/// Reads a CSV table, or JSON lists of the same names: moment (torque) and rotation (twist, angle,
/// twist_angle), or force (tangential_force) and displacement; optional are time and normal_load. Throws
/// InputError for a file that cannot be read, a missing column or list, lists of different lengths, a value
/// that is no finite number, times that do not increase, fewer than kMinLoopRows rows, and a loop without
/// motion or load.
LoopRecord read_loop(const std::filesystem::path& file);

/// Rows of a loop: fewer do not show its noise.
inline constexpr std::size_t kMinLoopRows = 20;

}  // namespace slipstick::convergence
