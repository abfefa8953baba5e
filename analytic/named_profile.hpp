#pragma once

#include <memory>
#include <string>
#include <vector>

#include "analytic/axisymmetric.hpp"
#include "analytic/indentation.hpp"
#include "analytic/tabulated_pressure.hpp"

namespace slipstick::analytic {

/// A contact profile as a user names it: hertz | cone | flat_punch | power:N | rounded_punch:B | file:P.csv.
struct NamedProfile {
  std::shared_ptr<const Profile> profile;
  /// Where the profile is a table's: its scale, and what else its points allow.
  std::shared_ptr<const TabulatedProfile> table = {};
};

/// Throws std::invalid_argument for a name that is none of these, and what the profile itself throws.
NamedProfile find_profile(const std::string& name);

/// What the normal side needs: `shape` is, in SI units, hertz: radius; cone: slope; flat_punch: radius;
/// power:N: the gap's coefficient (m^(1-N)); rounded_punch: flat radius, corner radius.
struct NormalLoad {
  double load;               ///< W, N
  double effective_modulus;  ///< E*, Pa
  std::vector<double> shape;
};

/// The contact that a load makes. A rounded punch named without its flat ratio gets it from here.
struct PressedContact {
  NamedProfile profile;
  Indentation indentation;
};
PressedContact press(const std::string& profile_name, const NormalLoad& load);

/// That of a power profile's load; load.shape holds the gap's coefficient.
PressedContact press_power(double exponent, const NormalLoad& load);

}  // namespace slipstick::analytic
