#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "convergence/results/solve_record.hpp"

/// Numbers in JSON and in text for people.
namespace slipstick::convergence {

/// Sets a key to null, and the key with "_reason" to the reason.
void set_missing(Json& object, const std::string& key, const std::string& reason);

/// The same of a number with its own reason.
void set_number(Json& object, const std::string& key, const Number& number);
void set_numbers(Json& object, std::initializer_list<std::pair<const char*, const Number&>> numbers);

/// JSON has no NaN and no infinity: such a number is missing.
void set_number(Json& object, const std::string& key, double value, const std::string& reason);

/// A number for a person, as fmt::format() writes it; "-" where it is NaN.
std::string number_text(double value, std::string_view format = "{:.6g}");

/// The same with four digits.
std::string short_text(double value);

/// A part of a whole in percent: "0.028 %", "130 %"; "-" where it is NaN.
std::string percent_text(double part);

/// One line of a result's text.
std::string text_line(const std::string& label, const std::string& value);

/// One value of a result.
struct FoundQuantity {
  const Json* value = nullptr;      ///< null pointer: there is none of this name
  std::vector<const Json*> within;  ///< what it stands in, the whole result first
  std::string reason;               ///< why the value, or what it should stand in, is null in the result
};

/// Follows a path into a result: keys joined by dots, places in lists (counted from 0) in brackets, as in
/// steps[3].traction_error.l2. Keys may hold dots themselves, as names of series do. The result must outlive
/// what is returned.
FoundQuantity find_quantity(const Json& result, const std::string& path);

/// The number at a path; NaN where there is none.
double number_at(const Json& result, const std::string& path);

/// The size of a number of a result, or the length of a pair; NaN where there is none.
double size_at(const Json& result, const std::string& path);

/// The text of a key; empty where there is none.
std::string text_at(const Json& result, const char* key);

/// Whether a result says that its solve failed or was refused, or that it converged.
bool is_failed(const Json& result);
bool is_converged(const Json& result);

/// Why a result has no number at a path: its reason, or its message; empty where it has one.
std::string why_missing(const Json& result, const std::string& path);

/// Seconds of a whole solve, of a history all its steps; NaN where there are none.
double seconds_of(const Json& result);

/// Paths of all numbers, words and nulls of a result.
std::vector<std::string> quantity_paths(const Json& result);

}  // namespace slipstick::convergence
