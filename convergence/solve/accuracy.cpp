#include "convergence/solve/accuracy.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "convergence/orders/expected_order.hpp"
#include "convergence/orders/limit.hpp"
#include "convergence/results/exact_result.hpp"
#include "convergence/solve/plan.hpp"
#include "solver/grid/grid_transfer.hpp"
#include "solver/model/make_model.hpp"
#include "solver/scene/surface_geometry.hpp"
#include "solver/solve.hpp"
#include "solver/step/pressure.hpp"

namespace slipstick::convergence {
namespace {

using solver::Index;
using solver::InputError;
using solver::Scene;
using solver::Solution;

/// A mesh is refined by the factor that the reached error suggests times the margin, since errors scatter; at
/// most by kMaxRefinement at once, since an error on a coarse mesh predicts little.
constexpr double kRefinementMargin = 1.1;
constexpr double kMaxRefinement = 4.0;
/// A grid without a given extent has this many cells outside the expected contact, on both sides together, if
/// it has at least kMinGridCells.
constexpr double kFreeCells = 4.0;
constexpr Index kMinGridCells = 16;
/// Least number of cells across the contact on the coarse grid: with fewer, the extent is so large that the
/// next grids would be huge, and the size of the contact is unknown.
constexpr double kMinContactCells = 3.0;
/// Cells across the contact that the message recommends.
constexpr double kWellAcross = 0.5 * static_cast<double>(kReferenceCells);

/// The key whose file fixes the grid; null: the grid is free.
const char* grid_owner(const Scene& scene) {
  if (solver::find_height_map(scene.surfaces) != nullptr) return "upper.file";
  if (!scene.contact.friction.map.empty()) return "contact.friction_map";
  return scene.contact.pressure == solver::PressureModel::file ? "contact.pressure_file" : nullptr;
}

bool brings_torsion(const solver::TorsionLoad& load) {
  return std::holds_alternative<solver::Twist>(load) ||
         std::visit([](const auto& kind) { return kind.value != 0.0; }, load);
}

/// Throws InputError if the contact fills too few cells of a free grid.
void require_contact_seen(const Scene& scene, double pressed, double cells_across) {
  if (cells_across >= kMinContactCells) return;
  throw InputError(
      scene.source.string(), "grid.extent",
      scene.grid.extent ? solver::Units(scene.units).pair_text("m", *scene.grid.extent) : "(missing)",
      fmt::format("at most about {:.2g} times as long and wide, {}: of {} cells along its longer side the contact "
                  "fills {} in all, too few to choose a mesh by",
                  cells_across / kWellAcross, scene.grid.extent ? "or left out" : "given", kReferenceCells, pressed));
}

Index longer_side(const Scene& scene) { return std::max(scene.grid.cells[0], scene.grid.cells[1]); }

bool fits_in_memory(const Scene& scene) {
  try {
    solver::make_model(scene);
    return true;
  } catch (const InputError&) {
    return false;
  }
}

/// The error for which the mesh is chosen.
double mesh_error(const AccuracyTarget& target, bool estimated) {
  return estimated ? target.of_mesh() / estimation_safety(target.of) : target.of_mesh();
}

/// Safety factors (Roache 1998) of a number from two meshes, and of a norm of differences.
constexpr double kTwoMeshes = 3.0;
constexpr double kOfNorm = 1.25;
/// Order of convergence where theory gives none, as on rough surfaces.
constexpr double kCautiousOrder = 1.0;

double order_of(const AccuracyQuantity& quantity, const Scene& scene) {
  const double order = expected_order(quantity.path, scene).value;
  return std::isfinite(order) ? order : kCautiousOrder;
}

/// The same rectangle with half as many cells along each side.
Scene half_as_fine(const Scene& scene, const solver::Grid& grid) {
  Scene coarse = scene;
  const solver::Grid half = solver::coarser(grid);
  coarse.grid.cells = {half.n1, half.n2};
  coarse.grid.extent = {grid.h1 * static_cast<double>(grid.n1), grid.h2 * static_cast<double>(grid.n2)};
  return coarse;
}

/// The measured error of smooth contacts on such a mesh. Two meshes may agree by chance, since the error of a
/// number changes its sign from mesh to mesh.
double usual_error(const Solution& solution, AccuracyOf of) {
  const double side = std::sqrt(solution.grid.cell_area());
  return error_with(accuracy_data(), of, 2.0 * solution.contact_radius / side);
}

double value_of(const Solution& solution, const std::string& path) {
  if (path == "moment") return solution.moment;
  return path == "stick_radius" ? solution.stick_radius : solution.twist_angle;
}

double number_error(const Solution& fine, const Solution& coarse, const std::string& path, double order) {
  const double value = value_of(fine, path);
  const Limit limit =
      richardson_limit({{.size = 1.0, .value = value}, {.size = 2.0, .value = value_of(coarse, path)}}, order);
  return std::abs(limit.uncertainty / value);
}

/// Cell by cell over the same rectangle.
double field_error(const Solution& fine, const Solution& coarse, double order) {
  const Eigen::ArrayXd mean = solver::restrict_to(solver::coarser(fine.grid), fine.grid, fine.traction);
  const double apart = (mean - coarse.traction).matrix().norm() / mean.matrix().norm();
  return kOfNorm * apart / (std::exp2(order) - 1.0);
}

}  // namespace

double AccuracyQuantity::error(const ErrorsRecord& errors) const {
  if (is_field()) return errors.traction.at_centres.l2;
  if (name == "stick_radius") return errors.stick_radius;
  return name == "moment" ? errors.moment : errors.twist;
}

AccuracyQuantity accuracy_quantity(const Scene& scene, AccuracyOf of) {
  if (of == AccuracyOf::traction) return {"traction", "traction_error.l2"};
  if (of == AccuracyOf::stick_radius) return {"stick_radius", "stick_radius"};
  const bool imposed = std::holds_alternative<solver::Twist>(scene.steps.back().torsion);
  return imposed ? AccuracyQuantity{"moment", "moment"} : AccuracyQuantity{"twist", "twist_angle"};
}

void require_reachable(const Scene& scene, const AccuracyTarget& target) {
  const std::string option = fmt::format("--accuracy {:g}", target.error);
  if (!(target.error > 0.0 && target.error < 1.0)) throw InputError(option, "allowed: above 0 and below 1");
  if (target.of == AccuracyOf::twist && !brings_torsion(scene.steps.back().torsion)) {
    throw InputError(option, fmt::format("{} brings no torsion in its last step, so that the twist has no relative "
                                         "error; allowed: --accuracy-of traction, stick_radius",
                                         scene.source.string()));
  }
  if (const char* const owner = grid_owner(scene);
      owner != nullptr && scene.solver.model != solver::ModelChoice::exact) {
    throw InputError(scene.source.string(), fmt::format("the grid is that of {}: --accuracy cannot choose it", owner));
  }
  if (scene.solver.method == solver::Method::paper && scene.solver.model != solver::ModelChoice::exact) {
    throw InputError(scene.source.string(), "solver.method", "\"paper\"",
                     "coulomb with --accuracy (the paper's stopping test bounds no error)");
  }
}

bool answers_exactly(const Scene& scene, AccuracyOf of) {
  try {
    const Oracle oracle = require_oracle(scene);
    if (of == AccuracyOf::traction) return static_cast<bool>(oracle.shear);
    return std::isfinite(of == AccuracyOf::stick_radius ? oracle.stick_radius : oracle.twist_angle);
  } catch (const InputError&) {
    return false;
  }
}

Scene with_cells(Scene scene, Index longer) {
  const Index own = longer_side(scene);
  for (Index& cells : scene.grid.cells) {
    cells = std::max<Index>(2, 2 * std::lround(0.5 * static_cast<double>(longer * cells) / static_cast<double>(own)));
  }
  return scene;
}

ContactOnGrid contact_on_grid(const Scene& scene) {
  if (grid_owner(scene) != nullptr) {
    const solver::Grid grid = solver::make_model(scene).grid;
    const auto longer = static_cast<double>(std::max(grid.n1, grid.n2));
    return {.longer = longer, .margin = 0.0, .cells_across = 2.0 * std::sqrt(static_cast<double>(grid.cells()) / M_PI)};
  }
  Scene coarse = with_cells(scene, kReferenceCells);
  coarse.solver.op = solver::OperatorKind::dcfft;
  const solver::Model model = solver::make_model(coarse);
  const solver::Step& step = coarse.steps.back();
  const solver::NormalSolution normal = solver::find_pressure(coarse, model, step);
  solver::require_contact_within_grid(coarse, model, step, normal);
  const auto pressed = static_cast<double>((normal.pressure > 0.0).count());
  const double across = 2.0 * std::sqrt(pressed / M_PI);
  require_contact_seen(scene, pressed, across);
  return {.longer = static_cast<double>(kReferenceCells),
          .margin = scene.grid.extent ? 0.0 : kFreeCells,
          .cells_across = across};
}

Index cells_for(const ContactOnGrid& contact, double across, Index multiple) {
  const double cells = (contact.longer - contact.margin) * across / contact.cells_across + contact.margin;
  const double multiples = std::ceil(cells / static_cast<double>(multiple) - 1e-9);
  return std::max(kMinGridCells, multiple * static_cast<Index>(multiples));
}

double cells_across(const ContactOnGrid& contact, Index cells) {
  return contact.cells_across * (static_cast<double>(cells) - contact.margin) / (contact.longer - contact.margin);
}

InputError out_of_reach(const Scene& scene, const AccuracyTarget& target, double least) {
  return {fmt::format("--accuracy {:g}", target.error),
          fmt::format("allowed on a grid: {:.2g} or more for the {}, which {} cells across the contact "
                      "are expected to reach; where a scene has an exact answer: any, with --model exact",
                      least, accuracy_quantity(scene, target.of).name, kMaxCellsAcross)};
}

AccuracyChoice choose_grid(const Scene& scene, const ContactOnGrid& contact, const AccuracyTarget& target,
                           bool estimated) {
  const AccuracyData data = accuracy_data();
  const double error = mesh_error(target, estimated);
  const double least = target.path + error_with(data, target.of, kMaxCellsAcross) * target.of_mesh() / error;
  if (!(target.error >= least)) throw out_of_reach(scene, target, least);
  const Needed needed = needed_for(data, target.of, error);
  AccuracyChoice choice{.cells = cells_for(contact, needed.cells_across),
                        .tolerance = std::max(needed.tolerance, kTightestTolerance)};
  solver::make_model(with_cells(scene, choice.cells));  // throws if it does not fit in memory
  return choice;
}

std::optional<AccuracyChoice> refined(const Scene& scene, const ContactOnGrid& contact, const AccuracyTarget& target,
                                      const AccuracyChoice& before, double reached, double order) {
  const double suggested = kRefinementMargin * std::pow(reached / target.of_mesh(), 1.0 / order);
  const double across = cells_across(contact, before.cells);
  if (!(suggested * across <= kMaxCellsAcross)) return std::nullopt;
  const double factor = std::clamp(suggested, kRefinementMargin, kMaxRefinement);
  const AccuracyChoice next{.cells = cells_for(contact, factor * across),
                            .tolerance = std::max(before.tolerance * std::pow(factor, -order), kTightestTolerance)};
  if (!fits_in_memory(with_cells(scene, next.cells))) return std::nullopt;
  return next;
}

double estimation_safety(AccuracyOf of) { return of == AccuracyOf::traction ? kOfNorm : kTwoMeshes; }

ReachedError reached_error(const Scene& scene, const Solution& solution, const ErrorsRecord& errors, AccuracyOf of) {
  const AccuracyQuantity quantity = accuracy_quantity(scene, of);
  if (solution.status != solver::Status::converged) return {NAN, "exact", solution.message};
  const double error = std::abs(quantity.error(errors));
  if (std::isfinite(error)) return {error, "exact", "against the exact answer"};
  const Solution coarse = solver::solve(half_as_fine(scene, solution.grid));
  if (coarse.status != solver::Status::converged) {
    return {NAN, "estimated", fmt::format("on half as many cells: {}", coarse.message)};
  }
  const double order = order_of(quantity, scene);
  const double estimate =
      quantity.is_field() ? field_error(solution, coarse, order) : number_error(solution, coarse, quantity.path, order);
  if (!std::isfinite(estimate)) return {NAN, "estimated", "the value, or its error, is zero"};
  return {std::max(estimate, usual_error(solution, of)), "estimated",
          fmt::format("from {} x {} cells, order {}", coarse.grid.n1, coarse.grid.n2, order)};
}

}  // namespace slipstick::convergence
