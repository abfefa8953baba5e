#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convergence/check/diagnosis.hpp"
#include "convergence/check/examination.hpp"

namespace slipstick::convergence {

/// A number and its allowed maximum, which NaN exceeds.
struct Judged {
  std::string quantity;
  double value;
  double allowed;
  std::string right;  ///< words for the verdict where it holds; empty: none
  std::string wrong;  ///< and where it does not: how much, where, and the maximum; empty: none

  bool holds() const { return value <= allowed; }
};

/// Two answers. Is the field right within its mesh? Pressure, loads, motion, tractions and Coulomb's law are
/// judged in the mean and cell by cell, against the errors of right fields of any discretisation on the same
/// mesh, or against the user's tolerance. Does it solve its own grid's problem, with constant tractions in
/// each cell, up to iteration error?
struct Verdict {
  std::vector<Judged> judged;
  Judged discrete;
  std::optional<Diagnosis> diagnosis;  ///< of a field that is wrong
  std::string headline;                ///< names the first quantity that is wrong, or says that all are right
  std::string details;                 ///< the cause, what else is wrong, and what is right

  bool within_mesh() const;
};

/// tolerance: as in find_allowed().
Verdict reach_verdict(const Examination& examination, std::optional<double> tolerance);

}  // namespace slipstick::convergence
