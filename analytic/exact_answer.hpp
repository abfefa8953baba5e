#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "analytic/certified/certified.hpp"
#include "analytic/cycle.hpp"
#include "analytic/named_profile.hpp"
#include "analytic/torsion.hpp"

/// What `exact` finds for each kind of question, as JSON and as text.
namespace slipstick::analytic {

using Json = nlohmann::ordered_json;

/// What turns dimensionless numbers into SI units, where the user gave it.
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

/// One state of first loading, tractions at some radii, and the way back from there to another moment.
struct StateQuestion {
  std::function<TorsionState(const Profile&)> state;
  std::vector<double> radii;
  std::optional<double> unload_to;  ///< M/M_lim
};
Json answer_state(const ExactContact& contact, const StateQuestion& question);
void write_state(std::ostream& out, const ExactContact& contact, const Json& answer);

/// A history of loads at constant normal load: turning points M/M_lim in turn.
struct HistoryQuestion {
  std::vector<double> turning_points;
  int points_per_branch;
  std::vector<double> radii;
};
Json answer_history(const ExactContact& contact, const HistoryQuestion& question);
void write_history(std::ostream& out, const ExactContact& contact, const Json& answer);

/// One state of first loading with proven digits.
struct CertifiedQuestion {
  certified::Quantity given;
  std::string value;
  std::vector<std::string> radii;
  int digits;
};
Json answer_certified(const ExactContact& contact, const CertifiedQuestion& question);
void write_certified(std::ostream& out, const ExactContact& contact, const Json& answer);

}  // namespace slipstick::analytic
