#pragma once

#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace slipstick::convergence {

/// Finished results on disk, one file a point, so that a point is computed once: a run that was interrupted
/// goes on where it stopped. A point counts as finished if it was computed from the same question by the same
/// program. Several processes may share a folder.
class Journal {
 public:
  explicit Journal(std::filesystem::path folder);

  /// The result of a point, if it is on disk.
  std::optional<nlohmann::ordered_json> find(const std::string& name, const std::string& question) const;

  /// Throws std::runtime_error if the result cannot be written.
  void keep(const std::string& name, const std::string& question, const nlohmann::ordered_json& result) const;

  /// The result of a point: from disk, or computed and then written. The question is everything the answer
  /// depends on; name is the point's file name without ending; `also` is another file that the computation
  /// leaves behind and without which it is not finished (empty: none). Throws std::runtime_error if the
  /// result cannot be written.
  nlohmann::ordered_json point(const std::string& name, const std::string& question,
                               const std::function<nlohmann::ordered_json()>& compute,
                               const std::filesystem::path& also = {});

  /// Whether the last point() was found on disk.
  bool reused() const { return reused_; }

 private:
  std::filesystem::path file(const std::string& name) const { return folder_ / (name + ".json"); }

  std::filesystem::path folder_;
  std::string program_;  ///< identifies the executable
  bool reused_ = false;
};

/// Writes JSON as write_whole_file() does; a file that has this content already keeps its time.
void write_json_file(const std::filesystem::path& file, const nlohmann::ordered_json& json);

}  // namespace slipstick::convergence
