#pragma once

#include <array>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "convergence/orders/expected_order.hpp"
#include "convergence/orders/order.hpp"
#include "convergence/results/solve_record.hpp"
#include "convergence/runs/run_spec.hpp"
#include "solver/grid/grid.hpp"

/// The result of a study as a value: docs/schema/study.schema.json has the same names.
namespace slipstick::convergence {

/// Numbers of a result by their paths.
using PathNumbers = std::vector<std::pair<std::string, Number>>;

/// One solve.
struct StudyRow {
  std::array<solver::Index, 2> cells = {};
  double h = 0.0;  ///< m, side of a square of a cell's area
  std::size_t shift = 0;
  double requested = 0.0;  ///< tolerance
  std::string status = {};
  std::optional<std::string> message = {};
  PathNumbers numbers = {};
  Number seconds = {};
  PathNumbers iteration = {};  ///< error of each quantity by its tolerance; only in the rows of a tolerance study
};

/// One mesh. seconds: the median of its grids.
struct MeshRow {
  std::array<solver::Index, 2> cells = {};
  double h = 0.0;
  std::size_t grids = 0;
  Number seconds = {};
};

/// A quantity on one mesh. grids: number of grids that converged.
struct MeshQuantity {
  int grids = 0;
  Number mean = {};
  Number spread = {};
  Number noise = {};
};

/// observed = discretisation + iteration; rounding and reference are bounds. trend: C h^p of the fitted
/// order; staircase = discretisation - trend, by the position of this grid under the edges of the contact.
struct BudgetLine {
  double h = 0.0;  ///< m, of the first grid
  Number observed = {};
  Number discretisation = {};
  Number iteration = {};
  Number rounding = {};
  Number reference = {};
  Number trend = {};
  Number staircase = {};
};

/// The value to which the meshes tend.
struct Extrapolated {
  Number value = {};
  Number uncertainty = {};
  std::string method = {};
};

/// A quantity through the meshes: its errors against the exact answer, or its values.
struct QuantityResult {
  std::string path = {};
  bool exact = false;
  Order order = {};
  ExpectedOrder expected = {};
  std::optional<Extrapolated> extrapolated = {};  ///< of values
  std::vector<MeshQuantity> meshes = {};
  std::vector<BudgetLine> budget = {};  ///< of the first grid of each mesh; of values relative to their limit
};

struct SeriesResult {
  std::string name = {};
  Json set = {};  ///< the varied keys and their values
  double tolerance = 0.0;
  int tightened = 0;  ///< times that the study reduced the tolerance
  Number reference_uncertainty = {};
  FailedRuns failed_runs = {};
  std::vector<StudyRow> rows = {};
  std::vector<MeshRow> meshes = {};
  std::vector<QuantityResult> quantities = {};
  std::optional<std::vector<StudyRow>> tolerances = {};
};

struct StudyResult {
  std::string name = {};
  std::string scene = {};
  int shifts = 1;
  std::vector<SeriesResult> series = {};
  FailedRuns failed_runs = {};
  Json provenance = {};
};

/// Series are keyed by name, orders and limits by path: gates name series.NAME.order.PATH.value, low, high and verdict.
Json to_json(const StudyResult& result);
Json to_json(const SeriesResult& series);

/// For a person: tables of errors, orders with verdicts, budgets.
std::string study_text(const StudyResult& result);

}  // namespace slipstick::convergence
