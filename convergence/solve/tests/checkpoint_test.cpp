// A checkpoint returns the state that was written, and is refused if a bit has changed.

#include "convergence/solve/checkpoint.hpp"

#include <nlohmann/json.hpp>

#include "solver/history/history_state.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/input/tests/scratch_folder.hpp"

namespace slipstick::convergence {
namespace {

class CheckpointFile : public ScratchFolder {
 protected:
  CheckpointFile() {
    state_.contact.normal.pressure = Eigen::ArrayXd::LinSpaced(4, 1.0, 4.0);
    state_.contact.traction = Eigen::ArrayXd::LinSpaced(8, 5.0, 12.0);
    state_.contact.slip = Eigen::ArrayXd::LinSpaced(8, 13.0, 20.0);
    state_.contact.normal.safeguards = {1, 2, 3, 4, "the first"};
    checkpoint_.write(state_, {});
  }

  const std::filesystem::path file_ = folder_ / "checkpoint.h5";
  const Checkpoint checkpoint_{file_, prepare_run({.scene = SLIPSTICK_SCENES "/paper.toml"})};
  solver::HistoryState state_;
};

TEST_F(CheckpointFile, KeepsEachSafeguardsCount) {
  const solver::Safeguards kept = checkpoint_.read()->state->contact.normal.safeguards;
  EXPECT_EQ(kept.second_solves, 1);
  EXPECT_EQ(kept.halvings, 2);
  EXPECT_EQ(kept.gradient_steps, 3);
  EXPECT_EQ(kept.breakdowns, 4);
  EXPECT_EQ(kept.breakdown, "the first");
}

// Changes the last bit of one value of any field.
TEST_F(CheckpointFile, IsRefusedWithAnotherBit) {
  const std::string whole = solver::read_input_file(file_, 1 << 20, "a checkpoint");
  for (const double value : {3.0, 7.0, 15.0}) {
    const std::string bytes(reinterpret_cast<const char*>(&value), sizeof value);
    ASSERT_NE(whole.find(bytes), std::string::npos);
    std::string other = whole;
    other[whole.find(bytes)] ^= 1;
    std::ofstream(file_, std::ios::binary) << other;
    EXPECT_THROW(checkpoint_.read(), solver::InputError) << value;
  }
}

}  // namespace
}  // namespace slipstick::convergence
