#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "solver/grid/grid.hpp"
#include "solver/input/setting_key.hpp"

namespace slipstick::convergence {

/// A scene key and the values that a study gives it, as TOML writes them.
struct Variation {
  std::string key;
  std::vector<std::string> values;
};

/// A study file (TOML): every combination of the varied values is a series, solved on every mesh and to every
/// tolerance.
struct Study {
  std::filesystem::path source;
  std::string name;
  std::filesystem::path scene;
  std::vector<std::string> overrides;  ///< "key=value"
  std::vector<solver::Index> cells;    ///< along the longer side, rising; empty: the scene's own grid
  int shifts = 1;                      ///< grids of each mesh, with other positions of the cells under the edges
  std::vector<double> tolerances;      ///< falling; empty: the scene's own
  std::vector<Variation> variations;
  std::vector<std::string> quantities;  ///< paths into a result; empty: all that have an expected order
};

/// Every key that a study file may have.
const solver::SettingKeys& study_keys();

/// overrides: as --set takes them; they follow the study's own. Throws InputError with file, key, value and
/// the allowed values.
Study read_study(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

}  // namespace slipstick::convergence
