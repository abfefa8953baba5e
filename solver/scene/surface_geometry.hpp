#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "solver/grid/grid.hpp"
#include "solver/scene/surface.hpp"

namespace slipstick::solver {

/// Whether the heights have no level of their own: of height maps and of roughness.
bool is_measured(const Surface& surface);

/// The first height map among them; null if there is none.
const Surface* find_height_map(const std::vector<Surface>& surfaces);

/// The surfaces with the heights of their files. Throws InputError for a file that cannot be read or misses
/// points, with their place.
std::vector<Surface> with_heights(std::vector<Surface> surfaces);

/// The grid of the height maps that have been read, if there are any. Throws InputError where two disagree.
std::optional<Grid> height_map_grid(const std::vector<Surface>& surfaces);

/// Half the sides of a rectangle about the origin that the contact under a load W is expected to fill;
/// nothing where that is not known before solving: of sums, and of roughness.
std::optional<std::array<double, 2>> expected_half_sides(const std::vector<Surface>& surfaces,
                                                         Combine combine, double load,
                                                         double effective_modulus);

/// Half the sides of a rectangle about the origin beyond which the gap, its least value taken as 0, is
/// nowhere below a depth; infinite where that is not known: of roughness, of height maps.
std::array<double, 2> half_sides_below(const std::vector<Surface>& surfaces, Combine combine, double depth);

/// Whether Hertz's theory holds, up to where the contact stands and how it is turned: of one sphere or
/// ellipsoid.
bool is_hertzian(const std::vector<Surface>& surfaces);

/// Radii of curvature along x1 and x2 where Hertz's theory holds as it stands: of one sphere or ellipsoid at
/// the origin, its axes along the grid's.
std::optional<std::array<double, 2>> hertzian_radii(const std::vector<Surface>& surfaces);

/// The same surface in another unit of length, its numbers rounded as to_dimensionless does.
Surface to_dimensionless(Surface surface, double unit);

/// Undeformed gap at cell centres, infinite where the bodies cannot touch. With height maps and roughness,
/// whose level means nothing, the least gap is 0.
Eigen::ArrayXd gap_field(const std::vector<Surface>& surfaces, Combine combine, const Grid& grid);

}  // namespace slipstick::solver
