#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// What a field has to be called good, beside being right within its mesh.
struct CheckOptions {
  std::optional<double> twist = {};       ///< rad, that the program reported
  std::vector<std::string> columns = {};  ///< of a file without a header, or paths in one of HDF5
  bool discrete = false;                  ///< it has to solve its own grid's problem, of constant cells, too
  bool strict = false;                    ///< it has to be in the scene's conventions
  bool pressure_given = false;            ///< its pressure is not judged
  std::optional<double> tolerance =
      {};  ///< on loads, pressure, motion and tractions, in place of what the mesh leaves open
};

/// Judges a traction field that any program computed for a scene: against the exact solution where there is
/// one, by Coulomb's law always. Without a twist the scene's is taken, if it imposes one, or the one that
/// Coulomb's law fits best. The result has SI units; result["verdict"] is good or bad, result["why"] one
/// sentence. Throws InputError for a field or a scene that cannot be judged.
Json check_field(const solver::Scene& scene, const std::filesystem::path& file,
                 const CheckOptions& options = {});

/// The same for a person: a few lines.
std::string check_text(const Json& result);

}  // namespace slipstick::convergence
