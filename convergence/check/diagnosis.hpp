#pragma once

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "convergence/check/deviation.hpp"

namespace slipstick::convergence {

/// Mistakes in fields that `check` can name, as sentences: {0} is the number found, {1} the expected one, {2}
/// the subject.
namespace mistake {
inline constexpr std::string_view none = "as it should be";
inline constexpr std::string_view cross_kernel_even =
    "the cross kernel K12, odd in x1 and in x2, is mirrored as an even function";
inline constexpr std::string_view cross_kernel_missing = "the cross kernel K12 is missing";
inline constexpr std::string_view cross_kernel_sign =
    "the cross kernel K12 has the wrong sign, or the rotation field is (x2, x1) instead of (-x2, x1)";
inline constexpr std::string_view cross_kernel_factor = "the cross kernel K12 is multiplied by {0:.3g}";
inline constexpr std::string_view kernels_exchanged = "the kernels K11 and K22 are exchanged";
inline constexpr std::string_view no_poisson_ratio = "Poisson's ratio is taken as zero";
inline constexpr std::string_view poisson_ratio = "Poisson's ratio is {0:.3g} instead of {1:.3g}";
inline constexpr std::string_view coupling_missing = "the kernels K13 and K23 are missing";
inline constexpr std::string_view coupling_sign = "the kernels K13 and K23 have the wrong sign";
inline constexpr std::string_view coupling_factor = "the kernels K13 and K23 are multiplied by {0:.3g}";
inline constexpr std::string_view friction_coefficient = "the friction coefficient is {0:.4g} instead of {1:.4g}";
inline constexpr std::string_view friction_factor = "the friction bound is multiplied by {0:.4g}";
inline constexpr std::string_view tresca_friction =
    "the law of friction is Tresca's, with a shear strength of {0:.4g} Pa, instead of {2}";
inline constexpr std::string_view mean_friction =
    "the law of friction is Tresca's, with a shear strength of {0:.4g} Pa, mu times the mean pressure, "
    "instead of {2}";
inline constexpr std::string_view coulomb_friction =
    "the law of friction is Coulomb's, with a coefficient of {0:.4g}, instead of {2}";
inline constexpr std::string_view power_friction = "the law of friction is |q| = k p^n with n = {0:.2f} instead of {2}";
inline constexpr std::string_view kept_directions = "slipping cells keep a direction that does not oppose their slip";
inline constexpr std::string_view sampled_singularity =
    "a pressure with an infinite value is sampled at cell centres instead of averaged over cells";
inline constexpr std::string_view lost_rows =
    "the file lacks rows: {0:.0f} cells where the scene has pressure have none";
inline constexpr std::string_view late_step =
    "the tractions are one step late: they belong to the step before the last of {0:.0f} equal steps";
inline constexpr std::string_view late_step_by_twist =
    "the tractions are one step late: only the twist belongs to the scene's load";
inline constexpr std::string_view one_compliance = "only one body's compliance is counted";
inline constexpr std::string_view compliance_factor = "the compliance of the pair is multiplied by {0:.3g}";
inline constexpr std::string_view radius_factor = "the radius is multiplied by {0:.3g}";
inline constexpr std::string_view modulus_factor = "the elastic moduli are multiplied by {0:.3g}";
inline constexpr std::string_view layer_ignored = "the layer on the {2} body is ignored";
inline constexpr std::string_view layer_exchanged = "the constants of the {2} body and of its layer are exchanged";
inline constexpr std::string_view layer_on_other_body = "the layer is on the other body";
inline constexpr std::string_view layer_between_ignored = "the layer between the bodies is ignored";
inline constexpr std::string_view layer_thickness = "the layer on the {2} body is {0:.3g} m thick instead of {1:.4g} m";
inline constexpr std::string_view twist_in_degrees = "the twist is in degrees";
inline constexpr std::string_view twist_in_mrad = "the twist is in mrad";
inline constexpr std::string_view twist_sign = "the twist has the opposite sign";
inline constexpr std::string_view normalised_twist = "the twist is the normalised one, G a^2 phi/(mu W)";
inline constexpr std::string_view other_twist =
    "the twist does not belong to these tractions, whose own is {0:.6g} rad";
}  // namespace mistake

/// A likely cause of an error, and the numbers of its sentence.
struct Cause {
  std::string_view mistake = mistake::none;
  double found = std::numeric_limits<double>::quiet_NaN();
  double expected = std::numeric_limits<double>::quiet_NaN();
  std::string subject = {};
  bool alternative = false;  ///< to the cause before it in a list: both give the same field
  std::string note = {};     ///< its consequence, in brackets behind the sentence; may be empty
};
std::string sentence(const Cause& cause);

/// How well Coulomb's law holds if tractions were computed with one mistake. Gaps are over the energy. Stick
/// cells move as a rigid body: their gap depends only on the elastic kernel.
struct Hypothesis {
  Cause cause;
  double gap;
  double stick_gap;
  double twist;  ///< rad: the one that fits best
};

/// Another friction than the scene's.
struct OtherFriction {
  Cause cause;
  Eigen::ArrayXd bound;  ///< cells
};

/// The friction that a field shows: the scene's law times a factor, unless |q| over its bound varies in half
/// of the slip ring by more than a part of its distance from 1; or else the law |q| = k p^n that most cells
/// follow (n = 0: Tresca's, n = 1: Coulomb's), or the multiple of the scene's law, if as many follow it. None
/// where few cells follow any.
std::optional<OtherFriction> friction_shown(const GivenContact& contact, const RightAnswer& right,
                                            const Regions& regions);

struct Diagnosis {
  Hypothesis reference_kernel;         ///< with the right kernel and friction
  std::vector<Hypothesis> tried;       ///< mistakes that solvers make
  std::optional<Hypothesis> kernel;    ///< explains the stick area, or else the gap
  std::optional<Hypothesis> friction;  ///< the friction that was used
  /// With that kernel, or else the right one, only slipping cells break the law.
  bool stick_area_explained;
};

/// Tries wrong kernels on a contact that breaks Coulomb's law:
///
///  1. The contact's cells are the sources; in large contacts displacements are summed at some of them.
///  2. The displacements are split into the parts that each kernel makes (Displacements).
///  3. For each mistake, those parts are weighted anew and the rigid motion is fitted: the gap that is left.
///  4. A mistake explains the gap of the stick area, or where hardly any cell sticks the whole gap, if it
///     lowers it to a tenth.
///
/// The mistakes: K12 mirrored as an even function, missing, of the wrong sign, times a factor; K11 and K22
/// exchanged; another Poisson's ratio, or zero; K13 and K23 missing, of the wrong sign, times a factor; and
/// the friction that the slip ring shows, if it is given. allowed: the gap over energy that the mesh
/// explains. half_spaces: whether the bodies are half-spaces; on others no wrong kernel is tried.
Diagnosis diagnose(const GivenContact& contact, const solver::Step& load, double allowed,
                   const std::optional<OtherFriction>& friction = {}, bool half_spaces = true);

/// 1 in cells that stick, where |q| is below mu p by more than the file's rounding and a solver's tolerance.
Eigen::ArrayXd stick_cells(const GivenContact& contact);

/// Whether the tractions would be right, up to a part of them, if the slipping cells had the right directions.
bool directions_explain(const GivenContact& contact, const RightAnswer& answer, double allowed);

/// Whether at most a part of the tractions exceeds a friction.
bool keeps_friction(const GivenContact& contact, const OtherFriction& friction, double allowed);

}  // namespace slipstick::convergence
