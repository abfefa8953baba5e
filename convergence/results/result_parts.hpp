#pragma once

#include <string>
#include <string_view>

#include "convergence/results/solve_record.hpp"

/// Numbers in JSON and in text for people.
namespace slipstick::convergence {

/// Sets a key to null, and the key with "_reason" to the reason.
void set_missing(Json& object, const std::string& key, const std::string& reason);

/// The same of a number with its own reason.
void set_number(Json& object, const std::string& key, const Number& number);

/// JSON has no NaN and no infinity: such a number is missing.
void set_number(Json& object, const std::string& key, double value, const std::string& reason);

/// A number for a person, as fmt::format() writes it; "-" where it is NaN or no number.
std::string number_text(double value, std::string_view format = "{:.6g}");
std::string number_text(const Json& value, std::string_view format = "{:.6g}");

/// The same with four digits.
std::string short_text(double value);
std::string short_text(const Json& value);

/// A part of a whole in percent: "0.028 %", "130 %"; "-" where it is NaN or no number.
std::string percent_text(double part);
std::string percent_text(const Json& part);

/// One line of a result's text.
std::string text_line(const std::string& label, const std::string& value);

}  // namespace slipstick::convergence
