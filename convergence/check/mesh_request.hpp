#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/check/examination.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Options that only the check of a field on a mesh has.
struct MeshOptions {
  std::optional<double> stick_slope = {};       ///< Pa/m, of the tangential penalty
  std::optional<double> normal_stiffness = {};  ///< Pa/m, of the normal penalty
  std::vector<double> held_at = {};  ///< radius in m at which the bodies are held, and a factor of its effect
  /// Choices of the reader, each "key=value": kind, units, body, axis, basis, centre, or the name of an array.
  std::vector<std::string> read_as = {};

  /// Whether one of them is given.
  bool any() const;
};

/// Whether a file holds a field on a mesh, not on a regular grid: any file but text, HDF5 and .vti; a table
/// of nodal forces or radii; or a table of points that lie on no regular grid.
bool is_mesh_file(const std::filesystem::path& file);

/// A field on a mesh, its scene and the exact answer after the scene's steps, if there is one: the request to
/// the package's module `meshes`, which judges it. overrides: those with which the scene was read. Throws
/// InputError for a scene without friction or with a map of friction. Of the options twist, strict and tolerance hold;
/// the latter stands for the errors that the mesh explains.
Json mesh_request(const solver::Scene& scene, const std::vector<std::string>& overrides,
                  const std::filesystem::path& file, const CheckOptions& options, const MeshOptions& mesh);

}  // namespace slipstick::convergence
