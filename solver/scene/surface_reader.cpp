#include "solver/scene/surface_reader.hpp"

#include <fmt/core.h>

#include <cmath>
#include <cstdint>

#include "solver/scene/scene_keys.hpp"
#include "solver/scene/validate.hpp"

namespace slipstick::solver {
namespace {

Roughness read_roughness(SceneReader& reader, const std::string& table) {
  Roughness roughness;
  roughness.seed = static_cast<std::uint64_t>(reader.number(table + ".seed"));
  roughness.hurst = reader.number(table + ".hurst");
  roughness.rms_slope = reader.number(table + ".rms_slope");
  const double longest = reader.number(table + ".longest");
  roughness.longest = longest;
  roughness.period = reader.number_or(table + ".period", 4.0 * longest, period_for(longest));
  roughness.shortest = reader.number(table + ".shortest", shortest_for(longest, roughness.period));
  return roughness;
}

/// Parameters of a shape that has an axis.
void read_body(SceneReader& reader, const std::string& table, Surface& surface) {
  const auto parameter = [&](const char* key) { return reader.number(table + key); };
  switch (surface.shape) {
    case Shape::sphere:
      surface.radius = parameter(".radius");
      break;
    case Shape::flat_punch: {
      const double radius = surface.radius = parameter(".radius");
      surface.inner_radius =
          reader.number_or(table + ".inner_radius", surface.inner_radius, inner_radius_below(radius));
      break;
    }
    case Shape::ellipsoid:
      surface.radius_1 = parameter(".radius_1");
      surface.radius_2 = parameter(".radius_2");
      break;
    case Shape::cone:
      surface.slope = parameter(".slope");
      break;
    case Shape::rounded_punch:
      surface.flat_radius = parameter(".flat_radius");
      surface.corner_radius = parameter(".corner_radius");
      break;
    case Shape::power:
      surface.exponent = reader.number(table + ".exponent");
      surface.coefficient = parameter(".coefficient");
      break;
    case Shape::height_map:
    case Shape::roughness:
      throw std::logic_error("a surface without an axis");
  }
  surface.at = reader.find_pair(table + ".at").value_or(surface.at);
  surface.angle = reader.number_or(table + ".angle", surface.angle);
}

Surface read_surface(SceneReader& reader, const std::string& table) {
  Surface surface;
  surface.shape = reader.choice(table + ".shape", kShapes);
  if (surface.shape == Shape::height_map) {
    surface.file = reader.path(table + ".file");
    surface.spacing = reader.pair(table + ".spacing");
    surface.height_unit = reader.choice_or(table + ".unit", surface.height_unit, kHeightUnits);
  } else if (surface.shape == Shape::roughness) {
    surface.roughness = read_roughness(reader, table);
  } else {
    read_body(reader, table, surface);
  }
  return surface;
}

}  // namespace

std::string to_string(Shape shape) { return word_of(kShapes, shape); }

std::vector<Surface> read_surfaces(SceneReader& reader) {
  if (!reader.is_array("upper.shape")) return {read_surface(reader, "upper")};
  std::vector<Surface> surfaces;
  const std::size_t count = reader.count("upper.shape");
  if (count > kMaxShapes) {
    reader.fail("upper.shape", fmt::format("{} tables", count), fmt::format("at most {}", kMaxShapes));
  }
  for (std::size_t i = 0; i < count; ++i) {
    surfaces.push_back(read_surface(reader, fmt::format("upper.shape[{}]", i)));
  }
  return surfaces;
}

Combine read_combine(SceneReader& reader) {
  return reader.choice_or("upper.combine", Combine::sum, kCombinations);
}

}  // namespace slipstick::solver
