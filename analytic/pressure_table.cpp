#include "analytic/tabulated_pressure.hpp"

#include <fmt/core.h>

#include <charconv>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

namespace slipstick::analytic {

namespace {

/// Bytes of a table, a hundred times as many as resolve any pressure.
constexpr std::uintmax_t kLargestPressureTable = std::uintmax_t{1} << 20;
/// Characters of a line that a message shows.
constexpr std::size_t kMaxShown = 200;
/// Written by some programs at the beginning of a text.
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view trimmed(std::string_view text) {
  constexpr std::string_view kSpace = " \t\r";
  const auto first = text.find_first_not_of(kSpace);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kSpace) - first + 1);
}

double parse_number(std::string_view text, std::string_view what, const std::string& where) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size())
    throw std::invalid_argument(
        fmt::format("{}: {} = {}; allowed: a number", where, what, text.substr(0, kMaxShown)));
  return value;
}

PressurePoint parse_point(std::string_view line, const std::string& where) {
  const auto comma = line.find(',');
  if (comma == std::string_view::npos || line.find(',', comma + 1) != std::string_view::npos)
    throw std::invalid_argument(
        fmt::format("{}: {}; allowed: radius,pressure", where, line.substr(0, kMaxShown)));
  return {.radius = parse_number(trimmed(line.substr(0, comma)), "radius", where),
          .pressure = parse_number(trimmed(line.substr(comma + 1)), "pressure", where)};
}

bool is_header(std::string_view line) {
  const auto comma = line.find(',');
  return comma != std::string_view::npos && trimmed(line.substr(0, comma)) == "radius" &&
         trimmed(line.substr(comma + 1)) == "pressure";
}

/// Folders, devices and pipes have no size.
std::ifstream open_table(const std::string& file) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(file, error);
  std::ifstream stream;
  if (!error && size <= kLargestPressureTable) stream.open(file);
  if (!stream.is_open()) {
    const std::string reason = size > kLargestPressureTable && !error ? "it is larger"
                               : error                                ? error.message()
                                                                      : "permission denied";
    throw std::invalid_argument(fmt::format("{}: cannot be read ({}); allowed: a CSV file of at most {} MiB",
                                            file, reason, kLargestPressureTable >> 20));
  }
  return stream;
}

}  // namespace

TabulatedProfile read_tabulated_profile(const std::string& file) {
  std::ifstream stream = open_table(file);
  std::vector<PressurePoint> points;
  std::vector<std::string> places;
  std::size_t number = 0;
  for (std::string text; std::getline(stream, text);) {
    ++number;
    if (number == 1 && text.starts_with(kByteOrderMark)) text.erase(0, kByteOrderMark.size());
    const std::string_view line = trimmed(text);
    if (line.empty() || line.front() == '#' || (points.empty() && is_header(line))) continue;
    places.push_back(fmt::format("{}:{}", file, number));
    points.push_back(parse_point(line, places.back()));
  }
  return tabulated_profile(file, std::move(points), places);
}

}  // namespace slipstick::analytic
