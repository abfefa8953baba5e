#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Options of a check. A good field is right within its mesh, and more if the options ask for it.
struct CheckOptions {
  std::optional<double> twist = {};       ///< rad, that the program reported
  std::vector<std::string> columns = {};  ///< names for a file without a header, or paths in an HDF5 file
  bool discrete = false;                  ///< a good field solves its own grid's problem, with constant cells
  bool strict = false;                    ///< a good field is in the scene's conventions
  bool pressure_given = false;            ///< the pressure is not judged
  /// Error allowed for loads, pressure, motion and tractions, instead of the one derived from the mesh.
  std::optional<double> tolerance = {};
};

/// Judges a traction field that any program computed for a scene, by Coulomb's law and against the exact
/// solution where one exists. Without a twist, the scene's is taken if it imposes one, otherwise the one that
/// fits Coulomb's law best. The result has SI units; result["verdict"] is good or bad, result["why"] a
/// sentence. Throws InputError for a field or a scene that cannot be judged.
Json check_field(const solver::Scene& scene, const std::filesystem::path& file,
                 const CheckOptions& options = {});

/// The result in a few lines of text.
std::string check_text(const Json& result);

}  // namespace slipstick::convergence
