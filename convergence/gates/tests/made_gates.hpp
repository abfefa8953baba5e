#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "convergence/gates/gate.hpp"

namespace slipstick::convergence {

/// A solve's result with one quantity; its reference has a relative error of 1e-15.
inline Json solve_with(const std::string& quantity, const Json& value) {
  Json result{{"status", "converged"}, {"exact", {{"relative_uncertainty", 1e-15}}}};
  result[quantity] = value;
  return result;
}

inline Gate gate_on(const std::string& quantity) {
  Gate gate;
  gate.file = "gates/some.toml";
  gate.line = 12;
  gate.id = "some-gate";
  gate.source = SceneSource{"scene.toml", {}};
  gate.quantity = quantity;
  gate.basis = "measured 1e-6, factor 10";
  gate.reason = "users read this number";
  return gate;
}

inline Gate below(const std::string& quantity, double bound) {
  Gate gate = gate_on(quantity);
  gate.bound = Below{bound};
  return gate;
}

inline Gate between(const std::string& quantity, double low, double high) {
  Gate gate = gate_on(quantity);
  gate.bound = Between{low, high};
  return gate;
}

inline Gate equals(const std::string& quantity, const Json& value) {
  Gate gate = gate_on(quantity);
  gate.bound = Equals{value};
  return gate;
}

inline Gate with_status(Gate gate, GateStatus status) {
  gate.status = status;
  return gate;
}

}  // namespace slipstick::convergence
