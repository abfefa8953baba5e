#include "solver/input/units.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace slipstick::solver {
namespace {

constexpr std::string_view kDegrees = "deg";
constexpr double kDegree = std::numbers::pi / 180.0;

}  // namespace

const Unit* find_unit(std::string_view word) {
  const auto* const found = std::ranges::find(kUnits, word, &Unit::word);
  return found == kUnits.end() ? nullptr : found;
}

std::optional<double> parse_number(std::string_view text, int power) {
  double plain_value = 0.0;
  const char* const last = text.data() + text.size();
  if (const auto [end, error] = std::from_chars(text.data(), last, plain_value);
      power == 0 && error == std::errc() && end == last)
    return plain_value;
  std::string plain(text);
  std::ranges::replace(plain, ',', '.');
  if (power != 0 && plain.find_first_of("nN") == std::string::npos) {
    const std::size_t mantissa = std::min(plain.find_first_of("eEdD"), plain.size());
    const long written = mantissa < plain.size() ? std::strtol(plain.c_str() + mantissa + 1, nullptr, 10) : 0;
    plain = plain.substr(0, mantissa) + fmt::format("e{}", std::clamp(written, -9999L, 9999L) + power);
  } else if (const auto exponent = plain.find_first_of("dD"); exponent != std::string::npos) {
    plain[exponent] = 'e';
  }
  char* end = nullptr;
  const double value = std::strtod(plain.c_str(), &end);
  if (plain.empty() || end != plain.c_str() + plain.size()) return {};
  return value;
}

void Units::use(std::string_view si, std::string_view word) { words_.emplace(si, word); }

std::optional<double> Units::read(std::string_view text, std::string_view si) {
  const std::string number(text.substr(0, text.find_first_not_of("0123456789.eE+-")));
  const std::size_t blanks = std::min(text.find_first_not_of(' ', number.size()), text.size());
  const std::string_view word = text.substr(blanks);
  const Unit* const unit = find_unit(word);
  const bool degrees = si == "rad" && word == kDegrees;
  if (!degrees && (unit == nullptr || unit->si != si)) return {};
  const auto value = parse_number(number, degrees ? 0 : unit->power);
  if (!value) return {};
  use(si, word);
  return degrees ? *value * kDegree : *value;
}

std::string Units::word(const std::string& si) const {
  const auto found = words_.find(si);
  return found == words_.end() ? si : found->second;
}

double Units::of(const std::string& si, double value) const {
  const std::string used = word(si);
  if (used == kDegrees) return value / kDegree;
  const Unit* const unit = find_unit(used);
  return unit == nullptr ? value : value * std::pow(10.0, -unit->power);
}

std::string Units::pair_text(const std::string& si, const std::array<double, 2>& values) const {
  return fmt::format(R"(["{0:.5g} {2}", "{1:.5g} {2}"])", of(si, values[0]), of(si, values[1]), word(si));
}

std::string Units::list(std::string_view si) {
  std::string list;
  for (const Unit& unit : kUnits) {
    const bool plain = std::ranges::all_of(unit.word, [](char c) { return c >= ' '; });
    if (unit.si == si && !si.empty() && plain) list += fmt::format("{}{}", list.empty() ? "" : ", ", unit.word);
  }
  return si == "rad" ? fmt::format("{}, {}", list, kDegrees) : list;
}

}  // namespace slipstick::solver
