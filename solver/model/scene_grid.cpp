#include "solver/model/scene_grid.hpp"

#include <fmt/core.h>

#include <algorithm>

#include "solver/input/input_error.hpp"
#include "solver/scene/last_digits.hpp"
#include "solver/scene/surface_geometry.hpp"

namespace slipstick::solver {
namespace {

/// Cells left free on each side of the expected contact where the scene does not give an extent.
constexpr double kExtentMarginCells = 2.0;
/// Largest ratio of a cell's sides. Beyond it every method crawls.
constexpr double kMaxSlender = 1000.0;

/// Half the sides of a rectangle that lies in the contact for certain, before it is solved: the contact of a
/// single shape, or the lowest points of several shapes of which the nearest counts.
std::array<double, 2> least_half_sides(const Scene& scene, const std::vector<Surface>& surfaces,
                                       const std::optional<std::array<double, 2>>& expected) {
  const bool hertz = scene.contact.pressure == PressureModel::hertz ||
                     scene.contact.pressure == PressureModel::hertz_averaged;
  if (scene.ends_at_grid_edge && !hertz) return {};
  if (surfaces.size() == 1) return expected.value_or(std::array<double, 2>{});
  const bool pressed = scene.combine == Combine::nearest && scene.contact.pressure == PressureModel::solved;
  return pressed && expected ? half_sides_below(surfaces, Combine::nearest, 0.0) : std::array<double, 2>{};
}

/// Refuses extents that are too small for certain; require_contact_within_grid() refuses the others.
void require_extent(const Scene& scene, const std::vector<Surface>& surfaces,
                    const std::optional<std::array<double, 2>>& expected) {
  const auto least = least_half_sides(scene, surfaces, expected);
  const auto& extent = *scene.grid.extent;
  if (extent[0] > 2.0 * least[0] && extent[1] > 2.0 * least[1]) return;
  const bool one = surfaces.size() == 1;
  throw InputError(scene.source.string(), "grid.extent", fmt::format("[{}, {}]", extent[0], extent[1]),
                   fmt::format("larger than {}, about {:.4g} x {:.4g}, or left out",
                               one ? "the contact" : "the rectangle that the contacts of all shapes may fill",
                               2.0 * (*expected)[0], 2.0 * (*expected)[1]));
}

Grid require_not_slender(const Scene& scene, const Grid& grid) {
  const double slender = grid.h1 / grid.h2;
  if (slender <= kMaxSlender && slender >= 1.0 / kMaxSlender) return grid;
  throw InputError(scene.source.string(), "grid.cells", fmt::format("[{}, {}]", grid.n1, grid.n2),
                   fmt::format("cells at most {} times as long as wide; these are {:.4g} x {:.4g}",
                               kMaxSlender, grid.h1, grid.h2));
}

}  // namespace

std::optional<double> largest_normal(const Scene& scene) {
  std::optional<double> largest;
  for (const Step& step : scene.steps) {
    if (step.normal && !(largest >= step.normal)) largest = step.normal;
  }
  return largest;
}

Grid make_grid(const Scene& scene, const std::vector<Surface>& surfaces, double effective_modulus) {
  if (const auto grid = height_map_grid(surfaces)) {
    const std::array<Index, 2> samples{grid->n1, grid->n2};
    if (scene.grid.cells != std::array<Index, 2>{} && scene.grid.cells != samples) {
      throw InputError(scene.source.string(), "grid.cells",
                       fmt::format("[{}, {}]", scene.grid.cells[0], scene.grid.cells[1]),
                       fmt::format("[{}, {}], the samples in {}, or left out", samples[0], samples[1],
                                   find_height_map(surfaces)->map.file.string()));
    }
    return require_not_slender(scene, *grid);
  }
  const auto load = largest_normal(scene);
  // Where a layer is bonded to a body, the contact is not known, but a rectangle around it.
  const bool known = load && scene.layer.kind == nullptr && !(scene.grid.extent && is_coated(scene));
  const auto expected =
      known ? expected_half_sides(surfaces, scene.combine, *load, effective_modulus) : std::nullopt;
  if (!scene.grid.extent && !expected) {
    throw InputError(scene.source.string(), "grid.extent", "(missing)",
                     "[L1, L2] in m, since how far the contact reaches is not known before it is solved");
  }
  if (scene.grid.extent) require_extent(scene, surfaces, expected);
  std::array<double, 2> h{};
  for (std::size_t i = 0; i < 2; ++i) {
    const auto cells = static_cast<double>(scene.grid.cells[i]);
    const double margin = std::min(kExtentMarginCells, cells / 8.0);
    h[i] =
        scene.grid.extent ? (*scene.grid.extent)[i] / cells : 2.0 * (*expected)[i] / (cells - 2.0 * margin);
    if (scene.grid.extent && expected && surfaces.size() == 1 && scene.grid.cells[i] > 1 &&
        h[i] > 2.0 * (*expected)[i]) {
      throw InputError(
          scene.source.string(), "grid.extent",
          fmt::format("[{}, {}]", (*scene.grid.extent)[0], (*scene.grid.extent)[1]),
          fmt::format("at most {:.2g} times the contact, about {:.4g} x {:.4g}, which fills less than "
                      "one of [{}, {}] cells; or left out",
                      0.5 * cells, 2.0 * (*expected)[0], 2.0 * (*expected)[1], scene.grid.cells[0],
                      scene.grid.cells[1]));
    }
  }
  return require_not_slender(scene, {scene.grid.cells[0], scene.grid.cells[1], h[0], h[1]});
}

}  // namespace slipstick::solver
