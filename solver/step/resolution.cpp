#include "solver/step/resolution.hpp"

#include <numbers>

#include "solver/grid/sweep.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// The cells where a field is not zero.
struct Area {
  double cells = 0.0;
  double outline = 0.0;             ///< its length in sides of cells
  std::array<double, 2> sides{};    ///< of cells that look along x1, x2
  double mean = 0.0;                ///< of the field
  double edge = 0.0;                ///< of the field along the outline
  std::array<double, 2> at_edge{};  ///< means of at_edge(cell) along the outline
};

/// field(cell): its value there; at_edge(cell): further values, where a side of the cell looks outwards.
template <typename Field, typename AtEdge>
Area measure(const Grid& grid, const Field& field, const AtEdge& at_edge) {
  // Cells, sides that look along x1 and x2, the field; the field and at_edge by sides.
  using Sums = std::array<double, 7>;
  const auto [cells, sides1, sides2, mean, edge, edge1, edge2] =
      Sweep::whole(grid).sum<Sums>([&](Index first, Index last, Sums& sum) {
        const bool top = first < grid.n2;
        const bool bottom = last > grid.cells() - grid.n2;
        for (Index k = first; k < last; ++k) {
          const double value = field(k);
          if (value == 0.0) continue;
          const double along1 = (top || field(k - grid.n2) == 0.0) + (bottom || field(k + grid.n2) == 0.0);
          const double along2 = (k == first || field(k - 1) == 0.0) + (k + 1 == last || field(k + 1) == 0.0);
          sum[0] += 1.0;
          sum[3] += value;
          const double sides = along1 + along2;
          if (sides == 0.0) continue;
          const auto [at1, at2] = at_edge(k);
          sum += Sums{0.0, along1, along2, 0.0, sides * value, sides * at1, sides * at2};
        }
      });
  if (cells == 0.0) return {};
  // A staircase is longer than the curve that it follows, by 4/pi in the mean over all directions.
  const double outline = sides1 + sides2;
  return {cells,          std::numbers::pi / 4.0 * outline,  {sides1, sides2}, mean / cells,
          edge / outline, {edge1 / outline, edge2 / outline}};
}
template <typename Field>
Area measure(const Grid& grid, const Field& field) {
  return measure(grid, field, [](Index) { return std::array<double, 2>{}; });
}

/// The friction bound where the body would turn, over the contact's cells nearest to there; 0 where that is
/// outside the contact, or the body would not turn.
double bound_at_centre(const Grid& grid, const LoadStep& loads) {
  if (!loads.limit.centre) return 0.0;
  const auto cell = [](double x, double h, Index n) { return std::floor(x / h + 0.5 * static_cast<double>(n)); };
  const double i = cell((*loads.limit.centre)[0], grid.h1, grid.n1);
  const double j = cell((*loads.limit.centre)[1], grid.h2, grid.n2);
  const bool on_grid = i >= 0.0 && j >= 0.0 && i < static_cast<double>(grid.n1) && j < static_cast<double>(grid.n2);
  return on_grid ? loads.problem.friction_bound[static_cast<Index>(i) * grid.n2 + static_cast<Index>(j)] : 0.0;
}

/// The twist that a mesh leaves open where the stick area is small. limit_error: relative error of the mesh's
/// limit load; 0 where the load is a ratio of that limit.
double open_twist(const Grid& grid, const LoadStep& loads, double limit_error) {
  const double bound = bound_at_centre(grid, loads);
  if (!(bound > 0.0) || loads.limit.sliding.twist == 0.0) return 0.0;
  // The loads do unit work in the sliding motion: over its twist that is a moment, with all lever arms.
  const double moment = grid.cell_area() / std::abs(loads.limit.sliding.twist);
  const auto unresolved = [&](double missing) {
    constexpr double kPart = 0.5;  // set with MeshErrors: a mesh keeps a stick radius of about half a cell
    const double stick_radius = std::cbrt(9.0 * missing / (8.0 * bound));
    return 0.5 * std::log1p(kPart * grid.cell_area() / (stick_radius * stick_radius));
  };
  const double limit = loads.limit.factor * moment;
  if (!std::isfinite(limit)) return 0.0;
  const double missing = limit - moment;
  // Far from the limit its error changes nothing.
  const double of_limit = limit_error * limit < missing
                              ? (std::log1p(-limit_error) - std::log1p(-limit_error * limit / missing)) / 3.0
                              : std::numeric_limits<double>::infinity();
  return 0.5 * bound * (unresolved(missing) - unresolved(limit) + of_limit);
}

/// A pressure that is solved on the grid, or not. Set with kSharpEdge by exact answers of spheres, cones,
/// powers and punches.
struct MeshErrors {
  double smooth;  ///< everywhere, over the square of the cell's size over the contact's radius
  double beyond;  ///< cells at each side of the edge that the contact has too many
};
MeshErrors mesh_errors(PressureModel pressure) {
  if (pressure == PressureModel::hertz) return {.smooth = 1.2, .beyond = kCountedBySide};
  if (pressure == PressureModel::hertz_averaged) return {.smooth = 1.7, .beyond = kCutBySide};
  return {.smooth = 0.26, .beyond = 0.0};
}
/// Where the friction does not fall to zero at the edge, over the first power.
constexpr double kSharpEdge = 0.2;
/// Under another law than Coulomb's, whose sum over the cells no normal load fixes, where it has a kink, over
/// the power 1.5. Set by limit moments of spheres under capped and power laws on 32 to 200 cells.
constexpr double kKink = 0.35;
/// Relative error of a bonded punch's stiffness over the error of its area: it grows like the radius cubed on
/// half-spaces, like its fourth power on a thin layer, and no faster on a thicker one.
constexpr double kStiffnessByArea = 1.5;
constexpr double kStiffnessByAreaOnLayer = 2.0;
/// Cells across a slip ring within cells that stick, over the square of their traction over the bound:
/// towards the edge a bonded traction grows like K/(2 pi d)^(1/2), in the mean over a cell 2 K/(2 pi
/// h)^(1/2); a constant bound f holds a ring of pi/8 (K/f)^2 (Dugdale 1960), one that falls towards the edge
/// less. By exact answers under Tresca's law 0.50.
constexpr double kHiddenRing = std::numbers::pi * std::numbers::pi / 16.0;
/// Width of the stick area, in cells, from which on it adds no error of its own.
constexpr double kWideStick = 8.0;

/// Whether a cell sticks, and then the square of its traction over its bound; both 0 where it slips.
std::array<double, 2> sticking_at(const TangentialSolution& tangential, const ArrayXd& bound, Index cell) {
  if (!(tangential.stick[cell] > 0.0)) return {};
  const double q1 = tangential.traction[cell];
  const double q2 = tangential.traction[cell + bound.size()];
  return {1.0, (q1 * q1 + q2 * q2) / (bound[cell] * bound[cell])};
}

/// Relative error of a stick area, from the relative error of the cube of its radius.
double by_cubed_radius(double error) {
  const auto area = [](double cubed) { return std::cbrt(cubed * cubed); };
  return std::max(1.0 - area(std::max(0.0, 1.0 - error)), area(1.0 + error) - 1.0);
}

}  // namespace

Resolution resolution(const Scene& scene, const Step& step, const Grid& grid, const LoadStep& loads,
                      const TangentialSolution& tangential, const CountedArea& contact_area) {
  const ArrayXd& stick = tangential.stick;
  const ArrayXd& bound = loads.problem.friction_bound;
  const Area contact = measure(
      grid, [&](Index cell) { return bound[cell]; }, [&](Index cell) { return sticking_at(tangential, bound, cell); });
  if (contact.cells == 0.0) return {};
  const Area sticking = measure(grid, [&](Index cell) { return stick[cell]; });
  const Area slipping = measure(grid, [&](Index cell) { return bound[cell] > 0.0 && stick[cell] == 0.0 ? 1.0 : 0.0; });
  Resolution result;
  if (sticking.cells > 0.0) result.stick_width = 4.0 * sticking.cells / sticking.outline;
  if (slipping.cells > 0.0) result.slip_width = 2.0 * slipping.cells / slipping.outline;
  // Over the radius along x1 and x2, and both in the mean.
  const double cell1 = std::numbers::pi / 4.0 * contact.sides[0] / contact.cells;
  const double cell2 = std::numbers::pi / 4.0 * contact.sides[1] / contact.cells;
  const double cell = std::sqrt(0.5 * (cell1 * cell1 + cell2 * cell2));
  // 1 where the friction bound does not fall towards the edge, and soon little where it does.
  const double edge = std::pow(std::min(1.0, contact.edge / contact.mean), 3);
  const MeshErrors errors = mesh_errors(scene.contact.pressure);
  const double small = std::clamp(1.0 - result.stick_width / kWideStick, 0.0, 1.0);
  // Errors of the contact's area, and cells that counting adds to it under a pressure that is solved.
  const double by_area = is_bare(scene) ? kStiffnessByArea : kStiffnessByAreaOnLayer;
  const double of_area = by_area * contact_area.uncertainty / contact_area.counted;
  const double sides = contact.sides[0] + contact.sides[1];
  const double of_side = by_area * sides / contact.cells;
  const auto [stuck, used] = contact.at_edge;
  const double ring = slipping.cells / contact.outline;
  const double narrow = stuck + (1.0 - stuck) / (1.0 + std::pow(ring, 4));
  const bool is_coulomb = loads.is_coulomb;
  const double sharp = is_coulomb ? edge : 0.0;  // a wide slip ring hides the edge, except of a flat face
  result.step = (errors.smooth + small) * cell * cell + sharp * kSharpEdge * cell +
                std::max(narrow, sharp * sharp) * of_area + narrow * errors.beyond * of_side;
  const double kink = is_coulomb ? 0.0 : kKink * cell * std::sqrt(cell);
  const double beyond = is_coulomb ? 0.0 : edge * kCountedBySide;
  const double of_law = is_coulomb ? 0.0 : beyond * of_side + edge * of_area + kink;
  const bool is_ratio = std::holds_alternative<MomentRatio>(step.torsion) && !brings_translation(step);
  // A ratio of the mesh's own limit has the error of that area where it sticks, and a load where it slips.
  result.step += is_ratio ? narrow * (beyond * of_side + kink) : (1.0 - narrow) * of_law + narrow * kink;
  const double limit_error = is_ratio ? 0.0 : (0.6 * errors.smooth * cell + 0.15 * edge) * cell + of_law;
  if (slipping.cells > 0.0)
    result.stick_area = sticking.cells * (by_cubed_radius(limit_error / (loads.limit.factor - 1.0)) +
                                          (beyond + narrow * errors.beyond) * sides / contact.cells);
  result.stick_area += kHiddenRing * used * contact.outline;
  const RigidMotion& sliding = loads.limit.sliding;
  const bool mesh_decides = sticking.cells == 0.0 && std::isfinite(loads.limit.factor) && sliding.twist != 0.0;
  const double open = mesh_decides ? std::numeric_limits<double>::infinity() : open_twist(grid, loads, limit_error);
  if (!(open > 0.0)) return result;
  result.open.twist = open;
  result.open.displacement = open * std::hypot(sliding.delta1, sliding.delta2) / std::abs(sliding.twist);
  return result;
}

Resolution with_uncertainty(const Solution& solution, const Scene& scene, std::size_t step, const Quantities& mesh,
                            const Quantities& path) {
  Resolution resolution = solution.resolution;
  resolution.mesh = mesh;
  resolution.path = path;
  const auto is_zero = [](const TorsionLoad& torsion) {
    return std::visit([](const auto& load) { return load.value == 0.0; }, torsion);
  };
  const auto last = scene.steps.begin() + static_cast<std::ptrdiff_t>(std::min(step + 1, scene.steps.size()));
  const bool turned = !std::all_of(scene.steps.begin(), last, [&](const Step& at) { return is_zero(at.torsion); });
  const bool moved = std::any_of(scene.steps.begin(), last, brings_translation);
  const auto size = [](const std::array<double, 2>& pair) { return std::hypot(pair[0], pair[1]); };
  double value = 0.0;
  if (turned || !moved) {
    const bool imposed = std::holds_alternative<Twist>(solution.loads.torsion);
    resolution.number = imposed ? &Quantities::moment : &Quantities::twist;
    value = std::abs(imposed ? solution.moment : solution.twist_angle);
  } else {
    const bool imposed = solution.loads.displacement.has_value();
    resolution.number = imposed ? &Quantities::force : &Quantities::displacement;
    value = size(imposed ? solution.force : solution.displacement);
  }
  if (!turned && !moved) resolution.mesh = resolution.path = {};  // what moves is rounding
  resolution.absolute = resolution.mesh.*resolution.number + resolution.path.*resolution.number;
  resolution.uncertainty = resolution.absolute > 0.0 ? resolution.absolute / value : resolution.step;
  return resolution;
}

}  // namespace slipstick::solver
