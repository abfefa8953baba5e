#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/run_spec.hpp"

namespace slipstick::convergence {

/// Runs solves one after the other, says on standard error how far it is, and keeps what is finished.
class Runner {
 public:
  /// Finished points are kept in folder/points; `points` is how many solves there will be.
  Runner(const std::filesystem::path& folder, std::size_t points);

  /// One solve of a scene with some keys changed, compared with the exact answer; of a history the last step,
  /// with the steps beside it. `also` is a file that `look` writes.
  Json solve(const std::string& name, const std::filesystem::path& scene_file,
             const std::vector<std::string>& overrides, const Look& look = {},
             const std::filesystem::path& also = {});

 private:
  void say_progress(const std::string& name);

  Journal journal_;
  std::size_t points_;
  std::size_t done_ = 0;
  int computed_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace slipstick::convergence
