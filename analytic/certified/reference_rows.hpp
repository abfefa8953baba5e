#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "analytic/certified/certified.hpp"

/// Proven values at doubles, as the tests and studies of code in doubles compare with them.
namespace slipstick::analytic::certified {

/// Quantities by name: those that name a state, and those of a row.
inline const std::map<std::string, Quantity> kQuantities{{"moment_ratio", Quantity::moment_ratio},
                                                         {"moment_deficit", Quantity::moment_deficit},
                                                         {"stick_ratio", Quantity::stick_ratio},
                                                         {"stick_complement", Quantity::stick_complement},
                                                         {"twist", Quantity::twist}};

inline const std::map<std::string, Number State::*> kMembers{{"moment_ratio", &State::moment_ratio},
                                                             {"moment_deficit", &State::moment_deficit},
                                                             {"stick_ratio", &State::stick_ratio},
                                                             {"stick_complement", &State::stick_complement},
                                                             {"twist", &State::twist}};

/// One row of a table: a quantity of the state where `given` has `value`, both names as in TorsionState, or
/// the traction at the radius `at`. Doubles stand for themselves exactly.
struct ReferenceRow {
  std::string profile;
  std::string given;
  double value;
  std::string quantity;
  std::optional<double> at;
  Number reference;
  double cost;  ///< |d ln quantity/d ln value|; of a traction its sum over value and at
};

/// The line of a CSV file, and what stands above such lines.
std::string line(const ReferenceRow& row);
std::string head(const std::string& made_by);

/// Rows of all quantities but the one given; or of a traction. Throw as certified::state.
std::vector<ReferenceRow> state_rows(const std::string& profile, const std::string& given, double value,
                                     int digits);
ReferenceRow traction_row(const std::string& profile, const std::string& given, double value, double radius,
                          int digits);

}  // namespace slipstick::analytic::certified
