#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/gates/gate.hpp"
#include "solver/input/setting_key.hpp"

/// Gate files (TOML): tables [[gate]], or [[group.gate]] in a [[group]] whose keys they share.
namespace slipstick::convergence {

/// Every key that a gate file may have.
const solver::SettingKeys& gate_keys();

/// The gates of a file in the order of their lines. Paths are relative to the file's folder, paths of result files to
/// `results_folder` if it is not empty. Throws InputError with file, key, value and the allowed values.
std::vector<Gate> read_gates(const std::filesystem::path& file, const std::filesystem::path& results_folder = {});

/// The gates of several files, and a refusal for each file that cannot be read.
struct GateFiles {
  std::vector<Gate> gates;
  std::vector<Judgement> unreadable;  ///< the id is the file's name
};

/// Reads the files in their order. A file whose gate has the id of an earlier gate is unreadable.
GateFiles read_gate_files(const std::vector<std::string>& files, const std::filesystem::path& results_folder = {});

/// The gates whose ids are, or match, one of the patterns of a shell: * ? [ab]; all gates if there are no
/// patterns. Throws InputError for a pattern that matches no id, with the nearest id.
std::vector<Gate> select_gates(const std::vector<Gate>& gates, const std::vector<std::string>& patterns);

}  // namespace slipstick::convergence
