#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace slipstick::solver {

/// A unit that files may use: 10^power of its SI unit.
struct Unit {
  std::string_view word;
  std::string_view si;
  int power;
};
inline constexpr std::array<Unit, 29> kUnits{
    {{"m", "m", 0},          {"cm", "m", -2},    {"mm", "m", -3},    {"um", "m", -6},    {"\xC2\xB5m", "m", -6},
     {"\xCE\xBCm", "m", -6}, {"nm", "m", -9},    {"Pa", "Pa", 0},    {"kPa", "Pa", 3},   {"MPa", "Pa", 6},
     {"GPa", "Pa", 9},       {"N/m2", "Pa", 0},  {"N/m^2", "Pa", 0}, {"N/mm2", "Pa", 6}, {"N/mm^2", "Pa", 6},
     {"N", "N", 0},          {"mN", "N", -3},    {"kN", "N", 3},     {"N m", "N m", 0},  {"Nm", "N m", 0},
     {"N mm", "N m", -3},    {"Nmm", "N m", -3}, {"kN m", "N m", 3}, {"rad", "rad", 0},  {"mrad", "rad", -3},
     {"s", "s", 0},          {"ms", "s", -3},    {"-", "", 0},       {"%", "", -2}}};

/// Null: there is none of this name.
const Unit* find_unit(std::string_view word);

/// A number with a decimal point or comma, times a power of ten, rounded once, so that the power of ten
/// changes no digit. Fortran's D is read as e.
std::optional<double> parse_number(std::string_view text, int power);

/// The units in which a file gives its numbers, to print results in them. Angles may be in degrees too.
class Units {
 public:
  /// The units for SI units.
  using Words = std::map<std::string, std::string>;

  explicit Units(Words words = {}) : words_(std::move(words)) {}

  /// A number of an SI unit is in a unit; the first one for each SI unit stays.
  void use(std::string_view si, std::string_view word);
  /// The value in SI of a text such as "10 mm", whose unit is used from now on; none where it is no number
  /// with a unit of this kind.
  std::optional<double> read(std::string_view text, std::string_view si);

  const Words& words() const { return words_; }
  /// The unit for an SI unit: itself where none is used.
  std::string word(const std::string& si) const;
  /// A value in SI in that unit.
  double of(const std::string& si, double value) const;

  /// Two values in SI as a scene may give them: ["1.5 mm", "2 mm"].
  std::string pair_text(const std::string& si, const std::array<double, 2>& values) const;

  /// The units for an SI unit, "m, cm, mm"; empty: there is none.
  static std::string list(std::string_view si);

 private:
  Words words_;
};

}  // namespace slipstick::solver
