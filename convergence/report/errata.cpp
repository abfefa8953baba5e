#include "convergence/report/errata.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "analytic/paper_equations.hpp"
#include "analytic/torsion.hpp"
#include "convergence/results/quantity.hpp"

namespace slipstick::convergence {
namespace {

namespace paper = analytic::paper;

std::string jump_at_stick_radius() {
  const double c = 0.5;
  const double inside = paper::eq1_printed(c, std::nextafter(c, 0.0));
  const double outside = paper::eq1_printed(c, std::nextafter(c, 1.0));
  return fmt::format(
      "as printed, q jumps by a factor {:.6f} at r = aₛ (here aₛ/a = 0.5); with 2/π it is continuous",
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
        std::abs(paper::eq5_moment(state.stick_ratio) / analytic::from_stick_ratio(state.stick_ratio).moment -
                 1.0),
        complement);
  }
  return text;
}

std::string frozen_directions(const Json& circle, const std::vector<Json>& ellipses) {
  const auto evidence = [](const Json& result) {
    return fmt::format("{:.2g}° (gap/energy {:.1e}) at {} × {} cells",
                       number_at(result, "slip_direction.mean"), number_at(result, "certificate.gap"),
                       number_at(result, "cells[0]"), number_at(result, "cells[1]"));
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

Json errata(const Json& circle, const std::vector<Json>& ellipses) {
  return {
      erratum("(1), first branch", "factor 3μW/(2πa²)", "that factor times 2/π", jump_at_stick_radius()),
      erratum("(5)", "a closed form", "right, but its terms cancel as aₛ/a approaches 1",
              equation_5_cancellation()),
      erratum("(7)", "an equality", "an approximation for small moments", equation_7_error()),
      erratum("(8), (9), (13)–(16), (24), (25)", "x₂ and x₁ with equal signs",
              "the rotation field is (−x₂, x₁)",
              "with equal signs the field is (x₂, x₁), a pure shear without any rotation"),
      erratum("(16), (25)", "a denominator without a sum", "the sum of x₁² + x₂² over the stick area",
              "as printed, the denominator belongs to no particular cell and the dimensions do not match"),
      erratum("(22), (23)", "a cell that starts to slip keeps the direction its traction had then",
              "Coulomb: traction opposite to slip", frozen_directions(circle, ellipses)),
  };
}

}  // namespace slipstick::convergence
