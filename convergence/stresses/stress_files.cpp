#include "convergence/stresses/stress_files.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "convergence/results/make_record.hpp"
#include "convergence/stresses/stress_volume.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/units.hpp"
#include "solver/input/whole_file.hpp"
#include "solver/model/make_model.hpp"
#include "solver/stresses/subsurface_stresses.hpp"

namespace slipstick::convergence {

using solver::InputError;

namespace {

constexpr std::string_view kDepthNumber = "{depth}", kBody = "{body}";

const char* word(solver::Body body) { return body == solver::Body::upper ? "upper" : "lower"; }

/// The name with its mark, if it has one, replaced by a word.
std::string with(std::string name, std::string_view mark, const std::string& word) {
  const auto at = name.find(mark);
  return at == std::string::npos ? name : name.replace(at, mark.size(), word);
}

/// The depths of a scene, from their words.
class DepthReader {
 public:
  explicit DepthReader(const solver::Scene& scene) : scene_(scene) {}

  /// FROM..TO:N, or one depth.
  std::vector<double> read(const std::string& word) {
    const auto dots = word.find("..");
    const auto colon = word.rfind(':');
    if (dots == std::string::npos || colon == std::string::npos || colon < dots) return {depth_of(word)};
    const auto count = solver::parse_number(word.substr(colon + 1), 0);
    if (!count || !(*count >= 2.0 && *count <= 10000.0) || *count != std::floor(*count))
      throw InputError("--depths " + word, "allowed: FROM..TO:N with a whole number N from 2 to 10000");
    const double from = depth_of(word.substr(0, dots));
    const double ratio = depth_of(word.substr(dots + 2, colon - dots - 2)) / from;
    std::vector<double> depths;
    for (double i = 0.0; i < *count; ++i) depths.push_back(from * std::pow(ratio, i / (*count - 1.0)));
    return depths;
  }

 private:
  /// In m, with its unit, or over the radius of a Hertzian contact, as 0.4a.
  double depth_of(const std::string& word) {
    std::optional<double> depth = solver::parse_number(word, 0);
    if (!depth && word.ends_with('a')) {
      depth = solver::parse_number(std::string_view(word).substr(0, word.size() - 1), 0);
      if (depth) *depth *= contact_radius(word);
    }
    if (!depth) depth = solver::Units().read(word, "m");
    if (!depth || !(*depth > 0.0) || !std::isfinite(*depth))
      throw InputError("--depths " + word,
                       "allowed: depths above zero in m, with a unit, as \"20 um\", or over a Hertzian contact's "
                       "radius, as 0.4a; FROM..TO:N for N depths whose ratios are equal");
    return *depth;
  }

  /// m; of an ellipse the radius of the circle of equal area.
  double contact_radius(const std::string& word) {
    if (radius_) return *radius_;
    const solver::Model model = solver::make_model(scene_);
    if (!model.hertz)
      throw InputError("--depths " + word, "allowed: lengths; the contact's radius is not known before the solve");
    radius_ = std::sqrt(model.hertz->semi_axis_1 * model.hertz->semi_axis_2) * model.length_unit;
    return *radius_;
  }

  const solver::Scene& scene_;
  std::optional<double> radius_;
};

}  // namespace

bool StressFiles::is_volume() const { return file.ends_with(".vtr"); }

std::string StressFiles::name(std::size_t depth, solver::Body body) const {
  return with(with(file, kDepthNumber, std::to_string(depth + 1)), kBody, word(body));
}

std::string StressFiles::figure_name(solver::Body body) const { return with(figure, kBody, word(body)); }

std::vector<solver::Body> StressFiles::bodies(const solver::Scene& scene) const {
  std::vector<solver::Body> elastic;
  if (!std::isinf(scene.lower.young_modulus)) elastic.push_back(solver::Body::lower);
  if (!std::isinf(scene.upper.young_modulus)) elastic.push_back(solver::Body::upper);
  if (file.find(kBody) == std::string::npos) elastic.resize(1);
  return elastic;
}

void StressFiles::read_depths(const solver::Scene& scene) {
  if (!is_volume()) solver::require_field_format(file, "--stresses");
  if (!figure.empty() && !is_volume())
    throw InputError("--stress-figure " + figure, "allowed: with a volume, --stresses FILE.vtr");
  DepthReader reader(scene);
  for (const std::string& word : depth_words) {
    const std::vector<double> read = reader.read(word);
    depths.insert(depths.end(), read.begin(), read.end());
  }
  if (is_volume()) {
    std::vector<double> ascending = depths;
    std::ranges::sort(ascending);
    if (std::ranges::adjacent_find(ascending) != ascending.end() || file.find(kDepthNumber) != std::string::npos)
      throw InputError("--stresses " + file, "allowed: a volume without {depth} in its name, and each depth once");
  } else if (depths.size() > 1 && file.find(kDepthNumber) == std::string::npos) {
    throw InputError("--stresses " + file,
                     "allowed for several depths: a volume, as stress.vtr, or a name with {depth}: a file a depth");
  }
  if (!solver::is_bare(scene)) {
    throw InputError(scene.source.string(),
                     "has a layer; allowed with --stresses: half-spaces without a layer between or on them");
  }
  if (fatigue.any() && !has_history(scene)) {
    throw InputError(fatigue.findley ? "--findley" : "--dang-van",
                     "allowed: a scene with a history of loads: steps, or cycles");
  }
  if (scene.solver.model == solver::ModelChoice::exact)
    throw InputError("--stresses " + file, "allowed: a solve on a grid; slipstick exact --at has exact stresses");
}

namespace {

Json stresses_of(solver::Body body, const StressFiles& files, const solver::Scene& scene,
                 const solver::Solution& solution) {
  const solver::Grid& grid = solution.grid;
  const auto& material = body == solver::Body::upper ? scene.upper : scene.lower;
  solver::SubsurfaceStresses stresses(solution, material.poisson_ratio, body, solution.threads);
  solver::LargestStresses largest;
  const auto plane_at = [&](double depth) {
    solver::StressPlane plane = stresses.at(depth);
    largest.include(plane, grid);
    return plane;
  };
  if (files.is_volume()) {
    const std::string file = files.name(0, body);
    solver::write_whole_file(
        file, [&](std::FILE* stream) { write_stress_volume(stream, file, grid, files.depths, plane_at); });
  }
  for (std::size_t d = 0; d < files.depths.size() && !files.is_volume(); ++d) {
    const solver::StressPlane plane = plane_at(files.depths[d]);
    std::vector<solver::Column> columns{{"x1", solver::cell_x1(grid)}, {"x2", solver::cell_x2(grid)}};
    if (std::filesystem::path(files.name(d, body)).extension() == ".csv")  // as check reads them
      columns.push_back({"x3", Eigen::ArrayXd::Constant(grid.cells(), files.depths[d])});
    for (std::size_t a = 0; a < plane.stress.size(); ++a) columns.push_back({kStressNames[a], plane.stress[a]});
    columns.push_back({kStressNames.back(), solver::von_mises(plane.stress)});
    solver::write_fields(files.name(d, body), grid, columns, Eigen::ArrayXd::Ones(grid.cells()));
  }
  const auto json = [](const solver::LargestStresses::Place& place) {
    return Json{{"value", place.value}, {"at", place.at}};
  };
  Json found{{"body", word(body)},
             {"depths", files.depths},
             {"von_mises", json(largest.von_mises)},
             {"tresca", json(largest.tresca)},
             {"tension", json(largest.tension)}};
  if (const auto yield = material.yield_stress) found["yield_ratio"] = largest.von_mises.value / *yield;
  return found;
}

/// The largest parameters over the states of a cycle, at all depths.
Json fatigue(solver::Body body, double poisson, const StressFiles& files,
             const std::vector<solver::SolutionFields>& cycle, int threads) {
  const auto& asked = files.fatigue;
  solver::LargestFatigue largest;
  std::vector<solver::StressPlane> states(cycle.size());
  for (const double depth : files.depths) {
    for (std::size_t i = 0; i < cycle.size(); ++i)
      states[i] = solver::SubsurfaceStresses(cycle[i], poisson, body, threads).at(depth);
    largest.include(states, asked, cycle[0].grid);
  }
  Json json{{"states", cycle.size()}};
  if (const auto& [value, shear, mean, most] = largest.dang_van; asked.dang_van)
    json["dang_van"] = {{"alpha", *asked.dang_van}, {"value", value},           {"at", largest.dang_van_at},
                        {"shear", shear},           {"hydrostatic_mean", mean}, {"hydrostatic_largest", most}};
  if (const auto& [value, shear, normal_stress, normal] = largest.findley; asked.findley)
    json["findley"] = {{"k", *asked.findley},
                       {"value", value},
                       {"at", largest.findley_at},
                       {"shear", shear},
                       {"normal_stress", normal_stress},
                       {"normal", normal}};
  return json;
}

}  // namespace

Json write_stresses(const StressFiles& files, const solver::Scene& scene, const solver::Solution& solution,
                    const std::vector<solver::SolutionFields>& cycle) {
  Json found;
  for (const solver::Body body : files.bodies(scene)) {
    const auto& material = body == solver::Body::upper ? scene.upper : scene.lower;
    Json of_body = stresses_of(body, files, scene, solution);
    if (files.fatigue.any() && cycle.size() != scene.steps.size()) {
      set_missing(of_body, "fatigue", "the states of the last cycle are not all known");
    } else if (files.fatigue.any()) {
      of_body["fatigue"] = fatigue(body, material.poisson_ratio, files, cycle, solution.threads);
    }
    (found.is_null() ? found : found[word(body)]) = std::move(of_body);
  }
  return found;
}

std::string stresses_text(const Json& found) {
  const auto line = [](const char* label, const std::string& name, const Json& largest) {
    const auto metres = [&](std::size_t axis) { return number_text(largest["at"][axis].get<double>()); };
    return text_line(label, fmt::format("{} {} Pa at most, at x1 = {} m, x2 = {} m, depth {} m", name,
                                        number_text(largest["value"].get<double>()), metres(0), metres(1), metres(2)));
  };
  std::string text =
      line("stresses", fmt::format("{} body: von Mises", found["body"].get<std::string>()), found["von_mises"]);
  if (found.contains("yield_ratio"))
    text += text_line("", fmt::format("{} times the yield stress", number_text(found["yield_ratio"].get<double>())));
  const Json none, &fatigue = found.contains("fatigue") ? found["fatigue"] : none;
  for (const auto& [key, name] : {std::pair("dang_van", "Dang Van"), {"findley", "Findley"}})
    if (fatigue.contains(key)) text += line("", name, fatigue[key]);
  if (found.contains("upper")) text += stresses_text(found["upper"]);
  return text;
}

}  // namespace slipstick::convergence
