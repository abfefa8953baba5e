#include "convergence/solve/shifted_grids.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "convergence/orders/expected_order.hpp"
#include "convergence/results/quantity.hpp"
#include "convergence/results/result.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

using solver::InputError;
using solver::Scene;

/// Scatter (standard deviation) of the twist over such grids of the paper's sphere, with so many cells across
/// the contact, where stick area and slip ring are wide; it grows by these powers where either is small.
constexpr double kScatter = 1.9e-5;
constexpr double kScatterAcross = 128.0;
constexpr double kSmallStick = 0.5;
constexpr double kSmallStickPower = 1.5;
constexpr double kNarrowSlip = 0.25;
constexpr double kNarrowSlipPower = 0.75;
constexpr double kMinRingPart = 0.02;
/// The mean errs by less than so much of the scatter, the found or the expected one, whichever is larger: in
/// more than 95 of 100 random scenes (convergence/solve/tests/coverage_test.cpp). The tip of a cone always
/// stands on a cell's corner: its part of the error is not averaged. And edges are no sharp fronts on meshes
/// that have fewer than kWellStuck cells across the stick area or kWellSlipping across the slip ring.
constexpr double kOfScatter = 0.35;
constexpr double kOfScatterOfTips = 0.7;
constexpr double kOfScatterUnresolved = 1.5;
constexpr double kWellStuck = 16.0;
constexpr double kWellSlipping = 5.0;
/// The mesh is chosen for the wanted error over this, since scenes differ.
constexpr double kMeshSafety = 1.25;
/// Cells across the contact of the first mesh that is tried, and the factor to the next.
constexpr double kMinAcrossShifted = 12.0;
constexpr double kFiner = 1.02;
/// The tolerance (gap over energy): its ratio to the wanted error, and the loosest.
constexpr double kToleranceOfError = 0.1;
constexpr double kLoosest = 1e-4;
/// Cells along the longer side of the coarse grid; and the smallest stick radius in cells by which grids are
/// spread, so that none is much coarser than the others.
constexpr solver::Index kFormCells = 40;
constexpr double kMinSpreadStickCells = 4.0;

double expected_scatter(double across, double stick_ratio) {
  const double stick = std::max(stick_ratio, kMinRingPart);
  const double slip = std::max(1.0 - stick_ratio, kMinRingPart);
  const double harder = std::max(
      {1.0, std::pow(kSmallStick / stick, kSmallStickPower), std::pow(kNarrowSlip / slip, kNarrowSlipPower)});
  return kScatter * harder * std::pow(kScatterAcross / across, kShiftedOrder);
}

bool has_tip(const Scene& scene) {
  constexpr double kSmoothExponent = 2.0;
  return std::ranges::any_of(scene.surfaces, [](const solver::Surface& surface) {
    return surface.shape == solver::Shape::cone ||
           (surface.shape == solver::Shape::power && surface.exponent < kSmoothExponent);
  });
}

/// Uncertainty over scatter. Widths of stick area and slip ring in cells.
double part_of_scatter(const Scene& scene, double stick_width, double slip_width) {
  const bool sharp = stick_width >= kWellStuck && slip_width >= kWellSlipping;
  if (!sharp) return kOfScatterUnresolved;
  return has_tip(scene) ? kOfScatterOfTips : kOfScatter;
}

/// Over the scatter that the stick area's shape explains: in a slender contact that shape differs from the
/// contact's, and all grids err alike.
double of_slender(double slender) {
  constexpr double kSlender = 1.25;
  return std::max(1.0, slender / kSlender);
}

double expected_uncertainty(const Scene& scene, double across, const ContactForm& form) {
  const double stick = form.stick_ratio;
  return of_slender(form.slender) * part_of_scatter(scene, stick * across, 0.5 * (1.0 - stick) * across) *
         expected_scatter(across, stick);
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

/// The scene's grid, and larger ones of as many cells.
std::vector<Scene> shifted(const Scene& scene, double stick_cells) {
  const solver::Grid grid = solver::make_model(scene).grid_in_m();
  const double growth = 1.0 / (kShiftedGrids * std::max(stick_cells, kMinSpreadStickCells));
  std::vector<Scene> scenes(kShiftedGrids, scene);
  for (int k = 0; k < kShiftedGrids; ++k) {
    const double scale = 1.0 + growth * k;
    scenes[static_cast<std::size_t>(k)].extent = {scale * grid.h1 * static_cast<double>(grid.n1),
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

void scale_number(Json& json, const char* key, double factor) {
  if (json.contains(key) && json[key].is_number()) json[key] = factor * json[key].get<double>();
}

/// The number itself, and its form without dimension.
void put_mean(Json& json, const AccuracyQuantity& quantity, double mean, double error) {
  const double factor = mean / number_at(json, quantity.value);
  scale_number(json, quantity.value == "moment" ? "moment_ratio" : "twist", factor);
  json[quantity.value] = mean;
  if (std::isfinite(error)) json[quantity.error] = error;
}

}  // namespace

bool gains_by_smooth_cells(const Scene& scene, AccuracyOf of) {
  constexpr double kOrderOfRootEdges = 2.0;
  return of != AccuracyOf::traction && scene.pressure == solver::PressureModel::solved &&
         !scene.ends_at_grid_edge && expected_order("twist_angle", scene).value == kOrderOfRootEdges;
}

bool takes_shifted_grids(const Scene& scene, AccuracyOf of) {
  return of == AccuracyOf::twist && gains_by_smooth_cells(scene, of);
}

ContactForm coarse_form(const Scene& scene) {
  ContactForm form;
  try {
    const solver::Solution coarse = solver::solve(with_cells(scene, kFormCells));
    const double ratio = coarse.stick_radius / coarse.contact_radius;
    if (ratio >= 0.0 && ratio <= 1.0) form.stick_ratio = ratio;
    const double slender = slenderness(coarse);
    if (slender >= 1.0 && std::isfinite(slender)) form.slender = slender;
  } catch (const InputError&) {
    // the mesh that counts may do better, or says it again
  }
  return form;
}

AccuracyChoice choose_shifted(const Scene& scene, const ContactOnGrid& contact, const AccuracyTarget& target,
                              const ContactForm& form) {
  const double aim = target.error / kMeshSafety;
  const double least = kMeshSafety * expected_uncertainty(scene, kMaxCellsAcross, form);
  if (!(target.error >= least)) throw out_of_reach(scene, target, least);
  double across = kMinAcrossShifted;
  while (across < kMaxCellsAcross && expected_uncertainty(scene, across, form) > aim) across *= kFiner;
  AccuracyChoice choice{
      .cells = cells_for(contact, std::min(across, kMaxCellsAcross)),
      .tolerance = std::clamp(kToleranceOfError * target.error, kTightestTolerance, kLoosest)};
  solver::make_model(with_cells(scene, choice.cells));  // says what does not fit in memory
  return choice;
}

ShiftedMean mean_over_shifted_grids(const Scene& scene, const AccuracyQuantity& quantity,
                                    const ContactForm& form, const ContactOnGrid& contact,
                                    const GridSolve& solve) {
  const double radius = 0.5 * cells_across(contact, std::max(scene.cells[0], scene.cells[1]));
  const std::vector<Scene> scenes = shifted(scene, form.stick_ratio * radius);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  ShiftedMean found{
      .answer = {}, .error = unknown, .uncertainty = unknown, .why = {}, .grids = Json::array()};
  std::vector<double> values;
  std::vector<double> errors;
  // The smallest cells come last, so that what a solve writes beside its result is theirs.
  for (auto grid = scenes.rbegin(); grid != scenes.rend(); ++grid) {
    const bool last = grid + 1 == scenes.rend();
    found.answer = solve(*grid, last ? solver::Detail::all : solver::Detail::loads);
    const solver::Solution& solution = found.answer.solution;
    if (solution.status != solver::Status::converged) {
      found.why = solution.message;
      return found;
    }
    values.push_back(number_at(found.answer.result, quantity.value));
    errors.push_back(number_at(found.answer.result, quantity.error));
    found.grids.push_back({{"extent", *grid->extent}, {"value", values.back()}});
  }
  const Moments moments = moments_of(values);
  found.error = moments_of(errors).mean;
  const solver::Resolution& resolved = found.answer.solution.resolution;
  const double part =
      of_slender(form.slender) * part_of_scatter(scene, resolved.stick_width, resolved.slip_width);
  const double scatter = moments.deviation / std::abs(moments.mean);
  found.uncertainty = part * std::max(scatter, expected_scatter(2.0 * radius, form.stick_ratio));
  found.why = fmt::format("{:.2g} times the scatter of the {} grids whose mean it is, {:.2g}", part,
                          values.size(), scatter);
  put_mean(found.answer.result, quantity, moments.mean, found.error);
  if (found.answer.result.contains("steps")) {
    put_mean(found.answer.result["steps"].back(), quantity, moments.mean, found.error);
  }
  return found;
}

}  // namespace slipstick::convergence
