#include <fmt/core.h>

#include <stdexcept>

#include "analytic/certified/certified.hpp"
#include "cmake/loaded_library.hpp"

namespace slipstick::analytic::certified {

Profile profile_named(const std::string& name) {
  const std::string power = "power:";
  if (name == "hertz") return {.kind = Kind::power, .exponent = "2"};
  if (name == "cone") return {.kind = Kind::cone};
  if (name == "flat_punch") return {.kind = Kind::flat_punch};
  if (name == "constant") return {.kind = Kind::constant};
  if (name.starts_with(power)) return {.kind = Kind::power, .exponent = name.substr(power.size())};
  throw std::domain_error(
      fmt::format("profile {} has no certified digits; allowed: hertz, cone, flat_punch, power:N, constant", name));
}

State state(const Profile& profile, Quantity given, const std::string& value, const std::vector<std::string>& radii,
            int digits) {
  decltype(state)* proven = nullptr;
  try {
    proven = loaded_library<decltype(state)>("slipstick_certified");
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(
        fmt::format("certified digits need FLINT with Arb: on Debian or Ubuntu apt-get install libflint-dev "
                    "libflint-arb-dev (FLINT 3: only libflint-dev), then build again ({})",
                    error.what()));
  }
  return proven(profile, given, value, radii, digits);
}

}  // namespace slipstick::analytic::certified
