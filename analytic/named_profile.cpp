#include "analytic/named_profile.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <cstdlib>
#include <stdexcept>

#include "analytic/pressure_table.hpp"
#include "analytic/punch_superposition.hpp"

namespace slipstick::analytic {

namespace {

/// The name before the colon and what stands behind it.
struct Parts {
  std::string kind;
  std::string argument;
};

Parts split(const std::string& name) {
  const auto colon = name.find(':');
  if (colon == std::string::npos) return {.kind = name, .argument = {}};
  return {.kind = name.substr(0, colon), .argument = name.substr(colon + 1)};
}

double number(const std::string& name, const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0')
    throw std::invalid_argument(fmt::format("profile \"{}\": \"{}\" is not a number", name, text));
  return value;
}

/// One of the profiles that live as long as the program.
std::shared_ptr<const Profile> borrowed(const Profile& profile) {
  return {&profile, [](const Profile*) {}};
}

[[noreturn]] void unknown(const std::string& name) {
  throw std::invalid_argument(fmt::format(
      "profile \"{}\"; allowed: hertz, cone, flat_punch, power:N, rounded_punch:B, file:P.csv", name));
}

NamedProfile tabulated(const std::string& file) {
  const auto table = std::make_shared<const TabulatedProfile>(read_tabulated_profile(file));
  return {.profile = {table, table->profile.get()}, .table = table};
}

/// The numbers of --shape, as many as the profile needs.
void require_shape(const std::string& name, const std::vector<double>& shape, std::size_t count,
                   const char* meaning) {
  if (shape.size() != count)
    throw std::invalid_argument(
        fmt::format("profile \"{}\": shape {}; needed: {}", name, fmt::join(shape, ","), meaning));
}

}  // namespace

NamedProfile find_profile(const std::string& name) {
  const auto [kind, argument] = split(name);
  if (name == "hertz") return {.profile = borrowed(hertz_profile())};
  if (name == "cone") return {.profile = borrowed(cone_profile())};
  if (name == "flat_punch") return {.profile = borrowed(flat_punch_profile())};
  if (kind == "power") return {.profile = power_profile(number(name, argument))};
  if (kind == "rounded_punch") return {.profile = rounded_punch_profile(number(name, argument))};
  if (kind == "file" && !argument.empty()) return tabulated(argument);
  unknown(name);
}

PressedContact press(const std::string& profile_name, const NormalLoad& load) {
  const auto [kind, argument] = split(profile_name);
  const auto& [force, modulus, shape] = load;
  if (profile_name == "hertz") {
    require_shape(profile_name, shape, 1, "sphere radius");
    return {find_profile(profile_name), indent_sphere(force, shape[0], modulus)};
  }
  if (profile_name == "cone") {
    require_shape(profile_name, shape, 1, "slope");
    return {find_profile(profile_name), indent_cone(force, shape[0], modulus)};
  }
  if (profile_name == "flat_punch") {
    require_shape(profile_name, shape, 1, "radius");
    return {find_profile(profile_name), indent_flat_punch(force, shape[0], modulus)};
  }
  if (kind == "power") {
    require_shape(profile_name, shape, 1, "coefficient of r^N");
    return press_power(number(profile_name, argument), load);
  }
  if (profile_name == "rounded_punch") {
    require_shape(profile_name, shape, 2, "flat radius, corner radius");
    const auto pressed = indent_rounded_punch(force, shape[0], shape[1], modulus);
    return {{.profile = rounded_punch_profile(pressed.flat_ratio)}, pressed.contact};
  }
  throw std::invalid_argument(fmt::format(
      "profile \"{}\" with a normal load; allowed: hertz, cone, flat_punch, power:N, rounded_punch "
      "(without a ratio: it follows from load and shape)",
      profile_name));
}

PressedContact press_power(double exponent, const NormalLoad& load) {
  return {{.profile = power_profile(exponent)},
          indent_power(load.load, exponent, load.shape.at(0), load.effective_modulus)};
}

}  // namespace slipstick::analytic
