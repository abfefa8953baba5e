#pragma once

#include <string>
#include <vector>

/// The torsional contact with slip and stick to a requested number of proven digits: every
/// number is computed as a ball that encloses it (Arb, Johansson 2017), integrals and roots included.
namespace slipstick::analytic::certified {

/// A number with its proof: |exact - value| <= radius, with `value` and `radius` as the decimals they are.
struct Number {
  std::string value;
  std::string radius;
};

/// The friction: mu times the pressure of a cone, a flat punch, or a gap that grows like r^n (2: a sphere); or the same
/// everywhere.
enum class Kind { cone, flat_punch, power, constant };

struct Profile {
  Kind kind;
  std::string exponent = {};  ///< n > 0 of a power law
};

/// hertz | cone | flat_punch | power:N | constant. Throws std::domain_error for other names.
Profile profile_named(const std::string& name);

/// The quantity that names a state.
enum class Quantity { moment_ratio, moment_deficit, stick_ratio, stick_complement, twist };

/// Dimensionless as in torsion.hpp; each number has the requested digits and a radius of at most 0.51 of the last one.
/// Only 0 and 1, where they are exact, are written with one digit, and only exact numbers have radius 0.
struct State {
  Number moment_ratio;
  Number moment_deficit;
  Number stick_ratio;
  Number stick_complement;
  Number twist;
  Number moment;
  Number tangent_stiffness;
  std::vector<Number> traction;  ///< q/(mu p0) at each radius
};

/// The state where `given` has `value`, with the tractions at `radii` (r/a in [0, 1]; a flat punch: below 1), to
/// 15..100 significant digits. Numbers are taken as written, "0.1" is one tenth; C's hexadecimal floats are understood
/// ("0x1.8p-3"), so that a double can be handed over exactly. Throws std::domain_error with the value and the range for
/// a value outside it (as torsion.hpp; positive values from 1e-1000) or a text that is no number, and
/// std::runtime_error with the package to install if this build or this machine has no FLINT.
State state(const Profile& profile, Quantity given, const std::string& value, const std::vector<std::string>& radii,
            int digits);

}  // namespace slipstick::analytic::certified
