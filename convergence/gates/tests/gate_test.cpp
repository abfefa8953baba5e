// Gates on solves of kinds that no scene gives at will; gates_test.py has all others.

#include "convergence/gates/gate.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace slipstick::convergence {
namespace {

Gate gate_on_solve() {
  Gate gate;
  gate.source = SceneSource{"scene.toml", {}};
  gate.quantity = "twist_error";
  gate.bound = Below{1.0};
  return gate;
}

// Where a solve does not state the error of its reference, none of its errors is judged.
TEST(Gate, NeedsTheReferenceOfASolve) {
  Json result{{"twist_error", 1e-4}};
  EXPECT_EQ(judge(gate_on_solve(), result).outcome, Outcome::refused);
  EXPECT_FALSE(judge(gate_on_solve(), result).why.empty());
  result["exact"] = {{"relative_uncertainty", 1e-3}};
  EXPECT_EQ(judge(gate_on_solve(), result).outcome, Outcome::passed);
}

// A solve that died is no answer of any kind: whatever was expected, it fails.
TEST(Gate, FailsWithASolveThatDied) {
  for (const GateStatus status : {GateStatus::active, GateStatus::expected_failure, GateStatus::report_only}) {
    Gate gate = gate_on_solve();
    gate.status = status;
    const Judgement judgement = judge(gate, {{"status", "failed"}, {"message", "killed by signal 9"}});
    EXPECT_EQ(judgement.outcome, Outcome::failed);
    EXPECT_EQ(judgement.why, "the solve failed: killed by signal 9");
    EXPECT_EQ(exit_code({judgement}), 1);
  }
}

}  // namespace
}  // namespace slipstick::convergence
