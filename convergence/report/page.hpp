#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "convergence/results/result_parts.hpp"
#include "solver/grid/grid.hpp"

namespace slipstick::solver {
struct Scene;
}

/// The page of a scene as a value: docs/schema/report.schema.json has the same names.
namespace slipstick::convergence {

/// The work that a page may take: seconds, a minute or two, or some minutes more.
enum class Effort { quick, usual, full };

/// The size of a page.
struct PageSize {
  solver::Index most_cells;  ///< along the longer side of the answer's mesh; a scene with fewer keeps its own
  /// Bound of the study's finest mesh, which else has twice the answer's cells.
  solver::Index most_study_cells;
  int shifts;                          ///< grids of each mesh, see Study; two for a history
  solver::Index method_cells;          ///< the finest mesh on which methods are compared
  std::vector<double> operator_cells;  ///< meshes for direct sums against convolution
  int repetitions;                     ///< of each of these times
  bool finer_meshes;                   ///< hard variants are also solved on finer meshes
  std::size_t long_history;            ///< a history with more steps has half as fine meshes
};
PageSize page_size(Effort effort);

/// The validation of the paper. inputs: the folder with scenes/, hard/, check/fields/, gates/ and literature/. A quick
/// validation takes every tenth hard case, and omits the gates and the studies of the literature.
struct Validation {
  std::filesystem::path inputs;
  Effort effort;
};

/// A scene in words. text: its file; summary: labels and values.
struct SceneDescription {
  std::string name = {};
  std::string text = {};
  std::vector<std::pair<std::string, std::string>> summary = {};
  /// The gap of the undeformed bodies in m, NaN where they cannot touch: along both axes of the grid through
  /// its centre, and on a coarse map.
  struct Gap {
    std::vector<double> x1 = {}, along_1 = {}, x2 = {}, along_2 = {};
    std::vector<std::vector<double>> map = {};
  } gap = {};
};

/// A number of the answer with its relative error. error = mesh + path, by the mesh and by the length of the
/// load steps; for a number with an exact answer only the sum is known, and it is signed.
struct PageNumber {
  std::string key = {};
  std::string words = {};
  std::string unit = {};
  double value = 0.0;
  std::string basis = {};  ///< how the error is known, or why it is not
  Number reference = {};   ///< exact or extrapolated value
  Number error = {};
  Number mesh = {};
  Number path = {};
  Number uncertainty = {};  ///< of the reference, relative
};

/// One solve of the comparison of methods. error: distance from the reference plus the reference's uncertainty.
struct CostPoint {
  std::string method = {};
  solver::Index cells = 0;
  double tolerance = 0.0;
  std::string status = {};
  Number seconds = {};
  Number error = {};
};

/// Error against time. choices: the meshes and tolerances that `solve --accuracy` takes.
struct Cost {
  std::string number = {};
  Number reference_uncertainty = {};
  std::vector<CostPoint> points = {};
  Json choices = {};
};

/// An answer of this program or of another one on one mesh.
struct PageProgram {
  std::string name = {};
  solver::Index cells = 0;
  std::string status = {};
  std::string version = {};
  std::string message = {};
  Number seconds = {};
  Number cpu_seconds = {};
  std::string number = {};  ///< the number that is compared
  Number error = {};
};

/// The methods, other programs and ways to sum. programs: none where there is none to compare; operators: direct sums
/// against convolution, by slipstick.speed.crossovers; none where another program solves the scene.
struct Costs {
  Cost cost = {};
  std::optional<std::vector<PageProgram>> programs = {};
  std::optional<Json> operators = {};
};

/// `slipstick bench` without a page.
struct SceneCosts {
  Json provenance = {};
  std::string scene = {};
  std::vector<PageNumber> numbers = {};
  Costs costs = {};
};
Json to_json(const SceneCosts& costs);

/// open: neither right nor wrong is shown.
enum class Shown { holds, open, fails };
inline Shown shown(bool holds) { return holds ? Shown::holds : Shown::fails; }

/// A sentence of the verdict.
struct Finding {
  std::string what = {};
  std::string line = {};
  Shown shown = Shown::holds;
};

/// The head of a page. counts: of hard cases and gates. since: the commit of the page to which `changes`
/// refer; empty on the first page of a folder.
struct Headline {
  std::vector<Finding> findings = {};
  std::string commit = {};
  std::vector<std::pair<std::string, double>> numbers = {};
  Json counts = Json::object();
  std::string since = {};
  std::vector<std::string> changes = {};

  /// good, or open or bad where a finding is.
  std::string verdict() const;
};
Json to_json(const Headline& headline);

/// The parts that a page need not have are optional. A part that another command makes, too, is the JSON of
/// that command.
struct Page {
  Json provenance = {};
  SceneDescription scene = {};
  Json answer = {};         ///< result on the finest mesh
  std::string fields = {};  ///< name of the file of its fields
  std::optional<Json> check = {};
  Json studies = Json::array();  ///< of meshes, unless the scene has its own, and of tolerances
  std::vector<PageNumber> numbers = {};
  std::optional<Json> uncertainty = {};
  std::optional<Costs> costs = {};
  std::optional<Json> hard = {};
  std::optional<Json> digits = {};
  std::optional<Json> paper = {};  ///< the validation of the paper
  Headline headline = {};
};
Json to_json(const Page& page);

/// on_page: the scene with the cells of the page's answer.
SceneDescription describe(const solver::Scene& scene, const solver::Scene& on_page, const std::filesystem::path& file);

}  // namespace slipstick::convergence
