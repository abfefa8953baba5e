#include "convergence/results/solve_record.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "convergence/results/exact_result.hpp"
#include "convergence/results/json_text.hpp"
#include "convergence/results/make_record.hpp"
#include "convergence/results/solution_fields.hpp"
#include "convergence/tests/scratch_folder.hpp"
#include "solver/input/input_error.hpp"
#include "solver/solve.hpp"

namespace slipstick::convergence {
namespace {

/// A record read back from its JSON has the same JSON.
void expect_round_trip(const SolveRecord& record) {
  const std::string text = json_text(to_json(record));
  EXPECT_EQ(json_text(to_json(from_json(Json::parse(text)))), text);
}

TEST(SolveRecord, OfAnAnswerComesBackFromJson) {
  for (const char* name : {"paper", "rough_sphere", "imposed_displacement", "ellipse"}) {
    const solver::Scene scene = example(name, {"grid.cells=[16,16]"});
    const solver::Solution solution = solver::solve(scene);
    const OracleAnswer exact = find_oracle(scene);
    SolveRecord record = make_record(scene, solution, exact);
    record.profile = make_profile(solution, exact);
    record.program = ProgramRecord{.name = "other", .own = {.iterations = 3.0, .converged = false}};
    expect_round_trip(record);
    expect_round_trip(make_record(scene, solution, exact, {make_step(scene, solution, exact)}));
    expect_round_trip(make_incomplete(name, "it broke off", {make_step(scene, solution, exact)}));
  }
}

TEST(SolveRecord, OfAnExactAnswerComesBackFromJson) {
  const solver::Scene scene = example("cone", {"solver.model=exact"});
  const SolveRecord record = exact_record(scene, require_oracle(scene), 0.5);
  expect_round_trip(record);
  const SolveRecord again = from_json(to_json(record));
  EXPECT_EQ(again.end.loads.twist_angle.value, record.end.loads.twist_angle.value);
  EXPECT_EQ(again.end.contact.peak_pressure.why_missing, record.end.contact.peak_pressure.why_missing);
  EXPECT_EQ(again.seconds(), 0.5);
}

TEST(SolveRecord, OfARunWithoutAnAnswerComesBackFromJson) {
  SolveRecord record;
  record.status = RunStatus::refused;
  record.message = "too large";
  record.run = "paper";
  record.out_of_memory = true;
  expect_round_trip(record);
  EXPECT_TRUE(from_json(to_json(record)).out_of_memory);
}

TEST(SolveRecord, IsNotReadFromOtherJson) {
  for (const char* text : {"{}", "[]", "{\"status\": \"good\"}", "{\"name\": 1, \"status\": \"converged\"}"}) {
    EXPECT_THROW(from_json(Json::parse(text)), solver::InputError) << text;
  }
}

}  // namespace
}  // namespace slipstick::convergence
