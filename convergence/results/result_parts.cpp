#include "convergence/results/result_parts.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace slipstick::convergence {
void set_missing(Json& object, const std::string& key, const std::string& reason) {
  object[key] = nullptr;
  object[key + "_reason"] = reason;
}

void set_number(Json& object, const std::string& key, double value, const std::string& reason) {
  if (std::isfinite(value)) {
    object[key] = value;
  } else {
    set_missing(object, key, reason);
  }
}

void set_number(Json& object, const std::string& key, const Number& number) {
  set_number(object, key, number, number.why_missing);
}

namespace {

double number_of(const Json& json) { return json.is_number() ? json.get<double>() : NAN; }

}  // namespace

std::string number_text(double value, std::string_view format) {
  return std::isnan(value) ? "-" : fmt::format(fmt::runtime(format), value);
}

std::string number_text(const Json& value, std::string_view format) {
  return number_text(number_of(value), format);
}

std::string short_text(double value) { return number_text(value, "{:.4g}"); }

std::string short_text(const Json& value) { return short_text(number_of(value)); }

std::string percent_text(double part) {
  if (std::isnan(part)) return "-";
  const double percent = 100.0 * part;
  if (!(percent < 1e4)) return "over 10,000 %";
  return percent < 100.0 ? fmt::format("{:.2g} %", percent) : fmt::format("{:.0f} %", percent);
}

std::string percent_text(const Json& part) { return percent_text(number_of(part)); }

std::string text_line(const std::string& label, const std::string& value) {
  return fmt::format("  {:<16} {}\n", label, value);
}

}  // namespace slipstick::convergence
