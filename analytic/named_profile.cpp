#include "analytic/named_profile.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

#include "analytic/punch_superposition.hpp"
#include "analytic/shear_bounds.hpp"

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
  return {.whole = name, .word = name.substr(0, colon), .argument = name.substr(std::min(colon + 1, name.size()))};
}

/// The number after the colon.
double number(const TypedName& name) {
  char* end = nullptr;
  const double value = std::strtod(name.argument.c_str(), &end);
  if (name.argument.empty() || *end != '\0')
    throw std::invalid_argument(fmt::format("profile \"{}\": \"{}\" is not a number", name.whole, name.argument));
  return value;
}

/// One of the profiles that live as long as the program.
NamedProfile lasting(const Profile& profile) {
  return {.profile = {&profile, [](const Profile*) {}}};
}

template <const Profile& (*profile)()>
NamedProfile closed_form(const TypedName&) {
  return lasting(profile());
}
template <const Profile& (*profile)(), Indentation (*indent)(double, double, double)>
PressedContact press_closed_form(const TypedName&, const NormalLoad& load) {
  return {lasting(profile()), indent(load.load, load.shape[0], load.effective_modulus)};
}

template <std::unique_ptr<const Profile> (*profile)(double)>
NamedProfile numbered(const TypedName& name) {
  return {.profile = profile(number(name))};
}
PressedContact press_power(const TypedName& name, const NormalLoad& load) {
  return {numbered<power_profile>(name), indent_power(load.load, number(name), load.shape[0], load.effective_modulus)};
}

PressedContact press_rounded_punch(const TypedName&, const NormalLoad& load) {
  const auto pressed = indent_rounded_punch(load.load, load.shape[0], load.shape[1], load.effective_modulus);
  return {{.profile = rounded_punch_profile(pressed.flat_ratio)}, pressed.contact};
}

NamedProfile tabulated(const TypedName& name) {
  const auto table = std::make_shared<const TabulatedProfile>(read_tabulated_profile(name.argument));
  return {.profile = {table, table->profile.get()}, .table = table};
}

/// A profile that users name.
struct ProfileRow {
  std::string_view word;
  std::string_view argument;  ///< after the colon, as help writes it; empty: there is no colon
  std::string_view meaning;   ///< of the argument, for help
  NamedProfile (*make)(const TypedName& name);
  std::string_view shape;  ///< numbers of --shape, with commas between them; empty: no load presses it
  std::string_view unit;   ///< of these numbers
  PressedContact (*press)(const TypedName& name, const NormalLoad& load);
  bool load_gives_argument = false;  ///< load and shape determine the argument: the name leaves it out
};

constexpr std::array kProfiles{
    ProfileRow{"hertz", "", "", closed_form<hertz_profile>,  //
               "sphere radius", "m", press_closed_form<hertz_profile, indent_sphere>},
    ProfileRow{"cone", "", "", closed_form<cone_profile>,  //
               "slope", "", press_closed_form<cone_profile, indent_cone>},
    ProfileRow{"flat_punch", "", "", closed_form<flat_punch_profile>,  //
               "radius", "m", press_closed_form<flat_punch_profile, indent_flat_punch>},
    ProfileRow{"power", "N", "gap ~ r^N", numbered<power_profile>,  //
               "coefficient of r^N", "m^(1-N)", press_power},
    ProfileRow{"rounded_punch", "B", "flat out to B = b/a", numbered<rounded_punch_profile>,  //
               "flat radius, corner radius", "m", press_rounded_punch, true},
    ProfileRow{"constant", "", "", closed_form<constant_bound_profile>, "", "", nullptr},
    ProfileRow{"capped", "C", "mu p under a sphere, at most C times its peak", numbered<capped_hertz_profile>, "", "",
               nullptr},
    ProfileRow{"pressure_power", "N", "k p^N under a sphere", numbered<power_of_hertz_profile>, "", "", nullptr},
    ProfileRow{"file", "P.csv", "columns radius, pressure; 16 points or more", tabulated, "", "", nullptr},
};

/// The name as help writes it, "power:N"; under a normal load, `pressed`, some have no argument.
std::string written(const ProfileRow& row, bool pressed) {
  const bool has_argument = !row.argument.empty() && !(pressed && row.load_gives_argument);
  return has_argument ? fmt::format("{}:{}", row.word, row.argument) : std::string(row.word);
}

/// A text from each row, or from each that a load presses.
template <class Text>
std::string joined(std::string_view separator, bool pressed, Text text) {
  std::vector<std::string> texts;
  for (const ProfileRow& row : kProfiles)
    if (!pressed || row.press) texts.push_back(text(row));
  return fmt::format("{}", fmt::join(texts, separator));
}

/// The row of a name; null: there is none.
const ProfileRow* find_row(const TypedName& name, bool pressed) {
  for (const ProfileRow& row : kProfiles) {
    const bool may_have_argument = written(row, pressed) != row.word;
    if (row.word == name.word && (may_have_argument || name.whole == row.word) && (!pressed || row.press)) return &row;
  }
  return nullptr;
}

}  // namespace

NamedProfile find_profile(const std::string& name) {
  const TypedName typed = split(name);
  const ProfileRow* const row = find_row(typed, false);
  if (!row || (row->make == tabulated && typed.argument.empty()))
    throw std::invalid_argument(
        fmt::format("profile \"{}\"; allowed: {}", name,
                    joined(", ", false, [](const ProfileRow& each) { return written(each, false); })));
  return row->make(typed);
}

PressedContact press(const std::string& profile_name, const NormalLoad& load) {
  const TypedName typed = split(profile_name);
  const ProfileRow* const row = find_row(typed, true);
  if (!row)
    throw std::invalid_argument(fmt::format(
        "profile \"{}\" with a normal load; allowed: {}", profile_name, joined(", ", true, [](const ProfileRow& each) {
          const char* const note = " (without a ratio: it follows from load and shape)";
          return written(each, true) + (each.load_gives_argument ? note : "");
        })));
  if (std::ssize(load.shape) != 1 + std::ranges::count(row->shape, ','))
    throw std::invalid_argument(
        fmt::format("profile \"{}\": shape {}; needed: {}", profile_name, fmt::join(load.shape, ","), row->shape));
  return row->press(typed, load);
}

std::string profile_words() {
  return joined(" | ", false, [](const ProfileRow& row) {
    return written(row, false) + (row.meaning.empty() ? "" : fmt::format(" ({})", row.meaning));
  });
}

std::string shape_words() {
  return joined("; ", true, [](const ProfileRow& row) {
    return fmt::format("{}: {}{}{}", written(row, true), row.shape, row.unit.empty() ? "" : ", ", row.unit);
  });
}

}  // namespace slipstick::analytic
