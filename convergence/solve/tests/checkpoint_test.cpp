// What a checkpoint keeps, and that it is refused when a bit of it has changed.

#include "convergence/solve/checkpoint.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "solver/history_state.hpp"
#include "solver/input/dataset_reader.hpp"
#include "solver/input/dataset_writer.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

class CheckpointFile : public testing::Test {
 protected:
  CheckpointFile() {
    state_.contact.pressure = Eigen::ArrayXd::LinSpaced(4, 1.0, 4.0);
    state_.contact.traction = Eigen::ArrayXd::LinSpaced(8, 5.0, 12.0);
    state_.contact.slip = Eigen::ArrayXd::LinSpaced(8, 13.0, 20.0);
    state_.normal.safeguards = {1, 2, 3, 4, "the first"};
    checkpoint_.write(state_, Json::array());
  }
  ~CheckpointFile() override { std::filesystem::remove(file_); }

  const std::filesystem::path file_ = std::filesystem::path(testing::TempDir()) /
                                      ("slipstick-checkpoint-" + std::to_string(getpid()) + ".h5");
  const Checkpoint checkpoint_{file_, prepare_run({.scene = SLIPSTICK_SCENES "/paper.toml"})};
  solver::HistoryState state_;
};

TEST_F(CheckpointFile, KeepsEachSafeguardsCount) {
  const solver::Safeguards kept = checkpoint_.read()->state->normal.safeguards;
  EXPECT_EQ(kept.second_solves, 1);
  EXPECT_EQ(kept.halvings, 2);
  EXPECT_EQ(kept.gradient_steps, 3);
  EXPECT_EQ(kept.breakdowns, 4);
  EXPECT_EQ(kept.breakdown, "the first");
}

// The last bit of one value of any field.
TEST_F(CheckpointFile, IsRefusedWithAnotherBit) {
  const std::vector<std::string> names{"pressure", "traction", "slip", "history", "checksum"};
  for (const std::string changed : {"", "pressure", "traction", "slip"}) {
    std::vector<solver::Column> fields;
    std::string texts[2];
    for (const std::string& name : names) {
      const Eigen::ArrayXd values = solver::read_datasets(file_, {name}, 1, 100000).front().reshaped();
      if (fields.size() < 3) {
        fields.push_back({name, values});
      } else {
        for (const double byte : values) texts[name == "checksum"] += static_cast<char>(byte);
      }
    }
    for (solver::Column& field : fields) {
      if (field.name == changed) field.values[2] = std::nextafter(field.values[2], 0.0);
    }
    write_datasets(file_, fields, {{"history", texts[0]}, {"checksum", texts[1]}});
    if (changed.empty()) {
      EXPECT_EQ(checkpoint_.read()->state->contact.slip[7], 20.0);
    } else {
      EXPECT_THROW(checkpoint_.read(), solver::InputError) << changed;
    }
    checkpoint_.write(state_, Json::array());
  }
}

}  // namespace
}  // namespace slipstick::convergence
