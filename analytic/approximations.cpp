#include "analytic/approximations.hpp"

#include <algorithm>
#include <array>

#include "analytic/out_of_range.hpp"
#include "analytic/paper_equations.hpp"

namespace slipstick::analytic {

namespace {

constexpr double kNoSlipStiffness = 16.0 / 3;  // over G a^3
constexpr double kCap = 2.0 / 3;               // over mu W a

constexpr std::array kApproximations{
    Approximation{.key = "equation_7", .name = "Eq. (7)", .twist = paper::eq7_twist},
    Approximation{.key = "no_slip", .name = "no slip", .twist = no_slip_twist},
    Approximation{.key = "small_moments", .name = "small moments", .twist = small_moment_twist},
    Approximation{.key = "dem", .name = "DEM", .twist = dem_twist},
};

void require_up_to(double most, std::string_view range, double moment) {
  if (!(moment >= 0 && moment <= most))
    out_of_range("M/(mu W a)", moment, fmt::format("0 <= M/(mu W a) <= {}", range));
}

void require_carried(double moment) { require_up_to(paper::eq6_moment_limit(), "3 pi/16", moment); }

}  // namespace

double no_slip_twist(double moment) {
  require_carried(moment);
  return moment / kNoSlipStiffness;
}

double small_moment_twist(double moment) {
  require_carried(moment);
  return moment / kNoSlipStiffness + 9.0 / 64 * moment * moment;
}

double dem_moment_limit() { return kCap; }

double dem_moment(double twist) {
  if (!(twist >= 0)) out_of_range("G a^2 phi/(mu W)", twist, "0 or more");
  return std::min(kNoSlipStiffness * twist, kCap);
}

double dem_twist(double moment) {
  require_up_to(kCap, "2/3", moment);
  return moment / kNoSlipStiffness;
}

std::span<const Approximation> approximations() { return kApproximations; }

}  // namespace slipstick::analytic
