#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "convergence/check/deviation.hpp"

namespace slipstick::convergence {

/// A likely cause of an error.
struct Cause {
  std::string sentence = "as it should be";
  bool alternative = false;  ///< to the cause before it in a list: both give the same field
};

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
