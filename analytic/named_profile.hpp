#pragma once

#include <memory>
#include <string>
#include <vector>

#include "analytic/axisymmetric.hpp"
#include "analytic/indentation.hpp"
#include "analytic/tabulated_pressure.hpp"

/// The contact profiles that users name, `hertz` or `power:4`. One table holds them, in named_profile.cpp: a
/// new profile is a file of its own and a row there.
namespace slipstick::analytic {

struct NamedProfile {
  std::shared_ptr<const Profile> profile;
  /// Where the profile is a table's: its scale and its points.
  std::shared_ptr<const TabulatedProfile> table = {};
};

/// Throws std::invalid_argument for a name that is none of profile_words(); the profile may throw too.
NamedProfile find_profile(const std::string& name);

/// The normal load, and the body's shape in SI units, the numbers that shape_words() names.
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

/// For help: the words that find_profile() takes, "hertz | cone | power:N (gap ~ r^N) | ...".
std::string profile_words();
/// For help: the numbers that press() takes by profile, "hertz: sphere radius, m; cone: slope; ...".
std::string shape_words();

}  // namespace slipstick::analytic
