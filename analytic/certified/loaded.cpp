#include <fmt/core.h>

#include "analytic/certified/certified.hpp"
#include "cmake/loaded_library.hpp"

namespace slipstick::analytic::certified {

State state(const Profile& profile, Quantity given, const std::string& value,
            const std::vector<std::string>& radii, int digits) {
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
