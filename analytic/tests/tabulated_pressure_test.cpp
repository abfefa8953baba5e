#include "analytic/tabulated_pressure.hpp"

#include <fmt/core.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <random>
#include <stdexcept>

#include "analytic/punch_superposition.hpp"
#include "analytic/tests/values.hpp"
#include "analytic/torsion.hpp"

namespace slipstick::analytic {
namespace {

using namespace ::testing;
using testing::hertz;
using testing::linear;
using testing::sample;

// p = 3 (1 - r) over its mean: reproduced exactly, with everything in closed form.

TEST(TabulatedProfile, ReproducesALinearPressure) {
  for (const int intervals : {15, 16, 101, 1000}) {
    const auto table = tabulated_profile("linear", sample(linear, intervals));
    const Profile& profile = *table.profile;
    EXPECT_NEAR(table.mean_pressure * 3, 1, 1e-14);
    EXPECT_NEAR(profile.load() / pi, 1, 1e-14);
    EXPECT_NEAR(profile.moment_limit(), 0.5, 1e-14);  // integral p r^2 over integral p r: (1/12)/(1/6)
    EXPECT_EQ(profile.edge(), 0);
    for (const double r : {0.0, 0.123, 0.5, 0.999, 1.0}) EXPECT_NEAR(profile.pressure(r), 3 * (1 - r), 1e-14) << r;
    for (const double c : {1e-200, 1e-100, 1e-12, 0.01, 0.1, 0.35, 0.5, 0.9}) {
      const double x = std::sqrt((1 - c) * (1 + c));
      const double h = 3 * (std::log1p(x) - std::log(c) - x);
      EXPECT_NEAR(profile.twist_integral(at(c)) / h, 1, 1e-13) << c;
      EXPECT_NEAR(profile.twist_slope(at(c)) / (3 * x), 1, 1e-13) << c;
    }
    // Close to the edge: H -> 3 x^3/3, as of p = 3 (1 - r).
    for (const double w : {1e-8, 1e-30, 1e-100}) {
      const StickRadius c{.ratio = 1 - w, .complement = w};
      EXPECT_NEAR(profile.twist_integral(c) / std::pow(2 * w, 1.5), 1, 1e-7) << w;
      EXPECT_NEAR(profile.twist_slope(c) / (3 * std::sqrt(2 * w)), 1, 1e-7) << w;
      EXPECT_GT(profile.moment_share(c).excess, 0) << w;
    }
  }
}

/// M by H: dM = (8/3) c^3 dH, so that here, with -c H' = 3 sqrt(1 - c^2), what is lacking is an elementary
/// integral: 8 integral_0^c s^2 sqrt(1 - s^2) ds = asin(c) - c sqrt(1 - c^2) (1 - 2 c^2).
TEST(TabulatedProfile, HasTheMomentOfALinearPressure) {
  const auto table = tabulated_profile("linear", sample(linear, 50));
  const double limit = table.profile->moment_limit() * table.profile->load();
  for (const double c : {0.1, 0.11, 0.3, 0.499999, 0.5, 0.7, 0.99}) {
    const double lacking = std::asin(c) - c * std::sqrt((1 - c) * (1 + c)) * (1 - 2 * c * c);
    EXPECT_NEAR(table.profile->moment_share(at(c)).deficit / (lacking / limit), 1, 2e-13) << c;
    EXPECT_NEAR(table.profile->moment_share(at(c)).excess / (1 - lacking / limit), 1, 1e-11) << c;
  }
  for (const double c : {1e-90, 1e-30, 1e-9}) {  // (8/9) p(0) c^3
    EXPECT_NEAR(table.profile->moment_share(at(c)).deficit / (8.0 / 9 * 3 * c * c * c / limit), 1, 1e-13) << c;
    EXPECT_NEAR(table.profile->moment_share(at(c)).excess, 1, 1e-13) << c;
  }
}

/// A pressure whose numbers are known.
struct KnownPressure {
  const char* name;
  std::function<double(double)> pressure;
  std::shared_ptr<const Profile> profile;
};

KnownPressure known(const char* name, std::shared_ptr<const Profile> profile) {
  return {name, [profile](double r) { return profile->pressure(r); }, profile};
}

/// Given at enough points for an error below kTruth.
KnownPressure dense(const char* name, const std::function<double(double)>& pressure) {
  constexpr int kIntervals = 2000;
  return {name, pressure, tabulated_profile(name, sample(pressure, kIntervals, true)).profile};
}

std::vector<KnownPressure> known_pressures() {
  const auto rim = [](double r) { return (1 - r) * (1 + r); };
  const auto lasting = [](const Profile& profile) {
    return std::shared_ptr<const Profile>{&profile, [](const Profile*) {}};
  };
  return {known("Hertz", lasting(hertz_profile())),
          known("cone", lasting(cone_profile())),
          known("power 1.5", power_profile(1.5)),
          known("power 20", power_profile(20)),
          known("rounded punch 0.5", rounded_punch_profile(0.5)),
          known("rounded punch 0.8", rounded_punch_profile(0.8)),
          dense("nearly flat punch", [](double r) { return 1 / std::sqrt(1.2 - r * r); }),
          dense("ring", [rim](double r) { return std::sqrt(rim(r)) * (1 + 2 * r * r); }),
          dense("wavy", [rim](double r) { return std::sqrt(rim(r)) * (1 + 0.1 * std::cos(9 * r)); }),
          dense("wavy with an edge", [](double r) { return 2 - r * r + 0.1 * std::sin(7 * r * r); }),
          dense("power 3/2 at the edge", [rim](double r) { return std::pow(rim(r), 1.5); }),
          dense("power 3 at the edge", [rim](double r) { return std::pow(rim(r), 3); }),
          dense("linear", linear),
          dense("bell", [](double r) { return std::exp(-4 * r * r); })};
}

enum class Spacing { even, to_the_edge, uneven, to_the_axis };

/// As a file holds it: radii to 6 digits, pressures to `digits` (0: all of both). Where the pressure is
/// infinite, another one.
std::vector<PressurePoint> as_in_a_file(const std::function<double(double)>& pressure, int points, Spacing spacing,
                                        int digits, std::mt19937& random) {
  const auto rounded = [](double x, int to) { return to == 0 ? x : std::stod(fmt::format("{:.{}e}", x, to - 1)); };
  std::vector<PressurePoint> table;
  for (int i = 0; i < points; ++i) {
    constexpr double kLargestShift = 0.35;  // of the spacing
    const double shift = 2 * kLargestShift * (static_cast<double>(random()) / std::mt19937::max() - 0.5);
    const bool end = i == 0 || i == points - 1;
    const double share = (i + (spacing == Spacing::uneven && !end ? shift : 0)) / (points - 1);
    double radius = share;
    if (spacing == Spacing::to_the_edge) radius = std::sin(pi / 2 * share);
    if (spacing == Spacing::to_the_axis) radius = share * share;
    double value = pressure(radius);
    if (!std::isfinite(value)) value = pressure(0.1 / points);
    table.push_back({.radius = rounded(radius, digits == 0 ? 0 : 6), .pressure = rounded(value, digits)});
  }
  return table;
}

/// Loads from nearly none to nearly the limit, stick radii and twists.
const std::vector<std::function<TorsionState(const Profile&)>> kQuestions{
    [](const Profile& p) { return from_moment_ratio(1e-6, p); },
    [](const Profile& p) { return from_moment_ratio(0.01, p); },
    [](const Profile& p) { return from_moment_ratio(0.1, p); },
    [](const Profile& p) { return from_moment_ratio(0.5, p); },
    [](const Profile& p) { return from_moment_ratio(0.9, p); },
    [](const Profile& p) { return from_moment_deficit(1e-6, p); },
    [](const Profile& p) { return from_stick_ratio(0.6, p); },
    [](const Profile& p) { return from_twist(0.1, p); },
};

/// All over W or the mean pressure.
std::vector<double> numbers_of(const TorsionState& state, const Profile& profile) {
  std::vector<double> numbers{state.moment_ratio, state.stick_ratio,       state.stick_complement, state.twist,
                              state.moment,       state.tangent_stiffness, profile.moment_limit()};
  for (const double r : {0.05, 0.5, 0.8, 0.95}) numbers.push_back(traction(state, r, profile) * pi / profile.load());
  return numbers;
}

/// The estimate is not below the error in any of thousands of numbers, nor much above it.
TEST(InterpolationErrors, AreNotBelowTheErrorsNorFarAbove) {
  constexpr double kTruth = 1e-8;      // of the pressures known by points
  constexpr double kUsualExcess = 30;  // an estimate that is too large by this factor still gives the digits to print
  std::mt19937 random(20240611);
  std::vector<double> excess;
  std::size_t below = 0;
  int turn = 0;
  for (const KnownPressure& truth : known_pressures())
    for (const int points : {16, 17, 33, 100, 201}) {
      const auto spacing = static_cast<Spacing>(turn % 4);
      const int digits = std::array{0, 4, 6}[static_cast<std::size_t>(turn % 3)];
      ++turn;
      const TabulatedProfile table =
          tabulated_profile(truth.name, as_in_a_file(truth.pressure, points, spacing, digits, random));
      for (const auto& question : kQuestions) {
        const auto numbers = [&](const Profile& profile, double) { return numbers_of(question(profile), profile); };
        const std::vector<double> exact = numbers(*truth.profile, 1);
        const std::vector<double> found = numbers(*table.profile, 1);
        const std::vector<double> estimates = interpolation_errors(table, numbers);
        for (std::size_t i = 0; i < exact.size(); ++i) {
          const double error = std::abs(found[i] - exact[i]);
          const double noise = kTruth * std::abs(exact[i]);
          if (!(error <= estimates[i] + noise)) {
            ++below;
            ADD_FAILURE() << truth.name << ", " << points << " points, spacing " << turn % 4 << ", digits " << digits
                          << ", number " << i << ": " << found[i] << " +/- " << estimates[i] << ", truth " << exact[i];
          }
          if (error > noise) excess.push_back(estimates[i] / error);
        }
      }
    }
  EXPECT_EQ(below, 0U);
  ASSERT_GT(excess.size(), 1000U);
  std::nth_element(excess.begin(), excess.begin() + static_cast<std::ptrdiff_t>(excess.size() / 2), excess.end());
  EXPECT_LT(excess[excess.size() / 2], kUsualExcess);
}

/// The mean pressure, by which a table's numbers become pressures and loads.
TEST(InterpolationErrors, TellThatOfTheMeanPressure) {
  for (const int intervals : {16, 33, 64, 501}) {
    const auto table = tabulated_profile("Hertz", sample(hertz, intervals));
    const auto error = interpolation_errors(table, [](const Profile&, double mean) { return std::vector{mean}; });
    EXPECT_LE(std::abs(table.mean_pressure - 2.0 / 3), error.at(0));
    EXPECT_GE(100 * std::abs(table.mean_pressure - 2.0 / 3), error.at(0));
  }
}

/// Half of the points moved up and half down leave sums as they were: their estimates must not be small.
TEST(InterpolationErrors, SeeNoiseThatCancels) {
  auto points = sample(linear, 40);
  constexpr double kNoise = 1e-3;
  for (std::size_t i = 1; i + 1 < points.size(); ++i) points[i].pressure += i % 2 == 0 ? kNoise : -kNoise;
  const auto table = tabulated_profile("noisy", points);
  const auto errors = interpolation_errors(table, [](const Profile& p, double) {
    return std::vector{p.moment_limit() / 0.5, p.pressure(0.4125) / 3};
  });
  for (const double error : errors) {
    EXPECT_GT(error, kNoise);
    EXPECT_LT(error, 30 * kNoise);
  }
}

TEST(InterpolationErrors, ThrowWhereAnotherReadingHasNoSuchNumber) {
  const auto table = tabulated_profile("Hertz", sample(hertz, 40));
  const double nan = std::nan("");
  EXPECT_THROW(interpolation_errors(
                   table, [&](const Profile& p, double) { return std::vector{&p == table.profile.get() ? 1.0 : nan}; }),
               std::domain_error);
}

TEST(TabulatedProfile, ConvergesWithTheThirdPower) {
  const auto error = [](int intervals) {
    const auto table = tabulated_profile("Hertz", sample(hertz, intervals, true));
    return std::abs(table.profile->moment_share(at(0.5)).deficit / hertz_profile().moment_share(at(0.5)).deficit - 1);
  };
  EXPECT_LT(error(200) / error(100), 0.2);
  EXPECT_LT(error(1000), 1e-8);
}

TEST(TabulatedProfile, KnowsNoUnits) {
  auto points = sample(hertz, 30, true);
  const auto table = tabulated_profile("one", points);
  for (auto& point : points) point = {.radius = point.radius * 0x1p-200, .pressure = point.pressure * 0x1p900};
  const auto scaled = tabulated_profile("other", points);
  EXPECT_EQ(scaled.radius, 0x1p-200);
  EXPECT_EQ(scaled.mean_pressure, table.mean_pressure * 0x1p900);
  EXPECT_EQ(scaled.profile->twist_integral(at(0.4)), table.profile->twist_integral(at(0.4)));
  EXPECT_EQ(scaled.profile->moment_share(at(0.4)).excess, table.profile->moment_share(at(0.4)).excess);
}

TEST(TabulatedProfile, RefusesWhatIsNoContactPressure) {
  const auto refused = [](std::vector<PressurePoint> points, const std::string& value, const std::string& allowed) {
    EXPECT_THAT([&] { tabulated_profile("T", points); },
                ThrowsMessage<std::invalid_argument>(AllOf(HasSubstr("T"), HasSubstr(value), HasSubstr(allowed))));
  };
  const double nan = std::nan("");
  refused({}, "0 points", "at least 16");
  refused({{0, 3}, {1, 2}, {2, 0}}, "3 points", "at least 16");
  refused(sample(hertz, 8), "9 points", "at least 16");
  refused(sample(hertz, 14), "15 points", "at least 16");
  refused({{0.1, 3}, {1, 2}, {2, 1}, {3, 0}}, "point 1: radius = 0.1", "0 at the first point");
  refused({{nan, 3}, {1, 2}, {2, 1}, {3, 0}}, "point 1: radius = nan", "0 at the first point");
  refused({{0, 3}, {1, 2}, {1, 1}, {3, 0}}, "point 3: radius = 1", "more than the one before, 1");
  refused({{0, 3}, {1, 2}, {nan, 1}, {3, 0}}, "point 3: radius = nan", "more than the one before, 1");
  refused({{0, 3}, {1, 2}, {2, 1}, {HUGE_VAL, 0}}, "point 4: radius = inf", "finite");
  refused({{0, 3}, {1, -2}, {2, 1}, {3, 0}}, "point 2: pressure = -2", "not negative");
  refused({{0, 3}, {1, nan}, {2, 1}, {3, 0}}, "point 2: pressure = nan", "finite");
  refused({{0, 3}, {1, HUGE_VAL}, {2, 1}, {3, 0}}, "point 2: pressure = inf", "finite");
  refused({{0, 3}, {1, 2}, {2, 0}, {3, 0}}, "point 3: pressure = 0", "> 0 except at the last point");
  refused({{0, 0}, {1, 0}, {2, 0}, {3, 0}}, "point 1: pressure = 0", "> 0 except at the last point");
  refused(sample([](double r) { return r < 0.6 ? 1.0 : 8.0; }, 15), "point", "pressures that fall outwards");
}

}  // namespace
}  // namespace slipstick::analytic
