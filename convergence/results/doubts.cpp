#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include "convergence/results/make_record.hpp"

namespace slipstick::convergence {
namespace {

/// Half-spaces stand for bodies whose surfaces are nearly plane: terms of the order of the squared slope, 9 %
/// here, are neglected. A sphere's slope at the edge of its contact is a/R.
constexpr double kSteep = 0.3;

/// Cells of a wave, at least: a coarser grid leaves out what the shortest waves do.
constexpr double kFewestCellsOfWave = 4.0;

/// The peak pressure, or the mean one where the peak is infinite or not known.
double pressure_of(const EndRecord& end) {
  const ContactRecord& contact = end.contact;
  if (std::isfinite(contact.peak_pressure)) return contact.peak_pressure;
  return contact.normal_load / (std::numbers::pi * contact.contact_radius * contact.contact_radius);
}

/// The slope of a shape where a contact of radius a ends; of a rough surface the root mean square.
double slope_at(const solver::Surface& shape, double a) {
  using enum solver::Shape;
  if (shape.shape == sphere) return a / shape.radius;
  if (shape.shape == ellipsoid) return a / std::sqrt(shape.radius_1 * shape.radius_2);
  if (shape.shape == cone) return shape.slope;
  if (shape.shape == rounded_punch) return (a - shape.flat_radius) / shape.corner_radius;
  if (shape.shape == power) return shape.coefficient * shape.exponent * std::pow(a, shape.exponent - 1.0);
  return shape.roughness.rms_slope;
}

/// About waves of a random surface that the grid hardly shows.
void add_wave_doubts(const solver::Surface& shape, const ProblemRecord& grid, std::vector<std::string>& doubts) {
  if (shape.shape != solver::Shape::roughness) return;
  const double cell = std::fmax(grid.cell_size[0], grid.cell_size[1]);
  const double cells = shape.roughness.shortest / cell;
  constexpr double kRounding = 1e-9;
  if (!(cells < kFewestCellsOfWave * (1.0 - kRounding))) return;
  doubts.push_back(
      fmt::format("{}.shortest, {:.3g} m, is {:.3g} cells long: with fewer than {} the answer is "
                  "that of a smoother surface; take smaller cells or longer shortest waves",
                  shape.key.empty() ? "upper" : shape.key, shape.roughness.shortest, cells, kFewestCellsOfWave));
}

/// About the moduli and yield stresses, which the pressure should not exceed.
void add_pressure_doubts(const std::string& key, const solver::Material& body, double pressure,
                         std::vector<std::string>& doubts) {
  const std::string layer = key + ".layer";
  const auto compare = [&](const std::string& table, double modulus) {
    if (!(pressure > modulus)) return;
    doubts.push_back(
        fmt::format("the pressure, {:.3g} Pa, exceeds {}.young_modulus, {:.3g} Pa: strains are small in "
                    "this theory; a modulus of 210 GPa is 210e9, or \"210 GPa\"",
                    pressure, table, modulus));
  };
  compare(key, body.young_modulus);
  if (body.coating) compare(layer, body.coating->young_modulus);
  if (!body.yield_stress || !(pressure > *body.yield_stress)) return;
  doubts.push_back(
      fmt::format("the pressure, {:.3g} Pa, is {:.3g} times {}.yield_stress, {:.3g} Pa: the body may "
                  "yield (under a sphere without friction at 1.6 times), and the answer is elastic",
                  pressure, pressure / *body.yield_stress, key, *body.yield_stress));
}

}  // namespace

std::vector<std::string> doubts_about(const solver::Scene& scene, const SolveRecord& record) {
  double radius = 0.0;
  double pressure = 0.0;
  std::string load_warning;
  const auto look_at = [&](const EndRecord& end) {
    radius = std::fmax(radius, end.contact.contact_radius);
    pressure = std::fmax(pressure, pressure_of(end));
    if (load_warning.empty()) load_warning = end.loads.warning;
  };
  look_at(record.end);
  for (const StepRecord& step : record.history.value_or(HistoryRecord()).steps) look_at(step.end);

  std::vector<std::string> doubts;
  for (const solver::Surface& shape : scene.surfaces) {
    add_wave_doubts(shape, record.problem, doubts);
    const double slope = slope_at(shape, radius);
    if (!(slope > kSteep)) continue;
    const bool round = shape.shape == solver::Shape::sphere || shape.shape == solver::Shape::ellipsoid;
    doubts.push_back(fmt::format(
        "{}: {}, {:.3g}, is above {}: half-spaces neglect terms of the order of the slope's square",
        shape.key.empty() ? "upper" : shape.key,
        round ? fmt::format("the contact's radius, {:.3g} m, over the body's", radius) : "the slope", slope, kSteep));
  }
  add_pressure_doubts("upper", scene.upper, pressure, doubts);
  add_pressure_doubts("lower", scene.lower, pressure, doubts);
  if (!load_warning.empty()) doubts.push_back(load_warning);
  return doubts;
}

}  // namespace slipstick::convergence
