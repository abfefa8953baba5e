
#include <bit>
#include <cstdint>
#include <stdexcept>

#include "solver/history/history_state.hpp"
#include "solver/solve.hpp"
#include "solver/tests/scene_file.hpp"

/// Histories that are interrupted and resumed.
namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

class Resumed : public SceneFile {
 protected:
  struct Broken {};

  /// Loads that use all of the state: more and less normal load, the same twice, turns back, and forces.
  std::string steps(const std::string& head) const {
    return head +
           "[[step]]\nname = \"on\"\nmoment_ratio = 0.5\n[[step]]\nname = \"further\"\nmoment_ratio = "
           "0.7\n[[step]]\nname = \"more\"\nnormal = 1300\n"
           "[[step]]\nname = \"back\"\nmoment_ratio = -0.4\n[[step]]\nname = \"push\"\nforce = [20, 10]\n"
           "[[step]]\nname = \"less\"\nnormal = 900\n";
  }

  static void expect_same_bits(const ArrayXd& one, const ArrayXd& other, const std::string& what) {
    ASSERT_EQ(one.size(), other.size()) << what;
    for (Index i = 0; i < one.size(); ++i) {
      ASSERT_EQ(std::bit_cast<std::uint64_t>(one[i]), std::bit_cast<std::uint64_t>(other[i])) << what << i;
    }
  }

  static void expect_same(const Solution& one, const Solution& other, const std::string& at) {
    EXPECT_EQ(one.status, other.status) << at;
    EXPECT_EQ(one.message, other.message) << at;
    EXPECT_EQ(one.cycle, other.cycle) << at;
    EXPECT_EQ(one.loads.name, other.loads.name) << at;
    EXPECT_EQ(one.displacement, other.displacement) << at;
    for (double Solution::*const number : std::initializer_list<double Solution::*>{
             &Solution::twist_angle, &Solution::approach, &Solution::stick_radius, &Solution::dissipated,
             &Solution::operator_applications, &Solution::pressure_applications}) {
      EXPECT_EQ(one.*number, other.*number) << at;
    }
    EXPECT_EQ(one.certificate.gap, other.certificate.gap) << at;
    EXPECT_EQ(one.pressure_iterations, other.pressure_iterations) << at;
    EXPECT_EQ(one.resolution.absolute, other.resolution.absolute) << at;
    expect_same_bits(one.pressure, other.pressure, at + ", pressure ");
    expect_same_bits(one.traction, other.traction, at + ", traction ");
    expect_same_bits(one.slip, other.slip, at + ", slip ");
    expect_same_bits(one.stick, other.stick, at + ", stick ");
  }

  static void expect_same(const HistoryState& one, const HistoryState& other, const std::string& at) {
    EXPECT_EQ(one.finished, other.finished) << at;
    EXPECT_EQ(one.contact.motion.twist, other.contact.motion.twist) << at;
    EXPECT_EQ(one.contact.normal.approach, other.contact.normal.approach) << at;
    expect_same_bits(one.contact.normal.pressure, other.contact.normal.pressure, at + ", pressure before ");
    expect_same_bits(one.contact.traction, other.contact.traction, at + ", traction before ");
    expect_same_bits(one.contact.slip, other.contact.slip, at + ", slip before ");
    EXPECT_EQ(one.contact.energy, other.contact.energy) << at;
  }

  /// The ends of steps, and the states between them.
  struct Steps {
    std::vector<Solution> ends;
    std::vector<HistoryState> states;
  };
  static Steps solve_all(const Scene& scene, const std::shared_ptr<const HistoryState>& from) {
    Steps steps;
    solve(scene, {.observer = {.step = [&](const Solution& at) { steps.ends.push_back(at); },
                               .state = [&](const HistoryState& at) { steps.states.push_back(at); }},
                  .resumed = from});
    return steps;
  }

  /// Interrupts a history after each step but the last, at its end or within the next step, and resumes it.
  static void expect_goes_on_alike(const Scene& scene) {
    const Steps whole = solve_all(scene, nullptr);
    ASSERT_EQ(whole.ends.back().status, Status::converged) << whole.ends.back().message;
    ASSERT_EQ(whole.states.size() + 1, whole.ends.size());
    for (std::size_t k = 1; k < whole.ends.size(); ++k) {
      std::shared_ptr<const HistoryState> left;
      const auto keep = [&](const HistoryState& state) {
        left = std::make_shared<const HistoryState>(state);
        if (k % 2 == 0 && state.finished == k) throw Broken{};
      };
      const auto in_a_step = [&](int, double) {
        if (left && left->finished == k) throw Broken{};
      };
      EXPECT_THROW(solve(scene, {.observer = {.progress = in_a_step, .state = keep}}), Broken);
      ASSERT_EQ(left->finished, k);
      const Steps rest = solve_all(scene, left);
      ASSERT_EQ(rest.ends.size(), whole.ends.size() - k);
      for (std::size_t i = 0; i < rest.ends.size(); ++i) {
        const std::string at = "from " + std::to_string(k) + ", step " + std::to_string(k + i + 1);
        expect_same(rest.ends[i], whole.ends[k + i], at);
        if (i < rest.states.size()) expect_same(rest.states[i], whole.states[k + i], at);
      }
    }
  }
};

TEST_F(Resumed, GivesTheSameBitsOverCycles) {
  expect_goes_on_alike(read("cycles = 2\n" + steps(kShortScene), {"grid.cells=[16,16]"}));
}

TEST_F(Resumed, GivesTheSameBitsOfDissimilarBodies) {
  std::string text = kShortScene;
  text.replace(text.rfind("poisson_ratio = 0.3"), 19, "poisson_ratio = 0.1");
  expect_goes_on_alike(read(steps(text), {"contact.coupling=full", "grid.cells=[16,16]"}));
  expect_goes_on_alike(read(steps(text), {"contact.coupling=pressure", "grid.cells=[16,16]"}));
}

TEST_F(Resumed, AStateOfAnotherSceneIsRefused) {
  const Scene scene = read(steps(kShortScene), {"grid.cells=[16,16]"});
  std::shared_ptr<HistoryState> left;
  solve(scene,
        {.observer = {.state = [&](const HistoryState& at) { left = std::make_shared<HistoryState>(at); }}});
  EXPECT_THROW(solve(read(steps(kShortScene), {"grid.cells=[12,12]"}), {.resumed = left}),
               std::invalid_argument);
  for (const std::size_t finished : {0U, 6U, 7U}) {
    left->finished = finished;
    EXPECT_THROW(solve(scene, {.resumed = left}), std::invalid_argument) << finished;
  }
}

}  // namespace
}  // namespace slipstick::solver
