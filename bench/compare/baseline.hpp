#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

/// Timings that later ones are compared with: a file for each kind of machine, small enough for a repository.
namespace slipstick::bench {

/// Why and from what a baseline was made.
struct BaselineOrigin {
  std::string date;  ///< YYYY-MM-DD
  std::string version;
  std::string commit;
  std::string reason;  ///< in a sentence: what changed the times
};

/// FOLDER/MACHINE.json.
std::filesystem::path baseline_file(const std::filesystem::path& folder, const std::string& machine);

/// The timings as a baseline keeps them, Google Benchmark's JSON still: names, repetitions and times to four
/// digits. "history" has every baseline's origin and medians in seconds, the last one's at its end; before:
/// the baseline that it replaces, null for none.
nlohmann::ordered_json make_baseline(const nlohmann::ordered_json& timings,
                                     const nlohmann::ordered_json& before, const BaselineOrigin& origin);

/// A repetition a line, so that changes can be read. Throws std::runtime_error where it cannot be written.
void write_baseline(const std::filesystem::path& file, const nlohmann::ordered_json& baseline);

}  // namespace slipstick::bench
