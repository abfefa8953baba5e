#pragma once

#include <array>
#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analytic/certified/certified.hpp"
#include "analytic/cycle.hpp"
#include "analytic/named_profile.hpp"
#include "analytic/stresses/stress_field.hpp"
#include "analytic/torsion.hpp"

/// The answers of the command `exact` as JSON, and their text for a person, which is made from the JSON. A number that
/// is missing is null, with the reason under its key with the ending _reason.
namespace slipstick::analytic {

using Json = nlohmann::ordered_json;

/// A number that every state has, proven or not: its key in the JSON, and its name and symbol for a person.
struct ExactQuantity {
  const char* key;
  const char* label;
  const char* symbol;
  double TorsionState::*member;
  certified::Number certified::State::*certified;
};
inline constexpr std::array kExactQuantities{
    ExactQuantity{"moment_ratio", "moment ratio", "M/M_lim", &TorsionState::moment_ratio,
                  &certified::State::moment_ratio},
    ExactQuantity{"moment_deficit", "moment deficit", "1 - M/M_lim", &TorsionState::moment_deficit,
                  &certified::State::moment_deficit},
    ExactQuantity{"stick_ratio", "stick ratio", "a_s/a", &TorsionState::stick_ratio, &certified::State::stick_ratio},
    ExactQuantity{"stick_complement", "stick complement", "1 - a_s/a", &TorsionState::stick_complement,
                  &certified::State::stick_complement},
    ExactQuantity{"twist", "twist", "G a^2 phi/(mu W)", &TorsionState::twist, &certified::State::twist},
    ExactQuantity{"moment", "moment", "M/(mu W a)", &TorsionState::moment, &certified::State::moment},
    ExactQuantity{"tangent_stiffness", "tangent stiffness", "dM/dphi/(G a^3)", &TorsionState::tangent_stiffness,
                  &certified::State::tangent_stiffness},
};

/// The normal side in SI units, and the constants that turn dimensionless results into SI units.
struct Units {
  Indentation indentation;
  double load;                          ///< N
  std::optional<double> friction;       ///< mu
  std::optional<double> shear_modulus;  ///< combined G, 1/G = 1/G_1 + 1/G_2, Pa
};

/// The contact asked about.
struct ExactContact {
  NamedProfile profile;
  std::optional<Units> units;
};

/// The state that was asked for, of any profile.
using StateOf = std::function<TorsionState(const Profile&)>;

/// Stresses at the points of --at, in a field whose slip ends at the radius `front`.
using StressesOf = std::function<Json(const StressField& field, double front)>;

/// The stresses at a point, and with a friction coefficient how severe both parts are together.
Json stresses_at(BodyPoint at, const StressField& field, double poisson, const std::optional<double>& friction);

/// One state of first loading, tractions at some radii, and the way back from there to another M/M_lim; of a sphere
/// also the paper's equations as printed, and each of approximations().
Json answer_state(const ExactContact& contact, const StateOf& state_of, const std::vector<double>& radii,
                  const std::optional<double>& unload_to, const StressesOf& stresses_of);
void write_state(std::ostream& out, const Json& answer);

/// A history of loads at constant normal load: turning points M/M_lim in turn, and the curve through them.
Json answer_history(const ExactContact& contact, const std::vector<double>& turning_points, int points_per_branch,
                    const std::vector<double>& radii, const StressesOf& stresses_of);
void write_history(std::ostream& out, const Json& answer);

/// One state of first loading with proven digits.
Json answer_certified(const ExactContact& contact, const certified::State& state,
                      const std::vector<std::string>& radii);
void write_certified(std::ostream& out, const Json& answer);

}  // namespace slipstick::analytic
