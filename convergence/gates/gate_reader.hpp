#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "convergence/gates/gate.hpp"
#include "solver/input/setting_key.hpp"

namespace slipstick::convergence {

/// Every key that a gate file may have; read_gates() reads by it.
const solver::SettingKeys& gate_keys();

/// What several gate files hold, and what is wrong with those that cannot be read: one bad file does not
/// spoil the others.
struct GateFiles {
  std::vector<Gate> gates;
  std::vector<Judgement> unreadable;  ///< refused; the id is the file's name
};

/// The gates of a file (TOML: tables headed [[gate]]); paths in it are relative to its folder, those of
/// results to `results_folder`, unless that is empty. Throws InputError naming file, key, value and what is
/// allowed.
std::vector<Gate> read_gates(const std::filesystem::path& file,
                             const std::filesystem::path& results_folder = {});

/// The gates of several files, in their order. A file that uses an id a second time counts as unreadable.
GateFiles read_gate_files(const std::vector<std::string>& files,
                          const std::filesystem::path& results_folder = {});

/// Those whose id is among `ids`; all where that is empty. Throws InputError for an id that no gate has,
/// naming the nearest.
std::vector<Gate> select_gates(const std::vector<Gate>& gates, const std::vector<std::string>& ids);

}  // namespace slipstick::convergence
