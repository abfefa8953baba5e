#include "convergence/oracle/exact_shapes.hpp"

#include <fmt/core.h>

#include <limits>

namespace slipstick::convergence {

std::optional<ExactShape> exact_shape(const solver::Surface& surface) {
  using solver::Shape;
  switch (surface.shape) {
    case Shape::sphere:
      return ExactShape{"hertz", {surface.radius}, 2.0};
    case Shape::ellipsoid:
      if (is_elliptic(surface)) return std::nullopt;
      return ExactShape{"hertz", {surface.radius_1}, 2.0};
    case Shape::cone:
      return ExactShape{"cone", {surface.slope}, 1.0};
    case Shape::flat_punch:
      if (surface.inner_radius > 0.0) return std::nullopt;
      return ExactShape{"flat_punch", {surface.radius}, std::numeric_limits<double>::infinity()};
    case Shape::rounded_punch:
      return ExactShape{"rounded_punch", {surface.flat_radius, surface.corner_radius}, std::nullopt};
    case Shape::power:
      return ExactShape{fmt::format("power:{}", surface.exponent), {surface.coefficient}, surface.exponent};
    case Shape::height_map:
    case Shape::roughness:
      break;
  }
  return std::nullopt;
}

bool is_elliptic(const solver::Surface& surface) {
  return surface.shape == solver::Shape::ellipsoid && surface.radius_1 != surface.radius_2;
}

}  // namespace slipstick::convergence
