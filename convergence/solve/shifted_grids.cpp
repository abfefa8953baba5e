#include "convergence/solve/shifted_grids.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "convergence/orders/expected_order.hpp"
#include "convergence/results/make_record.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

using solver::InputError;
using solver::Scene;

/// The relative uncertainty of a mean's twist is R^-kShiftedOrder sqrt(front^2 + slip^2 + tip^2), where R is
/// the contact's radius and c R the stick radius in cells of the finest grid, and s = 1 - c. front = e
/// sqrt(kFront^2 + (kCurvedFront/(c R))^2)/c: the staircase along the curved edge of the stick area. e is the
/// longer over the shorter axis of the contact: in a slender contact the shapes of stick area and contact
/// differ, and all grids have the same error.
/// slip = sqrt(kNarrowSlip^2 + (kRingInCell/(s R))^2)/s, at most kNoRing R: a narrow slip ring.
/// tip = kTip/(c^2 sqrt(R)): a tip of the surface, which is at a cell's corner in all grids.
/// The constants cover 95 of 100 errors of 364 random spheres, cones, punches with round corners and powers
/// at 0.05 to 0.99 of the limit, on five to eight meshes each with R from 4 to 400.
constexpr double kFront = 0.15;
constexpr double kCurvedFront = 0.85;
constexpr double kNarrowSlip = 0.05;
constexpr double kRingInCell = 0.015;
constexpr double kNoRing = 0.62;
constexpr double kTip = 0.88;
constexpr double kMinStickRatio = 0.02;
/// The uncertainty is at least this part of the scatter (standard deviation) of the grids; that changes 1 of
/// 100.
constexpr double kOfScatter = 0.2;
/// Where the data do not apply the scatter is added, which is usually twice the uncertainty.
constexpr double kBeyondData = 3.0;
/// Cells across the contact of the first mesh of the search, and the factor to the next mesh.
constexpr double kMinAcrossShifted = 12.0;
constexpr double kFiner = 1.02;
/// The tolerance (gap over energy): its ratio to the target error, and the loosest. On 120 grids it changed
/// the twist by at most a fiftieth of itself, relative.
constexpr double kToleranceOfError = 1.0;
constexpr double kLoosest = 1e-4;
/// Cells along the longer side of the grid that estimates the contact's form, and of a finer one. The finer
/// one is used if the slip ring is narrower than kNarrowRing times the contact's radius, less than a cell,
/// and the target needs much finer grids.
constexpr solver::Index kFormCells = 40;
constexpr solver::Index kFinerFormCells = 160;
/// Largest number of parts of all steps together in that solve.
constexpr long kFormParts = 300;
constexpr double kNarrowRing = 0.06;
/// Least stick radius, in cells, in the formula for the spread of the grids: bounds the difference of their cells.
constexpr double kMinSpreadStickCells = 4.0;

bool has_tip(const Scene& scene) {
  constexpr double kSmoothExponent = 2.0;
  return std::ranges::any_of(scene.surfaces, [](const solver::Surface& surface) {
    return surface.shape == solver::Shape::cone ||
           (surface.shape == solver::Shape::power && surface.exponent < kSmoothExponent);
  });
}

double expected_uncertainty(const Scene& scene, double across, const ContactForm& form) {
  const double radius = 0.5 * across;
  const double stick = std::max(form.stick_ratio, kMinStickRatio);
  const double front = form.slender * std::hypot(kFront, kCurvedFront / (stick * radius)) / stick;
  const double ring = 1.0 - form.stick_ratio;
  const double slip = std::min(std::hypot(kNarrowSlip, kRingInCell / (ring * radius)) / ring, kNoRing * radius);
  const double tip = has_tip(scene) ? kTip / (stick * stick * std::sqrt(radius)) : 0.0;
  return std::hypot(front, slip, tip) * std::pow(radius, -kShiftedOrder);
}

/// Whether the data do not apply: errors add up in a history, whose numbers are differences, and shapes side
/// by side have several stick areas.
bool is_beyond_data(const Scene& scene) {
  return has_history(scene) || (scene.surfaces.size() > 1 && scene.combine == solver::Combine::nearest);
}

/// The error for which a mesh is chosen.
double expected_error(const Scene& scene, double across, const ContactForm& form) {
  const double uncertainty = expected_uncertainty(scene, across, form);
  return is_beyond_data(scene) ? kBeyondData * uncertainty : uncertainty;
}

/// Longer over shorter axis of a contact, from its pressure's second moments.
double slenderness(const solver::Solution& solution) {
  const Eigen::ArrayXd part = solution.pressure / solution.pressure.sum();
  const Eigen::ArrayXd x1 = solver::cell_x1(solution.grid);
  const Eigen::ArrayXd x2 = solver::cell_x2(solution.grid);
  const Eigen::ArrayXd from1 = x1 - (part * x1).sum();
  const Eigen::ArrayXd from2 = x2 - (part * x2).sum();
  const double about11 = (part * from1.square()).sum();
  const double about22 = (part * from2.square()).sum();
  const double mean = 0.5 * (about11 + about22);
  const double apart = std::hypot(0.5 * (about11 - about22), (part * from1 * from2).sum());
  return std::sqrt((mean + apart) / (mean - apart));
}

/// The form of the contact on a grid with `cells` along its longer side; defaults where the solve fails.
ContactForm form_on(const Scene& scene, solver::Index cells) {
  ContactForm form;
  try {
    Scene few = with_cells(scene, cells);
    const long steps = static_cast<long>(few.steps.size()) * few.cycles;
    few.solver.substeps = static_cast<int>(std::clamp<long>(kFormParts / steps, 1, few.solver.substeps));
    const solver::Solution coarse = solver::solve(few);
    const double ratio = coarse.stick_radius / coarse.contact_radius;
    if (ratio >= 0.0 && ratio <= 1.0) form.stick_ratio = ratio;
    const double slender = slenderness(coarse);
    if (slender >= 1.0 && std::isfinite(slender)) form.slender = slender;
  } catch (const InputError&) {
    // the chosen mesh may carry the loads; if not, its solve throws the error
  }
  return form;
}

/// Cells across the contact that are expected to reach the target, at most kMaxCellsAcross.
double across_for(const Scene& scene, const AccuracyTarget& target, const ContactForm& form) {
  double across = kMinAcrossShifted;
  while (across < kMaxCellsAcross && expected_error(scene, across, form) > target.of_mesh()) {
    across *= kFiner;
  }
  return std::min(across, kMaxCellsAcross);
}

/// The scene's grid, and larger ones with the same number of cells.
std::vector<Scene> shifted(const Scene& scene, double stick_cells) {
  const solver::Grid grid = solver::make_model(scene).grid_in_m();
  const double growth = 1.0 / (kShiftedGrids * std::max(stick_cells, kMinSpreadStickCells));
  std::vector<Scene> scenes(kShiftedGrids, scene);
  for (int k = 0; k < kShiftedGrids; ++k) {
    const double scale = 1.0 + growth * k;
    scenes[static_cast<std::size_t>(k)].grid.extent = {scale * grid.h1 * static_cast<double>(grid.n1),
                                                       scale * grid.h2 * static_cast<double>(grid.n2)};
  }
  return scenes;
}

struct Moments {
  double mean = 0.0;
  double deviation = 0.0;
};

Moments moments_of(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  Moments moments;
  for (const double value : values) moments.mean += value / count;
  for (const double value : values) moments.deviation += (value - moments.mean) * (value - moments.mean);
  moments.deviation = std::sqrt(moments.deviation / (count - 1.0));
  return moments;
}

bool is_moment(const AccuracyQuantity& quantity) { return quantity.name == "moment"; }

/// Gives a result the mean as its quantity, also in dimensionless form, and the error of the mean.
void put_mean(EndRecord& end, const AccuracyQuantity& quantity, double mean, double error) {
  Number& value = is_moment(quantity) ? end.loads.moment : end.loads.twist_angle;
  Number& scaled = is_moment(quantity) ? end.loads.moment_ratio : end.loads.twist;
  scaled.value *= mean / value;
  value = {mean};
  if (std::isfinite(error)) (is_moment(quantity) ? end.errors.moment : end.errors.twist) = {error};
}

}  // namespace

bool gains_by_smooth_cells(const Scene& scene, AccuracyOf of) {
  constexpr double kOrderOfRootEdges = 2.0;
  return of != AccuracyOf::traction && scene.contact.pressure == solver::PressureModel::solved &&
         !scene.ends_at_grid_edge && expected_order("twist_angle", scene).value == kOrderOfRootEdges;
}

bool takes_shifted_grids(const Scene& scene, AccuracyOf of) {
  return of == AccuracyOf::twist && gains_by_smooth_cells(scene, of);
}

ContactForm coarse_form(const Scene& scene, const AccuracyTarget& target) {
  const ContactForm form = form_on(scene, kFormCells);
  const bool narrow = 1.0 - form.stick_ratio < kNarrowRing;
  constexpr double kMuchFiner = 2.0 * kFinerFormCells;
  return narrow && across_for(scene, target, form) > kMuchFiner ? form_on(scene, kFinerFormCells) : form;
}

AccuracyChoice choose_shifted(const Scene& scene, const ContactOnGrid& contact, const AccuracyTarget& target,
                              const ContactForm& form) {
  const double least = target.path + expected_error(scene, kMaxCellsAcross, form);
  if (!(target.error >= least)) throw out_of_reach(scene, target, least);
  AccuracyChoice choice{.cells = cells_for(contact, across_for(scene, target, form), 2),
                        .tolerance = std::clamp(kToleranceOfError * target.error, kTightestTolerance, kLoosest)};
  solver::make_model(with_cells(scene, choice.cells));  // throws if it does not fit in memory
  return choice;
}

ShiftedMean mean_over_shifted_grids(const Scene& scene, const AccuracyQuantity& quantity, const ContactForm& form,
                                    const ContactOnGrid& contact, const GridSolve& solve) {
  const double radius = 0.5 * cells_across(contact, std::max(scene.grid.cells[0], scene.grid.cells[1]));
  const std::vector<Scene> scenes = shifted(scene, form.stick_ratio * radius);
  ShiftedMean found{.answer = {}, .error = NAN, .uncertainty = NAN, .why = {}, .grids = {}};
  std::vector<double> values;
  std::vector<double> errors;
  // The grid with the smallest cells comes last, since the last solve leaves the files of fields.
  for (auto grid = scenes.rbegin(); grid != scenes.rend(); ++grid) {
    const bool last = grid + 1 == scenes.rend();
    found.answer = solve(*grid, last ? solver::Detail::all : solver::Detail::loads);
    const solver::Solution& solution = found.answer.solution;
    if (solution.status != solver::Status::converged) {
      found.why = solution.message;
      return found;
    }
    const EndRecord& end = found.answer.record.end;
    values.push_back(is_moment(quantity) ? end.loads.moment : end.loads.twist_angle);
    errors.push_back(quantity.error(end.errors));
    found.grids.push_back({*grid->grid.extent, values.back()});
  }
  const Moments moments = moments_of(values);
  found.error = moments_of(errors).mean;
  const double scatter = moments.deviation / std::abs(moments.mean);
  const double expected = expected_uncertainty(scene, 2.0 * radius, form);
  // The sum covers 96 of 100 errors of 60 random histories of torsion on four meshes each.
  found.uncertainty = is_beyond_data(scene) ? expected + scatter : std::max(kOfScatter * scatter, expected);
  found.why = fmt::format("by data on such meshes and the scatter of {} grids, {:.2g}", values.size(), scatter);
  double mean = moments.mean;
  if (!std::isfinite(found.error)) found.path = path_correction(scene, found.answer.solution);
  if (found.path) {
    mean *= 1.0 + found.path->change;
    found.why += fmt::format("; {:.2g} of it added for the length of the steps", found.path->change);
  }
  SolveRecord& record = found.answer.record;
  put_mean(record.end, quantity, mean, found.error);
  if (record.history) put_mean(record.history->steps.back().end, quantity, mean, found.error);
  return found;
}

}  // namespace slipstick::convergence
