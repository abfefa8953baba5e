#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convergence/check/deviation.hpp"
#include "convergence/check/given_contact.hpp"

namespace slipstick::convergence {

/// Coulomb's law under one assumption about how tractions were computed. Gaps are over the energy; that in
/// stick cells, where the contact has to move as a rigid body, depends on the elastic kernel alone, whatever
/// was done to slipping cells.
struct Hypothesis {
  std::string name;
  double gap;
  double stick_gap;
  double twist;  ///< rad, which fits best under it
};

struct Diagnosis {
  Hypothesis reference_kernel;         ///< with the right kernel and friction
  std::vector<Hypothesis> tried;       ///< mistakes that solvers make
  std::optional<Hypothesis> kernel;    ///< that of them which explains the stick area
  std::optional<Hypothesis> friction;  ///< the friction coefficient that was used
  /// With that kernel, or the right one, the stick area keeps the law: what is left is slipping cells.
  bool stick_area_explained;
};

/// Tries kernels (K12 mirrored as an even function, missing, of the wrong sign; K11 and K22 exchanged;
/// Poisson's ratio zero or another; K13 and K23 of dissimilar bodies missing or of the wrong sign) on a
/// contact that breaks Coulomb's law, and the friction coefficient that its slip ring shows, if it is given.
/// allowed: the gap over energy that its mesh explains. Displacements are summed directly, in large contacts
/// at a part of the cells.
Diagnosis diagnose(const GivenContact& contact, const solver::Step& load, double allowed,
                   std::optional<double> friction = {});

/// Cells that stick: |q| below mu p by more than what a file's digits or a solver's tolerance leave open.
Eigen::ArrayXd stick_cells(const GivenContact& contact);

/// Whether the tractions are right, up to a part of them, once the cells that do not stick have the right
/// directions.
bool directions_explain(const GivenContact& contact, const RightAnswer& answer, double allowed);

/// Whether no more than a part of the tractions exceeds the friction that the slip ring shows.
bool keeps_shown_friction(const GivenContact& contact, const RightAnswer& right, double allowed);

}  // namespace slipstick::convergence
