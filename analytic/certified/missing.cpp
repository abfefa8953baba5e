#include <stdexcept>

#include "analytic/certified/certified.hpp"

namespace slipstick::analytic::certified {

State state(const Profile&, Quantity, const std::string&, const std::vector<std::string>&, int) {
  throw std::runtime_error(
      "certified digits need FLINT with Arb: on Debian or Ubuntu apt-get install libflint-dev "
      "libflint-arb-dev "
      "(FLINT 3: libflint-dev alone), then build again");
}

}  // namespace slipstick::analytic::certified
