#pragma once

#include <optional>
#include <string>
#include <vector>

#include "convergence/check/diagnosis.hpp"
#include "convergence/check/examination.hpp"

namespace slipstick::convergence {

/// A number that must not exceed what the mesh (or the file's digits) accounts for. NaN exceeds everything.
struct Judged {
  std::string quantity;
  double value;
  double allowed;
  std::string right;  ///< how a sentence says that it is as it should be; empty: it does not
  std::string wrong;  ///< and that it is not

  bool holds() const { return value <= allowed; }
};

/// Pressure, loads, Coulomb's law, each against what the yardstick says about this very mesh.
struct Verdict {
  bool good;
  std::string why;  ///< one sentence
  std::vector<Judged> judged;
  std::optional<Diagnosis> diagnosis;  ///< of a field that breaks Coulomb's law
};

Verdict reach_verdict(const Examination& examination);

}  // namespace slipstick::convergence
