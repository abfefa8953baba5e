#include "analytic/exact_command.hpp"

#include <fmt/core.h>

#include <array>
#include <memory>
#include <optional>
#include <ostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "analytic/paper_equations.hpp"
#include "analytic/torsion.hpp"

namespace slipstick::analytic {

namespace {

using Json = nlohmann::ordered_json;

/// One way to name a state.
struct Given {
  const char* option;
  const char* help;
  TorsionState (*state)(double, const Profile&);
};

constexpr std::array kGiven{
    Given{"--moment-ratio", "M/M_lim, in [0, 1)", from_moment_ratio},
    Given{"--moment-deficit", "1 - M/M_lim, in (0, 1]", from_moment_deficit},
    Given{"--stick-ratio", "a_s/a, in (0, 1]", from_stick_ratio},
    Given{"--stick-complement", "1 - a_s/a, in [0, 1)", from_stick_complement},
    Given{"--twist", "G a^2 phi/(mu W), from 0", from_twist},
};

struct Options {
  std::array<double, kGiven.size()> value{};
  std::array<const CLI::Option*, kGiven.size()> option{};
  std::vector<double> radii;
  std::string profile = "hertz";
};

/// What an equation gives as printed, or why it gives nothing there.
struct Printed {
  std::optional<double> value;
  std::string reason;
};

template <class Equation>
Printed as_printed(Equation equation) {
  try {
    return {.value = equation(), .reason = {}};
  } catch (const std::domain_error& error) {
    return {.value = std::nullopt, .reason = error.what()};
  }
}

struct TractionAt {
  double radius;
  double exact;
  Printed equation_1;
};

struct Answer {
  TorsionState state;
  Printed equation_5;
  Printed equation_7;
  std::vector<TractionAt> tractions;
};

/// An error of range, with the option that brought the value.
template <class Function>
auto naming(const std::string& option, Function function) {
  try {
    return function();
  } catch (const std::domain_error& error) {
    throw std::domain_error(fmt::format("{}: {}", option, error.what()));
  }
}

TorsionState given_state(const Options& options) {
  for (std::size_t i = 0; i < kGiven.size(); ++i)
    if (options.option[i]->count() > 0)
      return naming(kGiven[i].option, [&] { return kGiven[i].state(options.value[i], hertz_profile()); });
  throw std::invalid_argument("exact: no state given");
}

Answer answer(const Options& options) {
  Answer answer{.state = given_state(options), .equation_5 = {}, .equation_7 = {}, .tractions = {}};
  const TorsionState& state = answer.state;
  answer.equation_5 = as_printed([&] { return paper::eq5_moment(state.stick_ratio); });
  answer.equation_7 = as_printed([&] { return paper::eq7_twist(state.moment); });
  for (const double r : options.radii)
    answer.tractions.push_back(
        {.radius = r,
         .exact = naming("--radius", [&] { return traction(state, r); }),
         .equation_1 = as_printed([&] { return paper::eq1_printed(state.stick_ratio, r); })});
  return answer;
}

void put(Json& object, const std::string& key, const Printed& printed) {
  object[key] = printed.value ? Json(*printed.value) : Json(nullptr);
  if (!printed.value) object[key + "_reason"] = printed.reason;
}

Json as_json(const Answer& answer) {
  const TorsionState& state = answer.state;
  Json tractions = Json::array();
  Json equation_1 = Json::array();
  for (const TractionAt& at : answer.tractions) {
    tractions.push_back({{"radius", at.radius}, {"value", at.exact}});
    Json& entry = equation_1.emplace_back(Json{{"radius", at.radius}});
    put(entry, "value", at.equation_1);
  }
  Json printed{{"equation_1", equation_1}};
  put(printed, "equation_5", answer.equation_5);
  put(printed, "equation_7", answer.equation_7);
  return {{"moment_ratio", state.moment_ratio},
          {"moment_deficit", state.moment_deficit},
          {"stick_ratio", state.stick_ratio},
          {"stick_complement", state.stick_complement},
          {"twist", state.twist},
          {"moment", state.moment},
          {"tangent_stiffness", state.tangent_stiffness},
          {"traction", tractions},
          {"printed", printed}};
}

void write_row(std::ostream& out, const std::string& name, const std::string& symbol, double exact) {
  out << fmt::format("{:<18}{:<20}{:>23.15g}", name, symbol, exact);
}

void write_printed(std::ostream& out, const char* equation, double exact, const Printed& printed) {
  if (!printed.value)
    out << fmt::format("  {}: none ({})", equation, printed.reason);
  else if (exact == 0)
    out << fmt::format("{:>23.15g}{:>12}  {}", *printed.value, "", equation);
  else
    out << fmt::format("{:>23.15g}{:>+12.1e}  {}", *printed.value, *printed.value / exact - 1, equation);
  out << '\n';
}

void write_text(std::ostream& out, const Answer& answer) {
  const TorsionState& state = answer.state;
  out << "Sphere in torsion on a half-space: stick for r < a_s, slip for a_s < r < a (contact radius).\n"
         "1/G = 1/G_1 + 1/G_2, mu friction, W normal load, p0 peak pressure, M_lim = 3 pi/16 mu W a.\n\n";
  out << fmt::format("{:<38}{:>23}{:>23}{:>12}\n", "", "exact", "as printed", "difference");
  write_row(out, "moment ratio", "M/M_lim", state.moment_ratio);
  out << '\n';
  write_row(out, "moment deficit", "1 - M/M_lim", state.moment_deficit);
  out << '\n';
  write_row(out, "stick ratio", "a_s/a", state.stick_ratio);
  out << '\n';
  write_row(out, "stick complement", "1 - a_s/a", state.stick_complement);
  out << '\n';
  write_row(out, "twist", "G a^2 phi/(mu W)", state.twist);
  write_printed(out, "Eq. (7)", state.twist, answer.equation_7);
  write_row(out, "moment", "M/(mu W a)", state.moment);
  write_printed(out, "Eq. (5)", state.moment, answer.equation_5);
  write_row(out, "tangent stiffness", "dM/dphi/(G a^3)", state.tangent_stiffness);
  out << '\n';
  for (const TractionAt& at : answer.tractions) {
    write_row(out, "traction q/(mu p0)", fmt::format(" at r/a = {:.9g}", at.radius), at.exact);
    write_printed(out, "Eq. (1)", at.exact, at.equation_1);
  }
}

}  // namespace

std::function<int(std::ostream&, Json&)> add_exact_command(CLI::App& app) {
  CLI::App* exact =
      app.add_subcommand("exact", "exact solution of the sphere in torsion, beside the paper's equations");
  const auto options = std::make_shared<Options>();
  CLI::Option_group* given = exact->add_option_group("state", "exactly one of these");
  for (std::size_t i = 0; i < kGiven.size(); ++i)
    options->option[i] = given->add_option(kGiven[i].option, options->value[i], kGiven[i].help);
  given->require_option(1);
  exact->add_option("--radius", options->radii, "r/a, in [0, 1], where to give the traction: r1,r2,...")
      ->delimiter(',');
  exact->add_option("--profile", options->profile, "pressure profile: hertz")
      ->check(CLI::IsMember({"hertz"}));
  exact->footer("Example: slipstick exact --moment-ratio 0.9 --radius 0.2,0.5,0.8");
  return [options](std::ostream& out, Json& result) {
    const Answer found = answer(*options);
    write_text(out, found);
    result = as_json(found);
    return 0;
  };
}

}  // namespace slipstick::analytic
