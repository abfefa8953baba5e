#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/check/examination.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Whether a file holds stresses below the surface: a table that is text with a column x3 and a component,
/// s11, s22, s33, s12, s13 or s23.
bool is_stress_file(const std::filesystem::path& file, const std::vector<std::string>& columns);

/// Stresses at any points (x1, x2, and the depth x3, m) after the last step of a scene, and the right ones:
/// the request to the package's module `subsurface`, which judges them. The right ones are exact for torsion
/// of an axisymmetric contact; else those of the scene solved on its grid, in twice its parts of the steps
/// where these matter, with those on cells twice as large and in its own parts. They come in the parts by the
/// pressure and by the shear tractions, for Poisson's ratio 0 and for 1/2, in which both are linear. Throws
/// InputError for a file that cannot be read, points above the surface or where a stress is infinite, a scene
/// with a layer, and sums that are too long. Of the options columns, strict and tolerance hold; the latter,
/// 0.01 if it is not given, is of a component over the largest von Mises stress. read_as: body=lower or body=upper.
Json stress_request(const solver::Scene& scene, const std::filesystem::path& file, const CheckOptions& options,
                    const std::vector<std::string>& read_as);

}  // namespace slipstick::convergence
