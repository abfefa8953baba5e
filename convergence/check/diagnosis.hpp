#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convergence/check/deviation.hpp"
#include "convergence/check/given_contact.hpp"

namespace slipstick::convergence {

/// How well Coulomb's law holds under one assumption about how tractions were computed. Gaps are over the
/// energy. The gap in stick cells, which have to move as a rigid body, depends on the elastic kernel alone.
struct Hypothesis {
  std::string name;
  double gap;
  double stick_gap;
  double twist;  ///< rad: the one that fits best
};

struct Diagnosis {
  Hypothesis reference_kernel;         ///< with the right kernel and friction
  std::vector<Hypothesis> tried;       ///< mistakes that solvers make
  std::optional<Hypothesis> kernel;    ///< the one that explains the stick area, or else the gap
  std::optional<Hypothesis> friction;  ///< the friction that was used
  /// With that kernel, or else the right one, only slipping cells break the law.
  bool stick_area_explained;
};

/// Tries wrong kernels on a contact that breaks Coulomb's law (K12 mirrored as an even function, missing, of
/// the wrong sign, times a factor; K11 and K22 exchanged; another Poisson's ratio, or zero; K13 and K23
/// missing, of the wrong sign, times a factor), and the friction that its slip ring shows, if it is given.
/// allowed: the gap over energy that its mesh explains. half_spaces: whether the kernels are those of
/// half-spaces; of other bodies no wrong kernel is tried. Displacements are summed directly, in large
/// contacts at some of the cells.
Diagnosis diagnose(const GivenContact& contact, const solver::Step& load, double allowed,
                   const std::optional<OtherFriction>& friction = {}, bool half_spaces = true);

/// 1 in cells that stick, where |q| is below mu p by more than the file's rounding and a solver's tolerance.
Eigen::ArrayXd stick_cells(const GivenContact& contact);

/// Whether the tractions would be right, up to a part of them, if the slipping cells had the right
/// directions.
bool directions_explain(const GivenContact& contact, const RightAnswer& answer, double allowed);

/// Whether at most a part of the tractions exceeds a friction.
bool keeps_friction(const GivenContact& contact, const OtherFriction& friction, double allowed);

}  // namespace slipstick::convergence
