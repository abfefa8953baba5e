#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "convergence/oracle/errors.hpp"
#include "solver/contact/certificate.hpp"
#include "solver/solution.hpp"

/// Parts that all results have, on a grid or not.
namespace slipstick::convergence {

using Json = nlohmann::ordered_json;

/// Sets a key to null, with the reason beside it.
void set_missing(Json& object, const std::string& key, const std::string& reason);

/// JSON has no NaN and no infinity: such a number is missing.
void set_number(Json& object, const std::string& key, double value, const std::string& reason);

/// Errors of fields: of tractions at cell centres, beside it against cell averages, by region.
Json field_error_json(const FieldError& error, const std::string& reason);
Json traction_error_json(const TractionError& error, const std::string& reason);

/// A friction law's words and numbers, and the force that slides the contact, in N.
void add_friction(Json& json, const solver::FrictionLaw& law, double force);

Json certificate_json(const solver::Certificate& certificate, const std::string& reason);

/// How well the mesh resolves the contact, with a warning where that is little.
Json resolution_json(const solver::Resolution& resolution);

/// The parts of the problem that a model skips.
Json model_json(const std::vector<solver::Omission>& left_out);

/// The most memory that this process has held, in bytes.
std::size_t peak_bytes();

/// A number for a person, as fmt::format() writes it; "-" where there is none.
std::string number_text(const Json& value, std::string_view format = "{:.6g}");

/// A part of a whole in percent, written out: "0.028 %", "130 %"; "-" where it is no number.
std::string percent_text(const Json& part);

/// The same with four digits.
std::string short_text(const Json& value);

/// The bound of a result's law of friction, "mu p"; and the angle between slip and traction that any law asks
/// for.
std::string bound_text(const Json& result);
std::string right_direction_text(const Json& result);

/// One line of a result's text.
std::string text_line(const std::string& label, const std::string& value);

}  // namespace slipstick::convergence
