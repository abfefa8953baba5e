#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Options of the check of a field on a mesh.
struct MeshOptions {
  std::optional<double> twist = {};             ///< rad, that the program reported
  std::optional<double> tolerance = {};         ///< relative, instead of the errors that the mesh explains
  bool strict = false;                          ///< a good field is in the scene's units and signs, too
  std::optional<double> stick_slope = {};       ///< Pa/m, of the tangential penalty
  std::optional<double> normal_stiffness = {};  ///< Pa/m, of the normal penalty
  std::vector<double> held_at = {};  ///< radius in m at which the bodies are held, and a factor of its effect
  /// Choices of the reader, each "key=value": kind, units, body, axis, basis, centre, or the name of an array.
  std::vector<std::string> read_as = {};

  /// Whether one of the options that only a field on a mesh has is given.
  bool any() const;
};

/// Whether a file holds a field on a mesh, not on a regular grid: any file but text, HDF5 and .vti; a table
/// of nodal forces or radii; or a table of points that lie on no regular grid.
bool is_mesh_file(const std::filesystem::path& file);

/// A field on a mesh, its scene and the exact answer after the scene's steps, if there is one: the request to
/// the package's module `meshes`, which judges it. overrides: those with which the scene was read. Throws
/// InputError for a scene without friction or with a map of friction.
Json mesh_request(const solver::Scene& scene, const std::vector<std::string>& overrides,
                  const std::filesystem::path& file, const MeshOptions& options);

}  // namespace slipstick::convergence
