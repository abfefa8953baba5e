#include "convergence/results/result_parts.hpp"

#include <fmt/core.h>

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace slipstick::convergence {
namespace {

bool follow(const Json& at, std::string_view rest, FoundQuantity& found);

bool follow_key(const Json& at, std::string_view rest, FoundQuantity& found) {
  for (const auto& [key, child] : at.items()) {
    if (!rest.starts_with(key)) continue;
    std::string_view below = rest.substr(key.size());
    if (!below.empty() && below.front() != '.' && below.front() != '[') continue;
    if (child.is_null()) found.reason = at.value(key + "_reason", "");
    if (below.starts_with('.')) below.remove_prefix(1);
    if (follow(child, below, found)) return true;
  }
  return false;
}

bool follow_index(const Json& at, std::string_view rest, FoundQuantity& found) {
  const std::size_t close = rest.find(']');
  if (!rest.starts_with('[') || close == std::string_view::npos) return false;
  std::size_t index = 0;
  const auto [end, error] = std::from_chars(rest.data() + 1, rest.data() + close, index);
  if (error != std::errc() || end != rest.data() + close || index >= at.size()) return false;
  std::string_view below = rest.substr(close + 1);
  if (below.starts_with('.')) below.remove_prefix(1);
  return follow(at[index], below, found);
}

bool follow(const Json& at, std::string_view rest, FoundQuantity& found) {
  if (rest.empty()) {
    found.value = &at;
    return true;
  }
  found.within.push_back(&at);
  if (at.is_object() && follow_key(at, rest, found)) return true;
  if (at.is_array() && follow_index(at, rest, found)) return true;
  found.within.pop_back();
  return false;
}

void collect(const Json& at, const std::string& path, std::vector<std::string>& paths) {
  if (!at.is_structured()) paths.push_back(path);
  for (std::size_t i = 0; at.is_array() && i < at.size(); ++i) {
    collect(at[i], fmt::format("{}[{}]", path, i), paths);
  }
  if (!at.is_object()) return;
  for (const auto& [key, child] : at.items()) {
    collect(child, path.empty() ? key : fmt::format("{}.{}", path, key), paths);
  }
}

}  // namespace

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

void set_numbers(Json& object, std::initializer_list<std::pair<const char*, const Number&>> numbers) {
  for (const auto& [key, number] : numbers) set_number(object, key, number);
}

std::string number_text(double value, std::string_view format) {
  return std::isnan(value) ? "-" : fmt::format(fmt::runtime(format), value);
}

std::string short_text(double value) { return number_text(value, "{:.4g}"); }

std::string percent_text(double part) {
  if (std::isnan(part)) return "-";
  const double percent = 100.0 * part;
  if (!(percent < 1e4)) return "over 10,000 %";
  return percent < 100.0 ? fmt::format("{:.2g} %", percent) : fmt::format("{:.0f} %", percent);
}

std::string text_line(const std::string& label, const std::string& value) {
  return fmt::format("  {:<16} {}\n", label, value);
}

FoundQuantity find_quantity(const Json& result, const std::string& path) {
  FoundQuantity found;
  if (!path.empty()) follow(result, path, found);
  return found;
}

double number_at(const Json& result, const std::string& path) {
  const FoundQuantity found = find_quantity(result, path);
  return found.value != nullptr && found.value->is_number() ? found.value->get<double>() : NAN;
}

double size_at(const Json& result, const std::string& path) {
  const FoundQuantity found = find_quantity(result, path);
  if (found.value == nullptr) return std::nan("");
  const Json& value = *found.value;
  if (value.is_array() && value.size() == 2) return std::hypot(value[0].get<double>(), value[1].get<double>());
  return value.is_number() ? std::abs(value.get<double>()) : std::nan("");
}

std::string text_at(const Json& result, const char* key) {
  const auto found = result.is_object() ? result.find(key) : result.end();
  return found != result.end() && found->is_string() ? found->get<std::string>() : "";
}

bool is_failed(const Json& result) {
  const std::string status = text_at(result, "status");
  return status == "failed" || status == "refused";
}

bool is_converged(const Json& result) { return text_at(result, "status") == "converged"; }

std::string why_missing(const Json& result, const std::string& path) {
  const FoundQuantity found = find_quantity(result, path);
  if (found.value != nullptr && found.value->is_number()) return "";
  if (!found.reason.empty()) return found.reason;
  return result.value("message", "the result does not have it");
}

double seconds_of(const Json& result) {
  return number_at(result, result.contains("history") ? "history.seconds" : "seconds.total");
}

std::vector<std::string> quantity_paths(const Json& result) {
  std::vector<std::string> paths;
  collect(result, "", paths);
  return paths;
}

}  // namespace slipstick::convergence
