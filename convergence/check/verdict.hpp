#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convergence/check/diagnosis.hpp"
#include "convergence/check/examination.hpp"

namespace slipstick::convergence {

/// A number that must not exceed what is allowed. NaN exceeds everything.
struct Judged {
  std::string quantity;
  double value;
  double allowed;
  std::string right;  ///< how a sentence says that it holds; empty: it does not
  std::string wrong;  ///< and that it is not: by how much, where, against what allowed

  bool holds() const { return value <= allowed; }
};

/// Two answers. Is the field right within its mesh: pressure, loads, motion, tractions and Coulomb's law, in
/// the mean and cell by cell, each against what right fields of any discretisation have on this very mesh (or
/// against the tolerance that a user asks for). And does it solve its own grid's problem, of cell-constant
/// tractions, up to iteration error.
struct Verdict {
  std::vector<Judged> judged;
  Judged discrete;
  std::optional<Diagnosis> diagnosis;  ///< of a field that is wrong
  std::string headline;                ///< the first quantity that is wrong, or that all are right
  std::string details;                 ///< what else is wrong, what is right, and the cause

  bool within_mesh() const;
};

/// tolerance: on loads, motion and tractions, in place of what the mesh leaves open.
Verdict reach_verdict(const Examination& examination, std::optional<double> tolerance);

}  // namespace slipstick::convergence
