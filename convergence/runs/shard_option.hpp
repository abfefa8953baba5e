#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/runs/shard.hpp"

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// --shard and --merge, as the commands have them that judge many runs.
class ShardOption {
 public:
  /// Beside --shard the named options, which take what was judged, are refused.
  void add_to(CLI::App& command, const std::vector<std::string>& of_judgement);

  /// Throws InputError for a word that is no shard; none where it was not given.
  std::optional<Shard> shard() const;

  /// Throws InputError for one that is no folder; empty where none was given.
  std::vector<std::filesystem::path> merged() const;

 private:
  std::string shard_;
  std::vector<std::string> merged_;
};

}  // namespace slipstick::convergence
