#include "convergence/check/stress_request.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "convergence/oracle/exact_stresses.hpp"
#include "convergence/runs/path_uncertainty.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/table_text.hpp"
#include "solver/solve.hpp"
#include "solver/stresses/subsurface_stresses.hpp"

namespace slipstick::convergence {
namespace {

using solver::InputError;
using Point = std::array<double, 3>;  ///< x1, x2, depth, m
using Parts = std::vector<solver::PointStresses>;

constexpr std::array<const char*, solver::kStresses> kComponents{"s11", "s22", "s33", "s12", "s13", "s23"};
constexpr std::size_t kMaxStressRows = 100'000;
/// Most points times cells in contact of a sum over a solution: a minute of CPU.
constexpr double kMaxTerms = 3e8;
/// Positions beyond this many contact radii, in the median, are taken for another unit.
constexpr double kFarAway = 200.0;

/// Stresses as a file has them, in its own unit.
struct GivenStresses {
  std::vector<Point> points;
  Json components = Json::object();
  std::vector<std::string> conventions;
};

/// The right stresses of a body, for any of its Poisson's ratios.
struct RightStresses {
  double contact_radius;
  std::function<Parts(const std::vector<Point>&, double poisson)> at;
  std::function<Parts(const std::vector<Point>&, double poisson)> coarse = {};  ///< see stress_request()
  double terms = 0.0;                                                           ///< of the sum at a point
  std::string reason = {};  ///< why they are not exact; empty: they are
};

GivenStresses read_stresses(const std::filesystem::path& file, const std::vector<std::string>& columns) {
  const std::vector<std::string> there = columns.empty() ? solver::text_table_names(file) : columns;
  std::vector<std::string> names{"x1", "x2", "x3"};
  std::ranges::copy_if(kComponents, std::back_inserter(names),
                       [&](const char* name) { return std::ranges::find(there, name) != there.end(); });
  const auto read = solver::read_columns(file, names, {.columns = columns});
  GivenStresses given;
  const solver::Index rows = read[0].values.size();
  if (static_cast<std::size_t>(rows) > kMaxStressRows)
    throw InputError(file.string(), fmt::format("{} rows; allowed: at most {}", rows, kMaxStressRows));
  const Eigen::ArrayXd& x3 = read[2].values;
  const bool upwards = (x3 <= 0.0).all() && (x3 < 0.0).any();
  if (upwards) given.conventions.emplace_back("x3 points out of the body");
  for (solver::Index row = 0; row < rows; ++row) {
    if (!upwards && x3[row] < 0.0)
      throw InputError(file.string(),
                       fmt::format("row {}: x3 = {}; allowed: depths, all of one sign", row + 1, x3[row]));
    given.points.push_back({read[0].values[row], read[1].values[row], std::abs(x3[row])});
  }
  for (std::size_t c = 3; c < names.size(); ++c) {
    const bool turned = upwards && (names[c] == "s13" || names[c] == "s23");
    const Eigen::ArrayXd values = turned ? -read[c].values : read[c].values;
    given.components[names[c]] = std::vector<double>(values.begin(), values.end());
  }
  return given;
}

/// Positions that are far away in m, and near the contact in another unit, are read in that one.
void find_length_unit(GivenStresses& given, double contact_radius) {
  std::vector<double> sizes;
  for (const Point& at : given.points) sizes.push_back(std::hypot(at[0], at[1], at[2]));
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  for (const auto& [unit, length] : {std::pair("m", 1.0), {"mm", 1e-3}, {"um", 1e-6}, {"nm", 1e-9}}) {
    if (!(*middle * length <= kFarAway * contact_radius)) continue;
    if (length == 1.0) return;
    given.conventions.push_back(fmt::format("positions in {}", unit));
    for (Point& at : given.points) {
      for (double& x : at) x *= length;
    }
    return;
  }
}

RightStresses solved_stresses(const solver::Scene& scene, solver::Body body, const std::string& reason) {
  const auto solved = [](const solver::Scene& on_grid) {
    auto solution = std::make_shared<const solver::Solution>(solver::solve(on_grid));
    if (solution->status == solver::Status::converged) return solution;
    throw std::runtime_error("the right stresses to judge by were not found: " + solution->message);
  };
  const auto of = [body](const std::shared_ptr<const solver::Solution>& solution) {
    return
        [=](const std::vector<Point>& points, double poisson) { return stresses_at(*solution, poisson, body, points); };
  };
  solver::Scene coarse = scene;
  for (solver::Index& cells : coarse.grid.cells) cells = (cells + 1) / 2;
  std::shared_ptr<const solver::Solution> rough;
  try {
    rough = solved(coarse);
  } catch (const InputError& error) {
    throw InputError(scene.source.string(),
                     fmt::format("has no exact stresses, and is not solved on cells twice as large, which "
                                 "shows the error of its own: {}",
                                 error.what()));
  }
  solver::Scene fine = scene;
  if (depends_on_path(scene, rough->coupled)) fine.solver.substeps *= 2;
  const auto solution = solved(fine);
  return {solution->contact_radius, of(solution), of(rough), static_cast<double>(solution->contact_cells), reason};
}

solver::Body read_body(const solver::Scene& scene, const std::vector<std::string>& read_as) {
  bool upper = std::isinf(scene.lower.young_modulus);
  for (const std::string& choice : read_as) {
    upper = choice == "body=upper";
    if (!upper && choice != "body=lower")
      throw InputError("--read-as " + choice, "allowed of stresses: body=lower, body=upper");
    if (std::isinf((upper ? scene.upper : scene.lower).young_modulus))
      throw InputError("--read-as " + choice, "this body is rigid; allowed: the elastic one");
  }
  return upper ? solver::Body::upper : solver::Body::lower;
}

Json both_parts(const Parts& parts) {
  Json json{{"pressure", Json::array()}, {"shear", Json::array()}};
  for (const solver::PointStresses& at : parts) {
    json["pressure"].push_back(at.by_pressure);
    json["shear"].push_back(at.by_shear);
  }
  return json;
}

}  // namespace

bool is_stress_file(const std::filesystem::path& file, const std::vector<std::string>& columns) {
  constexpr std::array kText{".csv", ".txt", ".dat", ".tsv"};
  if (std::ranges::find(kText, file.extension()) == kText.end() || !std::filesystem::is_regular_file(file))
    return false;
  const std::vector<std::string> names = columns.empty() ? solver::text_table_names(file) : columns;
  const auto has = [&](const char* name) { return std::ranges::find(names, name) != names.end(); };
  return has("x3") && std::ranges::any_of(kComponents, has);
}

Json stress_request(const solver::Scene& scene, const std::filesystem::path& file, const CheckOptions& options,
                    const std::vector<std::string>& read_as) {
  if (!solver::is_bare(scene))
    throw InputError(scene.source.string(),
                     "has a layer; allowed for stresses: half-spaces without a layer between or on them");
  const solver::Body body = read_body(scene, read_as);
  const bool upper = body == solver::Body::upper;
  GivenStresses given = read_stresses(file, options.columns);
  std::string reason;
  const auto exact = exact_stresses(scene, body, reason);
  const RightStresses right =
      exact ? RightStresses{exact->contact_radius, exact->at} : solved_stresses(scene, body, reason);
  find_length_unit(given, right.contact_radius);
  if (const double terms = static_cast<double>(given.points.size()) * right.terms; terms > kMaxTerms)
    throw InputError(file.string(), fmt::format("{} rows, each a sum over {} cells in contact; allowed: at "
                                                "most {:.0f} rows, or larger cells",
                                                given.points.size(), right.terms, kMaxTerms / right.terms));
  Json json{{"name", scene.name},
            {"field", file.string()},
            {"tolerance", options.tolerance.value_or(0.01)},
            {"strict", options.strict},
            {"body", upper ? "upper" : "lower"},
            {"poisson", (upper ? scene.upper : scene.lower).poisson_ratio},
            {"other_poisson", (upper ? scene.lower : scene.upper).poisson_ratio},
            {"contact_radius", right.contact_radius},
            {"conventions", given.conventions},
            {"points", given.points},
            {"given", given.components},
            {"reason", right.reason},
            {"cells", scene.grid.cells}};
  try {
    json["right"] = {both_parts(right.at(given.points, 0.0)), both_parts(right.at(given.points, 0.5))};
    if (right.coarse)
      json["coarse"] = {both_parts(right.coarse(given.points, 0.0)), both_parts(right.coarse(given.points, 0.5))};
  } catch (const std::domain_error& error) {
    throw InputError(file.string(), fmt::format("a point has no stresses to compare with: {}", error.what()));
  }
  return json;
}

}  // namespace slipstick::convergence
