#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

#include "convergence/programs/run_program.hpp"

namespace slipstick::convergence {

/// Finished results on disk, one file each, so that none is computed twice: a command that was interrupted
/// goes on where it stopped. A result counts as finished if it was computed from the same cache key, which is
/// everything that it depends on, by the same program. Several processes may share a folder.
class ResultCache {
 public:
  /// program: the executable that computes, by its size and when it was written.
  explicit ResultCache(std::filesystem::path folder, const std::filesystem::path& program = kOwnProgram);

  /// The result of a name, which is its file's without ending, if it is on disk.
  std::optional<nlohmann::ordered_json> find(const std::string& name, const std::string& cache_key) const;

  /// Throws std::runtime_error if the result cannot be written.
  void keep(const std::string& name, const std::string& cache_key,
            const nlohmann::ordered_json& result) const;

  /// So that a kill while it is computed again leaves nothing that looks finished.
  void forget(const std::string& name) const;

  /// The result from disk, or computed and then written. Throws as keep().
  nlohmann::ordered_json find_or_compute(const std::string& name, const std::string& cache_key,
                                         const std::function<nlohmann::ordered_json()>& compute) const;

 private:
  std::filesystem::path file(const std::string& name) const { return folder_ / (name + ".json"); }

  std::filesystem::path folder_;
  std::string program_;  ///< identifies the executable
};

/// Writes JSON as write_whole_file() does; a file that has this content already keeps its time.
void write_json_file(const std::filesystem::path& file, const nlohmann::ordered_json& json);

}  // namespace slipstick::convergence
