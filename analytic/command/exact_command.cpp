#include "analytic/command/exact_command.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "analytic/command/exact_answer.hpp"
#include "analytic/stresses/largest_stress.hpp"

namespace slipstick::analytic {

namespace {

/// One way to name a state.
struct Given {
  const char* option;
  const char* help;
  TorsionState (*state)(double, const Profile&);
  certified::Quantity quantity;
};

constexpr std::array kGiven{
    Given{"--moment-ratio", "M/M_lim, in [0, 1)", from_moment_ratio, certified::Quantity::moment_ratio},
    Given{"--moment-deficit", "1 - M/M_lim, in (0, 1]", from_moment_deficit, certified::Quantity::moment_deficit},
    Given{"--stick-ratio", "a_s/a, in (0, 1]", from_stick_ratio, certified::Quantity::stick_ratio},
    Given{"--stick-complement", "1 - a_s/a, in [0, 1)", from_stick_complement, certified::Quantity::stick_complement},
    Given{"--twist", "G a^2 phi/(mu W), from 0", from_twist, certified::Quantity::twist},
};

/// Given to --at: the point of the largest von Mises stress.
constexpr std::string_view kMostStressed = "largest";

/// As typed. Numbers stay text for certified digits, which take them to be exactly what is written.
struct Options {
  std::array<std::string, kGiven.size()> value;
  std::array<const CLI::Option*, kGiven.size()> given{};
  std::vector<std::string> radii;
  std::vector<std::string> at;
  double poisson = 0.3;
  std::string profile = "hertz";
  std::optional<int> certified;
  std::optional<double> unload_to;
  std::vector<double> history;
  int points = 50;
  std::optional<double> normal_load;
  std::optional<double> effective_modulus;
  std::vector<double> shape;
  std::optional<double> friction;
  std::optional<double> yield_stress;
  std::optional<double> shear_modulus;
};

/// An error of range or form becomes one with the option that brought the value.
template <class Function>
auto naming(const std::string& option, Function function) {
  try {
    return function();
  } catch (const std::logic_error& error) {
    throw std::runtime_error(option + ": " + error.what());
  }
}

double number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0') throw std::domain_error(fmt::format("\"{}\" is not a number", text));
  return value;
}

std::vector<double> radii(const Options& options) {
  return naming("--radius", [&] {
    std::vector<double> radii;
    for (const std::string& text : options.radii) {
      const double r = number(text);
      if (!(r >= 0 && r <= 1)) throw std::domain_error(fmt::format("r/a = {}; allowed: 0 <= r/a <= 1", r));
      radii.push_back(r);
    }
    return radii;
  });
}

ExactContact contact(const Options& options) {
  if (options.friction && !options.normal_load && options.at.empty())
    throw std::domain_error("--friction: allowed: with --normal-load or --at");
  if (options.yield_stress && std::ranges::find(options.at, kMostStressed) == options.at.end())
    throw std::domain_error("--yield-stress: allowed with --at largest");
  if (!options.normal_load)
    return {.profile = naming("--profile", [&] { return find_profile(options.profile); }), .units = {}};
  PressedContact pressed = naming("--shape", [&] {
    return press(
        options.profile,
        {.load = *options.normal_load, .effective_modulus = *options.effective_modulus, .shape = options.shape});
  });
  return {.profile = std::move(pressed.profile),
          .units = Units{.indentation = pressed.indentation,
                         .load = *options.normal_load,
                         .friction = options.friction,
                         .shear_modulus = options.shear_modulus}};
}

std::size_t given(const Options& options) {
  for (std::size_t i = 0; i < kGiven.size(); ++i)
    if (options.given[i]->count() > 0) return i;
  throw std::invalid_argument("exact: no state given");
}

/// The normal load at which p0 has this value. Where the profile is the same under every load, p0 goes like a
/// power of the load.
double load_of(double pressure, const Options& options, const ExactContact& exact) {
  const PressedContact twice =
      press(options.profile, {2.0 * exact.units->load, *options.effective_modulus, options.shape});
  if (twice.profile.profile->name() != exact.profile.profile->name())
    throw std::domain_error(
        fmt::format("profile {}; allowed with --yield-stress: hertz, power:N, which keep their form under every load",
                    options.profile));
  const double before = exact.units->indentation.reference_pressure;
  const double power = std::log(2.0) / std::log(twice.indentation.reference_pressure / before);
  return exact.units->load * std::pow(pressure / before, power);
}

/// A point of --at, or where the stress is the largest. front: the radius at which slip ends.
BodyPoint point_at(const std::string& text, const Options& options, const StressField& field, double front) {
  if (text != kMostStressed) {
    const auto comma = std::min(text.find(','), text.size());
    return {number(text.substr(0, comma)), number(text.substr(std::min(comma + 1, text.size())))};
  }
  if (!options.friction) throw std::domain_error("\"largest\" is allowed with --friction");
  return largest_stress(field, &Severity::von_mises, *options.friction, options.poisson, front).at;
}

/// The stresses at the points of --at.
StressesOf stresses(const Options& options, const ExactContact& exact) {
  return [&](const StressField& field, double front) {
    return naming("--at", [&] {
      Json list = Json::array();
      for (const std::string& text : options.at) {
        Json point = stresses_at(point_at(text, options, field, front), field, options.poisson, options.friction);
        if (options.yield_stress && text == kMostStressed) {
          const double pressure = *options.yield_stress / point.at("von_mises").get<double>();
          point["yield_pressure"] = pressure;
          if (exact.units) point["yield_load"] = load_of(pressure, options, exact);
        }
        list.push_back(std::move(point));
      }
      return list;
    });
  };
}

Json run(const Options& options, std::ostream& out) {
  const ExactContact exact = contact(options);
  if (!options.history.empty()) {
    Json answer = naming("--history", [&] {
      return answer_history(exact, options.history, options.points, radii(options), stresses(options, exact));
    });
    write_history(out, answer);
    return answer;
  }
  const Given& from = kGiven[given(options)];
  const std::string& text = options.value[given(options)];
  if (options.certified) {
    const auto state = naming("--certified", [&] {
      return certified::state(certified::profile_named(options.profile), from.quantity, text, options.radii,
                              *options.certified);
    });
    Json answer = answer_certified(exact, state, options.radii);
    write_certified(out, answer);
    return answer;
  }
  const double value = naming(from.option, [&] { return number(text); });
  const StateOf state_of = [&](const Profile& any) {
    return naming(from.option, [&] { return from.state(value, any); });
  };
  Json answer = answer_state(exact, state_of, radii(options), options.unload_to, stresses(options, exact));
  write_state(out, answer);
  return answer;
}

void add_state_options(CLI::App& exact, Options& options) {
  CLI::Option_group* given = exact.add_option_group("state", "exactly one of these");
  for (std::size_t i = 0; i < kGiven.size(); ++i)
    options.given[i] = given->add_option(kGiven[i].option, options.value[i], kGiven[i].help);
  CLI::Option* history =
      given->add_option("--history", options.history, "M/M_lim at each turning point: m1,m2,...; gives the curve");
  history->delimiter(',');
  given->require_option(1);
  exact.add_option("--points", options.points, "points of the curve on each branch of the history")
      ->check(CLI::Range(1, 1000000))
      ->needs(history)
      ->capture_default_str();
  CLI::Option* unload =
      exact.add_option("--unload-to", options.unload_to, "M/M_lim to unload to from the state, normal load constant");
  unload->excludes(history);
  CLI::Option* at = exact.add_option("--at", options.at,
                                     "r,z over a, z the depth: stresses there; \"largest\" finds the point of "
                                     "the largest von Mises stress; once for each point");
  exact.add_option("--poisson", options.poisson, "nu of the body whose stresses are asked for")
      ->check(CLI::Range(-1.0, 0.5))
      ->needs(at)
      ->capture_default_str();
  exact
      .add_option("--yield-stress", options.yield_stress,
                  "Pa, in tension: p0 at which the point of --at largest yields, with --normal-load also the "
                  "load, at "
                  "the same M/M_lim")
      ->check(CLI::PositiveNumber)
      ->needs(at);
  exact.add_option("--certified", options.certified, "print each number with N proven digits, 15..100")
      ->check(CLI::Range(15, 100))
      ->excludes(history)
      ->excludes(unload)
      ->excludes(at);
}

void add_units_options(CLI::App& exact, Options& options) {
  CLI::Option* load = exact.add_option("--normal-load", options.normal_load, "W, N: gives results in SI units too");
  CLI::Option* modulus =
      exact.add_option("--effective-modulus", options.effective_modulus, "E*, Pa, 1/E* = sum of (1 - nu_i^2)/E_i");
  CLI::Option* shape = exact.add_option("--shape", options.shape, shape_words())->delimiter(',');
  load->needs(modulus)->needs(shape);
  modulus->needs(load);
  shape->needs(load);
  CLI::Option* friction = exact.add_option("--friction", options.friction,
                                           "mu: with --normal-load moments in N m, with --at von Mises' stress");
  friction->check(CLI::PositiveNumber);
  CLI::Option* shear = exact.add_option("--shear-modulus", options.shear_modulus,
                                        "combined G, Pa, 1/G = 1/G_1 + 1/G_2: gives the twist in rad");
  shear->needs(friction)->needs(load)->check(CLI::PositiveNumber);
}

}  // namespace

std::function<int(std::ostream&, Json&)> add_exact_command(CLI::App& app) {
  CLI::App* exact = app.add_subcommand("exact", "exact solution of an axisymmetric contact in torsion");
  const auto options = std::make_shared<Options>();
  add_state_options(*exact, *options);
  CLI::Option* radius =
      exact->add_option("--radius", options->radii, "r/a, in [0, 1], where to give traction and pressure: r1,r2,...");
  radius->delimiter(',');
  exact->add_option("--profile", options->profile, profile_words())->capture_default_str();
  add_units_options(*exact, *options);
  exact->footer(
      "Examples: slipstick exact --moment-ratio 0.9 --radius 0.2,0.5,0.8\n"
      "          slipstick exact --moment-ratio 0.5 --certified 50\n"
      "          slipstick exact --moment-ratio 0.9 --at 0,0.48 --at largest --friction 0.3\n"
      "          slipstick exact --profile cone --history 0.8,-0.8,0.8 --json loop.json");
  return [options](std::ostream& out, Json& result) {
    result = run(*options, out);
    return 0;
  };
}

}  // namespace slipstick::analytic
