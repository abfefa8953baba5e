#include "analytic/named_profile.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "analytic/pressure_table.hpp"
#include "analytic/punch_superposition.hpp"

namespace slipstick::analytic {

namespace {

/// A name as typed, and its parts before and after the colon.
struct TypedName {
  std::string whole;
  std::string word;
  std::string argument;
};

TypedName split(const std::string& name) {
  const auto colon = std::min(name.find(':'), name.size());
  return {.whole = name,
          .word = name.substr(0, colon),
          .argument = name.substr(std::min(colon + 1, name.size()))};
}

/// What stands after the colon, as a number.
double number(const TypedName& name) {
  char* end = nullptr;
  const double value = std::strtod(name.argument.c_str(), &end);
  if (name.argument.empty() || *end != '\0')
    throw std::invalid_argument(
        fmt::format("profile \"{}\": \"{}\" is not a number", name.whole, name.argument));
  return value;
}

/// A profile that lives as long as the program.
NamedProfile lasting(const Profile& profile) {
  return {.profile = {&profile, [](const Profile*) {}}};
}

NamedProfile tabulated(const TypedName& name) {
  const auto table = std::make_shared<const TabulatedProfile>(read_tabulated_profile(name.argument));
  return {.profile = {table, table->profile.get()}, .table = table};
}

PressedContact press_rounded_punch(const NormalLoad& load) {
  const auto pressed = indent_rounded_punch(load.load, load.shape[0], load.shape[1], load.effective_modulus);
  return {{.profile = rounded_punch_profile(pressed.flat_ratio)}, pressed.contact};
}

struct ProfileRow {
  std::string_view word;
  std::string_view argument;  ///< what stands after the colon, as help writes it; empty: there is no colon
  std::string_view meaning;   ///< of the argument, for help
  NamedProfile (*make)(const TypedName& name);
  /// Numbers of --shape, with commas between them, and their unit; empty: no load presses this profile.
  std::string_view shape = {};
  std::string_view unit = {};
  PressedContact (*press)(const TypedName& name, const NormalLoad& load) = nullptr;
  bool load_gives_argument = false;  ///< load and shape determine the argument, so that a name leaves it out
};

constexpr std::array kProfiles{
    ProfileRow{"hertz", "", "", [](const TypedName&) { return lasting(hertz_profile()); }, "sphere radius",
               "m",
               [](const TypedName&, const NormalLoad& load) {
                 return PressedContact{lasting(hertz_profile()),
                                       indent_sphere(load.load, load.shape[0], load.effective_modulus)};
               }},
    ProfileRow{"cone", "", "", [](const TypedName&) { return lasting(cone_profile()); }, "slope", "",
               [](const TypedName&, const NormalLoad& load) {
                 return PressedContact{lasting(cone_profile()),
                                       indent_cone(load.load, load.shape[0], load.effective_modulus)};
               }},
    ProfileRow{"flat_punch", "", "", [](const TypedName&) { return lasting(flat_punch_profile()); }, "radius",
               "m",
               [](const TypedName&, const NormalLoad& load) {
                 return PressedContact{lasting(flat_punch_profile()),
                                       indent_flat_punch(load.load, load.shape[0], load.effective_modulus)};
               }},
    ProfileRow{"power", "N", "gap ~ r^N",
               [](const TypedName& name) { return NamedProfile{.profile = power_profile(number(name))}; },
               "coefficient of r^N", "m^(1-N)",
               [](const TypedName& name, const NormalLoad& load) { return press_power(number(name), load); }},
    ProfileRow{
        "rounded_punch", "B", "flat out to B = b/a",
        [](const TypedName& name) { return NamedProfile{.profile = rounded_punch_profile(number(name))}; },
        "flat radius, corner radius", "m",
        [](const TypedName&, const NormalLoad& load) { return press_rounded_punch(load); }, true},
    ProfileRow{"file", "P.csv", "columns radius, pressure; 16 points or more", tabulated},
};

/// The name without or with the argument, "power:N".
std::string written(const ProfileRow& row, bool with_argument) {
  return with_argument && !row.argument.empty() ? fmt::format("{}:{}", row.word, row.argument)
                                                : std::string(row.word);
}

/// One text from each row that has one.
template <class Text>
std::string joined(std::string_view separator, Text text) {
  std::vector<std::string> texts;
  for (const ProfileRow& row : kProfiles)
    if (std::string one = text(row); !one.empty()) texts.push_back(std::move(one));
  return fmt::format("{}", fmt::join(texts, separator));
}

/// The name under which a load presses the profile; empty: none does.
std::string pressed_name(const ProfileRow& row) {
  return row.press ? written(row, !row.load_gives_argument) : std::string();
}

/// The row of a name that has an argument where `with_argument` says so; null: there is none.
template <class Has>
const ProfileRow* find_row(const TypedName& name, Has has_argument) {
  for (const ProfileRow& row : kProfiles)
    if (row.word == name.word && (has_argument(row) || name.whole == row.word)) return &row;
  return nullptr;
}

/// As many numbers as the row names.
void require_shape(const ProfileRow& row, const TypedName& name, const std::vector<double>& shape) {
  if (std::ssize(shape) != 1 + std::ranges::count(row.shape, ','))
    throw std::invalid_argument(
        fmt::format("profile \"{}\": shape {}; needed: {}", name.whole, fmt::join(shape, ","), row.shape));
}

}  // namespace

NamedProfile find_profile(const std::string& name) {
  const TypedName typed = split(name);
  const ProfileRow* const row =
      find_row(typed, [](const ProfileRow& each) { return !each.argument.empty(); });
  if (!row || (row->make == tabulated && typed.argument.empty()))
    throw std::invalid_argument(
        fmt::format("profile \"{}\"; allowed: {}", name,
                    joined(", ", [](const ProfileRow& each) { return written(each, true); })));
  return row->make(typed);
}

PressedContact press(const std::string& profile_name, const NormalLoad& load) {
  const TypedName typed = split(profile_name);
  const ProfileRow* const row = find_row(
      typed, [](const ProfileRow& each) { return !each.argument.empty() && !each.load_gives_argument; });
  if (!row || !row->press)
    throw std::invalid_argument(
        fmt::format("profile \"{}\" with a normal load; allowed: {}", profile_name,
                    joined(", ", [](const ProfileRow& each) {
                      const char* const note = " (without a ratio: it follows from load and shape)";
                      return pressed_name(each) + (each.load_gives_argument ? note : "");
                    })));
  require_shape(*row, typed, load.shape);
  return row->press(typed, load);
}

PressedContact press_power(double exponent, const NormalLoad& load) {
  return {{.profile = power_profile(exponent)},
          indent_power(load.load, exponent, load.shape.at(0), load.effective_modulus)};
}

std::string profile_words() {
  return joined(" | ", [](const ProfileRow& row) {
    return written(row, true) + (row.meaning.empty() ? "" : fmt::format(" ({})", row.meaning));
  });
}

std::string shape_words() {
  return joined("; ", [](const ProfileRow& row) {
    if (!row.press) return std::string();
    return fmt::format("{}: {}{}{}", pressed_name(row), row.shape, row.unit.empty() ? "" : ", ", row.unit);
  });
}

}  // namespace slipstick::analytic
