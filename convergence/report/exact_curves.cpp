#include "convergence/report/exact_curves.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <utility>

#include "analytic/cycle.hpp"
#include "analytic/paper_equations.hpp"
#include "analytic/stresses/largest_stress.hpp"
#include "analytic/torsion.hpp"

namespace slipstick::convergence {
namespace {

using analytic::TorsionState;

constexpr int kCurvePoints = 200;
constexpr double kHighestLoad = 0.99999;

/// Loads from 0 on, denser towards both ends.
std::vector<double> loads() {
  std::vector<double> loads;
  for (int i = 0; i <= kCurvePoints; ++i)
    loads.push_back(std::min(0.5 * (1.0 - std::cos(std::numbers::pi * i / kCurvePoints)), kHighestLoad));
  return loads;
}

/// And the load at whose twist a discrete element code reaches its cap, where it is farthest off.
std::vector<double> loads_and_cap() {
  std::vector<double> all = loads();
  const double cap = analytic::from_twist(analytic::dem_twist(analytic::dem_moment_limit())).moment_ratio;
  all.insert(std::ranges::upper_bound(all, cap), cap);
  return all;
}

/// value/exact - 1; every law becomes exact as the load vanishes.
double error_of(double value, double exact) { return exact > 0.0 ? value / exact - 1.0 : 0.0; }

Json curve() {
  Json rows = Json::array();
  for (const double load : loads()) {
    const TorsionState state = analytic::from_moment_ratio(load);
    const double equation_7 = analytic::paper::eq7_twist(state.moment);
    rows.push_back({{"moment_ratio", state.moment_ratio},
                    {"stick_ratio", state.stick_ratio},
                    {"stick_complement", state.stick_complement},
                    {"twist", state.twist},
                    {"equation_7", equation_7},
                    {"equation_7_error", error_of(equation_7, state.twist)}});
  }
  return rows;
}

/// Where Eq. (5) as printed loses its digits: against the stable form at the same stick ratio.
Json equation_5_digits() {
  Json rows = Json::array();
  for (int i = 0; i <= 48; ++i) {
    const double complement = std::pow(10.0, -0.25 - 0.15 * i);
    const double c = 1.0 - complement;
    const double exact = analytic::from_stick_ratio(c).moment;
    rows.push_back(
        {{"stick_complement", complement}, {"relative_error", std::abs(analytic::paper::eq5_moment(c) / exact - 1.0)}});
  }
  return rows;
}

/// One load: the twist by each law, its error, and the moment that a discrete element code has at the exact twist.
Json approximation_row(double load) {
  const TorsionState state = analytic::from_moment_ratio(load);
  Json row{{"moment_ratio", load}, {"twist", state.twist}, {"moment", state.moment}};
  for (const analytic::Approximation& law : analytic::approximations()) {
    const double twist = law.twist(state.moment);
    row[law.key] = {{"twist", twist}, {"error", error_of(twist, state.twist)}};
  }
  const double dem_moment = analytic::dem_moment(state.twist);
  row["dem_moment"] = {{"moment", dem_moment}, {"error", error_of(dem_moment, state.moment)}};
  return row;
}

Json approximation_rows(const std::vector<double>& at) {
  Json rows = Json::array();
  for (const double load : at) rows.push_back(approximation_row(load));
  return rows;
}

Json bodies() {
  Json list = Json::array();
  for (const analytic::Profile* profile :
       {&analytic::hertz_profile(), &analytic::cone_profile(), &analytic::flat_punch_profile()}) {
    Json rows = Json::array();
    for (const double load : loads()) {
      const TorsionState state = analytic::from_moment_ratio(load, *profile);
      rows.push_back({{"moment_ratio", load},
                      {"moment", state.moment},
                      {"stick_ratio", state.stick_ratio},
                      {"twist", state.twist}});
    }
    list.push_back({{"profile", profile->name()},
                    {"moment_limit", profile->moment_limit()},
                    {"full_stick", profile->full_stick()},
                    {"rows", rows}});
  }
  return list;
}

/// A loop of the sphere with an inner loop on its way up, which leaves no trace.
Json loop() {
  const std::vector<double> turning_points{0.9, -0.9, 0.5, -0.5, 0.9};
  constexpr int kPointsPerBranch = 60;
  Json rows = Json::array();
  for (const analytic::CycleState& state : analytic::loading_curve(turning_points, kPointsPerBranch))
    rows.push_back({{"moment_ratio", state.moment_ratio},
                    {"moment", state.moment},
                    {"twist", state.twist},
                    {"dissipated", state.dissipated}});
  return {{"turning_points", turning_points}, {"rows", rows}};
}

/// Energy lost per cycle against amplitude, and its limit for small amplitudes.
Json cycle_energy() {
  constexpr int kSmall = 59;
  std::vector<double> amplitudes;
  amplitudes.reserve(kSmall);
  for (int i = 0; i < kSmall; ++i) amplitudes.push_back(std::pow(10.0, -3.0 + 0.05 * i));
  for (const double load : {0.85, 0.9, 0.93, 0.96, 0.98, 0.99, 0.995, 0.999}) amplitudes.push_back(load);
  Json rows = Json::array();
  for (const double load : amplitudes)
    rows.push_back({{"moment_ratio", load},
                    {"energy", analytic::energy_lost_per_cycle(load)},
                    {"small_amplitude", analytic::energy_lost_per_small_cycle(load)}});
  return rows;
}

constexpr double kPoisson = 0.3;  // of the sphere that yields

Json yield_row(double load, double friction) {
  const TorsionState state = analytic::from_moment_ratio(load);
  const analytic::LargestStress found = analytic::largest_stress(
      {state, analytic::hertz_profile()}, &analytic::Severity::von_mises, friction, kPoisson, state.stick_ratio);
  return {{"moment_ratio", load}, {"von_mises", found.value}, {"radius", found.at.radius}, {"depth", found.at.depth}};
}

bool at_surface(const Json& yield_row) { return yield_row["depth"] == 0.0; }

/// With the load from which the place is the surface on, to 5e-4.
Json yield_curve(double friction) {
  Json rows = Json::array();
  for (const double load : {0.02, 0.05, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99}) {
    Json row = yield_row(load, friction);
    if (!rows.empty() && at_surface(row) && !at_surface(rows.back())) {
      double below = rows.back()["moment_ratio"];
      Json jump = row;
      while (number_at(jump, "moment_ratio") - below > 5e-4) {
        Json middle = yield_row(0.5 * (below + number_at(jump, "moment_ratio")), friction);
        if (at_surface(middle))
          jump = std::move(middle);
        else
          below = middle["moment_ratio"];
      }
      rows.push_back(std::move(jump));
    }
    rows.push_back(std::move(row));
  }
  return {{"friction", friction}, {"rows", rows}};
}

/// Von Mises' stress and the largest shear over radius and depth.
Json yield_map(double load, double friction) {
  constexpr double kSpacing = 0.04;
  const analytic::StressField field(analytic::from_moment_ratio(load), analytic::hertz_profile());
  Json equivalent = Json::array(), shears = Json::array();
  for (int i = 0; i <= 25; ++i) {
    Json row = Json::array(), shear_row = Json::array();
    for (int j = 0; j <= 35; ++j) {
      const analytic::BodyPoint at{kSpacing * j, kSpacing * i};
      const auto found = analytic::severity(field.by_pressure(at, kPoisson), field.by_torsion(at), friction);
      row.push_back(found.von_mises);
      shear_row.push_back(0.5 * found.tresca);
    }
    equivalent.push_back(std::move(row));
    shears.push_back(std::move(shear_row));
  }
  return {{"friction", friction},
          {"moment_ratio", load},
          {"spacing", kSpacing},
          {"von_mises", equivalent},
          {"shear", shears}};
}

/// Where the paper's sphere yields first.
Json first_yield() {
  Json curves = Json::array();
  for (const double friction : {0.3, 0.4, 0.5, 0.7, 1.0}) curves.push_back(yield_curve(friction));
  return {{"poisson", kPoisson}, {"curves", curves}, {"maps", {yield_map(0.0, 0.5), yield_map(0.9, 0.5)}}};
}

namespace paper = analytic::paper;

std::string jump_at_stick_radius() {
  const double c = 0.5;
  const double inside = paper::eq1_printed(c, std::nextafter(c, 0.0));
  const double outside = paper::eq1_printed(c, std::nextafter(c, 1.0));
  return fmt::format("as printed, q jumps by a factor {:.6f} at r = aₛ (here aₛ/a = 0.5); with 2/π it is continuous",
                     inside / outside);
}

std::string equation_7_error() {
  std::string text = "against Eqs. (4) and (5) it is off by";
  const char* separator = " ";
  for (const double c : {0.95, 0.8, 0.5, 0.2}) {
    const analytic::TorsionState state = analytic::from_stick_ratio(c);
    text += fmt::format("{}{:.2g} % at M/Mₗᵢₘ = {:.3f}", std::exchange(separator, ", "),
                        100.0 * (paper::eq7_twist(state.moment) / state.twist - 1.0), state.moment_ratio);
  }
  return text + fmt::format("; at Mₗᵢₘ it gives {:.4g} where the twist is infinite",
                            paper::eq7_twist(analytic::hertz_profile().moment_limit()));
}

std::string equation_5_cancellation() {
  std::string text = "right as printed, but in double precision its relative error is";
  const char* separator = " ";
  for (const double complement : {1e-3, 1e-4, 1e-6}) {
    const analytic::TorsionState state = analytic::from_stick_complement(complement);
    text += fmt::format(
        "{}{:.1e} at aₛ/a = 1 − {:g}", std::exchange(separator, ", "),
        std::abs(paper::eq5_moment(state.stick_ratio) / analytic::from_stick_ratio(state.stick_ratio).moment - 1.0),
        complement);
  }
  return text;
}

std::string frozen_directions(const Json& circle, const std::vector<Json>& ellipses) {
  const auto evidence = [](const Json& result) {
    return fmt::format("{:.2g}° (gap/energy {:.1e}) at {} × {} cells", number_at(result, "slip_direction.mean"),
                       number_at(result, "certificate.gap"), number_at(result, "cells[0]"),
                       number_at(result, "cells[1]"));
  };
  std::string text =
      "at 0.9 of the limit, traction is off the slip's direction, in the mean, on a circular contact by " +
      evidence(circle) + "; on an ellipse with axes about 2 : 1 by";
  const char* separator = " ";
  for (const Json& ellipse : ellipses) text += std::exchange(separator, ", ") + evidence(ellipse);
  return text + ": finer meshes do not mend it, and Eq. (26) does not see it";
}

Json erratum(const char* equation, const char* printed, const char* holds, const std::string& shown) {
  return {{"equation", equation}, {"printed", printed}, {"holds", holds}, {"shown", shown}};
}

}  // namespace

Json exact_curves() {
  return {{"curve", curve()},
          {"equation_5_digits", equation_5_digits()},
          {"approximations", approximation_rows(loads_and_cap())},
          {"approximation_table", approximation_rows({0.01, 0.1, 0.2, 0.3, 0.5, 0.7, 0.9, 0.99})},
          {"bodies", bodies()},
          {"loop", loop()},
          {"cycle_energy", cycle_energy()},
          {"first_yield", first_yield()}};
}

Json errata(const Json& circle, const std::vector<Json>& ellipses) {
  return {
      erratum("(1), first branch", "factor 3μW/(2πa²)", "that factor times 2/π", jump_at_stick_radius()),
      erratum("(5)", "a closed form", "right, but its terms cancel as aₛ/a approaches 1", equation_5_cancellation()),
      erratum("(7)", "an equality", "an approximation for small moments", equation_7_error()),
      erratum("(8), (9), (13)–(16), (24), (25)", "x₂ and x₁ with equal signs", "the rotation field is (−x₂, x₁)",
              "with equal signs the field is (x₂, x₁), a pure shear without any rotation"),
      erratum("(16), (25)", "a denominator without a sum", "the sum of x₁² + x₂² over the stick area",
              "as printed, the denominator belongs to no particular cell and the dimensions do not match"),
      erratum("(22), (23)", "a cell that starts to slip keeps the direction its traction had then",
              "Coulomb: traction opposite to slip", frozen_directions(circle, ellipses)),
  };
}

}  // namespace slipstick::convergence
