#include <fmt/core.h>

#include <stdexcept>

#include "analytic/certified/certified.hpp"

namespace slipstick::analytic::certified {

Profile profile_named(const std::string& name) {
  const std::string power = "power:";
  if (name == "hertz") return {.kind = Kind::hertz};
  if (name == "cone") return {.kind = Kind::cone};
  if (name == "flat_punch") return {.kind = Kind::flat_punch};
  if (name == "constant") return {.kind = Kind::constant};
  if (name.starts_with(power)) return {.kind = Kind::power, .exponent = name.substr(power.size())};
  throw std::domain_error(fmt::format(
      "profile {} has no certified digits; allowed: hertz, cone, flat_punch, power:N, constant", name));
}

}  // namespace slipstick::analytic::certified
