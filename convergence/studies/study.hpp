#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/runs/process_pool.hpp"
#include "solver/grid/grid.hpp"
#include "solver/input/setting_key.hpp"

namespace slipstick::convergence {

/// A scene key and the values that a study gives it, as TOML writes them.
struct Variation {
  std::string key;
  std::vector<std::string> values;
};

/// A study as its file (TOML) says it: every combination of the varied values is a series, solved on every
/// mesh and to every tolerance.
struct Study {
  std::filesystem::path source;
  std::string name;
  std::filesystem::path scene;
  std::vector<std::string> overrides;  ///< "key=value"
  std::vector<solver::Index> cells;    ///< along the longer side, rising; empty: the scene's own grid
  int shifts = 1;                      ///< grids of each mesh, whose cells lie differently under the edges
  std::vector<double> tolerances;      ///< falling; empty: the scene's own
  std::vector<Variation> variations;
  std::vector<std::string> quantities;  ///< paths into a result; empty: all that have an expected order
};

/// Every key that a study file may have; read_study() reads by it.
const solver::SettingKeys& study_keys();

/// overrides: as --set takes them, applied to the scene after the study's own. Throws InputError naming file,
/// key, value and what is allowed.
Study read_study(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// The runs of a study that do not depend on results; tighter tolerances, where iterations show in the
/// results, follow from these. Throws as make_series().
std::vector<PreparedRun> study_runs(const Study& study, std::optional<double> memory_limit = {});

/// Solves, fits and judges: rows, orders, extrapolated values and budgets of each series, under
/// result["series"][name]; the name joins the varied values with "-", or is the scene's where nothing varies.
/// Paths that gates use: series.NAME.order.QUANTITY.value|low|high|verdict.
Json run_study(const Study& study, const ProcessPool& pool);

/// The same for a person: tables of errors, orders with verdicts, budgets.
std::string study_text(const Json& result);

}  // namespace slipstick::convergence
