#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/runs/run_spec.hpp"
#include "solver/input/setting_key.hpp"

/// Scenes that are hard to solve, by the hundred.
namespace slipstick::convergence {

/// One scene of a family, which varies some keys of a scene in all combinations.
struct HardCase {
  std::string family;
  std::string why;   ///< what makes the family hard
  std::string name;  ///< of the case: the varied values, joined with "-"
  RunSpec run;
};

/// Every key that a file of hard cases may have; read_hard_cases() reads by it.
const solver::SettingKeys& hard_keys();

/// The cases of a file (TOML): [[family]] tables with `name`, `why`, `scene`, a table `set` of keys of the
/// scene, and [[family.vary]] tables with `key` and `values`. Throws InputError naming file, key, value and
/// what is allowed.
std::vector<HardCase> read_hard_cases(const std::filesystem::path& file);

}  // namespace slipstick::convergence
