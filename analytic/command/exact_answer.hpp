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

/// The answers of the command `exact`, their JSON, and their text for a person.
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
  std::string name;  ///< of the profile, as typed
  NamedProfile profile;
  std::optional<Units> units;
};

/// The state that was asked for, of any profile.
using StateOf = std::function<TorsionState(const Profile&)>;

/// A number, or the reason why it is missing.
struct Number {
  double value;
  std::string missing = {};
};

struct AtRadius {
  double radius;
  Number number;
};
using AtRadii = std::vector<AtRadius>;

/// Stresses at a point, and with a friction coefficient how severe both parts are together.
struct AtPoint {
  BodyPoint at;
  PressureStress pressure;
  TorsionStress torsion;
  std::optional<Severity> severity = {};
  std::optional<double> yield_pressure = {};  ///< Pa: p0 at first yield
  std::optional<double> yield_load = {};      ///< N: the normal load, at the same M/M_lim
};
using AtPoints = std::vector<AtPoint>;
AtPoints at_points(const StressField& field, const std::vector<BodyPoint>& points, double poisson,
                   const std::optional<double>& friction);

struct StateNumbers {
  TorsionState state;
  AtRadii traction;
  AtRadii pressure;
};

/// Estimated errors of a table's numbers.
struct TableErrors {
  StateNumbers numbers;
  double moment_limit;
  double mean_pressure;
};

/// Of a sphere: the paper's equations as printed, and each of approximations().
struct OtherLaws {
  AtRadii equation_1;
  Number equation_5;
  Number equation_7;
  std::vector<Number> law_twists;
};

struct CyclePoint {
  CycleState state;
  AtRadii traction;
  AtPoints stresses = {};
};

/// A result in SI units.
struct UnitsRow {
  const char* key;
  const char* label;
  const char* unit;
  double value;
};

/// One state of first loading, tractions at some radii, and the way back from there to another M/M_lim.
struct StateAnswer {
  ExactContact contact;
  StateNumbers numbers;
  Number energy_lost_per_cycle;
  AtPoints stresses = {};
  std::optional<CyclePoint> unloaded = {};
  std::optional<TableErrors> errors = {};
  std::string errors_missing = {};  ///< the reason, where a table's errors are
  std::optional<OtherLaws> printed = {};
  std::vector<UnitsRow> units = {};
};
StateAnswer answer_state(const ExactContact& contact, const StateOf& state_of, const std::vector<double>& radii,
                         const std::optional<double>& unload_to);
Json to_json(const StateAnswer& answer);
void write(std::ostream& out, const StateAnswer& answer);

/// A history of loads at constant normal load: turning points M/M_lim in turn.
struct HistoryAnswer {
  ExactContact contact;
  std::vector<CyclePoint> history = {};
  std::vector<CycleState> curve = {};
  std::vector<UnitsRow> units = {};
};
HistoryAnswer answer_history(const ExactContact& contact, const std::vector<double>& turning_points,
                             int points_per_branch, const std::vector<double>& radii);
Json to_json(const HistoryAnswer& answer);
void write(std::ostream& out, const HistoryAnswer& answer);

/// One state of first loading with proven digits.
struct CertifiedAnswer {
  ExactContact contact;
  std::vector<std::string> radii;
  certified::State state;
};
Json to_json(const CertifiedAnswer& answer);
void write(std::ostream& out, const CertifiedAnswer& answer);

}  // namespace slipstick::analytic
