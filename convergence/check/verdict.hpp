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
  std::string wrong;  ///< and that it is not

  bool holds() const { return value <= allowed; }
  const std::string& text() const { return holds() ? right : wrong; }
};

/// Two answers. Is the field right within its mesh: pressure, loads, motion, tractions and Coulomb's law,
/// each against what right fields of any discretisation have on this very mesh (or against the tolerance that
/// a user asks for). And does it solve its own grid's problem, of cell-constant tractions, up to iteration
/// error.
struct Verdict {
  std::vector<Judged> judged;
  Judged discrete;
  std::optional<Diagnosis> diagnosis;  ///< of a field that is wrong
  std::string why;                     ///< one sentence

  bool within_mesh() const;
};

/// tolerance: on loads, motion and tractions, in place of what the mesh leaves open.
Verdict reach_verdict(const Examination& examination, std::optional<double> tolerance);

}  // namespace slipstick::convergence
