#include "convergence/report/page.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "convergence/runs/run_spec.hpp"
#include "solver/elasticity/law/law_kind.hpp"
#include "solver/model/make_model.hpp"
#include "solver/scene/surface_geometry.hpp"

namespace slipstick::convergence {

void to_json(Json& json, const PageNumber& row) {
  json = {{"key", row.key}, {"words", row.words}, {"unit", row.unit}, {"value", row.value}, {"basis", row.basis}};
  set_numbers(json, {{"reference", row.reference},
                     {"error", row.error},
                     {"mesh", row.mesh},
                     {"path", row.path},
                     {"uncertainty", row.uncertainty}});
}

void to_json(Json& json, const CostPoint& point) {
  json = {{"method", point.method}, {"cells", point.cells}, {"tolerance", point.tolerance}, {"status", point.status}};
  set_numbers(json, {{"seconds", point.seconds}, {"error", point.error}});
}

void to_json(Json& json, const PageProgram& row) {
  json = {{"name", row.name},       {"cells", row.cells},     {"status", row.status},
          {"version", row.version}, {"message", row.message}, {"number", row.number}};
  set_numbers(json, {{"seconds", row.seconds}, {"cpu_seconds", row.cpu_seconds}, {"error", row.error}});
}

namespace {

void set(Json& json, const std::string& key, const std::optional<Json>& part) {
  if (part) json[key] = *part;
}

Json to_json(const SceneDescription& scene) {
  const SceneDescription::Gap& gap = scene.gap;
  return {
      {"name", scene.name},
      {"text", scene.text},
      {"summary", scene.summary},
      {"gap", {{"x1", gap.x1}, {"along_1", gap.along_1}, {"x2", gap.x2}, {"along_2", gap.along_2}, {"map", gap.map}}}};
}

Json to_json(const Costs& costs) {
  Json cost{{"number", costs.cost.number}, {"points", costs.cost.points}, {"choices", costs.cost.choices}};
  set_number(cost, "reference_uncertainty", costs.cost.reference_uncertainty);
  Json json{{"cost", std::move(cost)}};
  if (costs.programs) json.emplace("programs", *costs.programs);
  set(json, "operators", costs.operators);
  return json;
}

using solver::Scene;
using Summary = decltype(SceneDescription::summary);

std::string shape_text(const solver::Surface& surface) {
  std::string text = solver::to_string(surface.shape);
  for (const solver::ShapeNumber& number : solver::shape_numbers()) {
    if (!number.belongs_to(surface.shape)) continue;
    text += fmt::format(", {} {:g}{}{}", number.name, number.of(surface), number.unit.empty() ? "" : " ", number.unit);
  }
  if (surface.shape == solver::Shape::height_map) text += " " + surface.map.file.filename().string();
  if (surface.at[0] != 0.0 || surface.at[1] != 0.0) {
    text += fmt::format(", at ({:g}, {:g}) m", surface.at[0], surface.at[1]);
  }
  if (surface.angle != 0.0) text += fmt::format(", turned by {:g} rad", surface.angle);
  return text;
}

std::string material_text(const solver::Material& material) {
  std::string layer;
  if (const auto& c = material.coating) {
    layer =
        fmt::format(", {:g} mm of {} on it", 1e3 * c->thickness, material_text({c->young_modulus, c->poisson_ratio}));
  }
  if (std::isinf(material.young_modulus)) return "rigid" + layer;
  return fmt::format("E = {:g} GPa, ν = {:g}", 1e-9 * material.young_modulus, material.poisson_ratio) + layer;
}

std::string load_text(const solver::Step& step) {
  std::string text = step.normal ? fmt::format("{:g} N", *step.normal) : "load of the pressure's file";
  if (const auto ratio = solver::value_if<solver::MomentRatio>(step.torsion)) {
    if (*ratio != 0.0) text += fmt::format(", moment {:.9g} of its limit", *ratio);
  } else if (const auto moment = solver::value_if<solver::Moment>(step.torsion)) {
    text += fmt::format(", moment {:g} N m", *moment);
  } else {
    text += fmt::format(", twisted by {:g} rad", solver::value_if<solver::Twist>(step.torsion).value());
  }
  if (step.displacement) {
    text += fmt::format(", moved by ({:g}, {:g}) m", (*step.displacement)[0], (*step.displacement)[1]);
  } else if (step.force[0] != 0.0 || step.force[1] != 0.0) {
    text += fmt::format(", force ({:g}, {:g}) N", step.force[0], step.force[1]);
  }
  return text;
}

/// The friction's law in words.
void add_friction_rows(const solver::FrictionLaw& law, const auto& add) {
  using solver::FrictionKind;
  if (law.kind != FrictionKind::coulomb) add("Friction law", to_string(law.kind));
  if (law.kind == FrictionKind::power) {
    add("Friction", fmt::format("{:g} Pa^{:g} p^{:g}", law.coefficient, 1.0 - law.exponent, law.exponent));
  } else if (law.kind != FrictionKind::tresca) {
    add("Coefficient of friction", fmt::format("{:g}", law.coefficient));
  }
  if (law.kind == FrictionKind::tresca || law.kind == FrictionKind::capped)
    add("Shear strength", fmt::format("{:g} Pa", law.shear_strength));
  if (!law.map.empty()) add("Factors of the friction", law.map.filename().string());
}

Summary summary(const Scene& scene, const Scene& on_page, const solver::Grid& grid) {
  Summary rows;
  const auto add = [&](const std::string& words, const std::string& value) { rows.emplace_back(words, value); };
  for (const solver::Surface& surface : scene.surfaces) add("Indenter", shape_text(surface));
  add("Upper body", material_text(scene.upper));
  add("Lower body", material_text(scene.lower));
  if (scene.layer.kind != nullptr) add("Layer", scene.layer.kind->word);
  add_friction_rows(scene.contact.friction, add);
  add("Pressure", to_string(scene.contact.pressure));
  if (scene.steps.size() == 1) {
    add("Loads", load_text(scene.steps.front()));
  } else {
    add("Steps", scene.cycles > 1 ? fmt::format("{}, {} times", scene.steps.size(), scene.cycles)
                                  : fmt::format("{}", scene.steps.size()));
    add("First step", load_text(scene.steps.front()));
    add("Last step", load_text(scene.steps.back()));
  }
  std::string cells = fmt::format("{} x {} cells", grid.n1, grid.n2);
  if (scene.grid.cells != on_page.grid.cells) {
    cells += fmt::format(" on this page; the scene file has {} x {}", scene.grid.cells[0], scene.grid.cells[1]);
  }
  add("Grid", cells);
  const std::string solved_by =
      scene.solver.program.empty() ? to_string(scene.solver.method) : scene.solver.program.string();
  add(scene.solver.program.empty() ? "Method" : "Program",
      fmt::format("{}, to a tolerance of {:g}", solved_by, scene.solver.tolerance));
  return rows;
}

/// Points of a row through the grid's centre, and along each side of a map, so that a figure stays small.
constexpr solver::Index kShown = 400;
constexpr solver::Index kShownOnMap = 96;

/// Four digits, enough for a colour.
double coarse(double value) { return std::isfinite(value) ? std::stod(fmt::format("{:.4g}", value)) : value; }

SceneDescription::Gap gap_of_bodies(const solver::Model& model, const solver::Grid& grid) {
  SceneDescription::Gap gap;
  const double unit = model.length_unit;
  const auto gap_at = [&](solver::Index i, solver::Index j) {
    const double value = unit * model.gap[i * grid.n2 + j];
    return std::isfinite(value) ? value : std::nan("");
  };
  for (solver::Index i = 0; i < grid.n1; i += 1 + grid.n1 / kShown) {
    gap.x1.push_back(grid.x1(i));
    gap.along_1.push_back(gap_at(i, grid.n2 / 2));
  }
  for (solver::Index j = 0; j < grid.n2; j += 1 + grid.n2 / kShown) {
    gap.x2.push_back(grid.x2(j));
    gap.along_2.push_back(gap_at(grid.n1 / 2, j));
  }
  for (solver::Index i = 0; i < grid.n1; i += 1 + grid.n1 / kShownOnMap) {
    std::vector<double>& row = gap.map.emplace_back();
    for (solver::Index j = 0; j < grid.n2; j += 1 + grid.n2 / kShownOnMap) row.push_back(coarse(gap_at(i, j)));
  }
  return gap;
}

}  // namespace

PageSize page_size(Effort effort) {
  if (effort == Effort::quick) {
    return {.most_cells = 64,
            .most_study_cells = 64,
            .shifts = 1,
            .method_cells = 32,
            .operator_cells = {8, 12, 16, 24},
            .repetitions = 2,
            .finer_meshes = false,
            .long_history = 40};
  }
  const bool full = effort == Effort::full;
  return {.most_cells = full ? 1024 : 256,
          .most_study_cells = full ? 1024 : 256,
          .shifts = 4,
          .method_cells = full ? 128 : 64,
          .operator_cells = {8, 12, 16, 24, 32, 48},
          .repetitions = 3,
          .finer_meshes = true,
          .long_history = std::numeric_limits<std::size_t>::max()};
}

std::string Headline::verdict() const {
  constexpr const char* kVerdicts[] = {"good", "open", "bad"};
  Shown worst = Shown::holds;
  for (const Finding& finding : findings) worst = std::max(worst, finding.shown);
  return kVerdicts[static_cast<int>(worst)];
}

Json to_json(const Headline& headline) {
  constexpr const char* kChecks[] = {"holds", "open", "fails"};
  Json lines = Json::array();
  Json counts{{"checks", Json::object()}};
  for (const auto& [what, line, found] : headline.findings) {
    lines.push_back({what, line});
    counts.front().emplace(what, kChecks[static_cast<int>(found)]);
  }
  counts.update(headline.counts);
  Json numbers = Json::object();
  for (const auto& [key, value] : headline.numbers) numbers.emplace(key, value);
  Json json{{"verdict", headline.verdict()},
            {"commit", headline.commit},
            {"lines", lines},
            {"numbers", numbers},
            {"counts", counts},
            {"changes", headline.changes}};
  if (headline.since.empty()) {
    set_missing(json, "since", "the first page in its folder");
  } else {
    json.emplace("since", headline.since);
  }
  return json;
}

Json to_json(const SceneCosts& costs) {
  Json json{{"provenance", costs.provenance}, {"scene", costs.scene}, {"numbers", costs.numbers}};
  json.update(to_json(costs.costs));
  return json;
}

Json to_json(const Page& page) {
  Json json{{"provenance", page.provenance},
            {"scene", to_json(page.scene)},
            {"answer", page.answer},
            {"fields", page.fields}};
  set(json, "check", page.check);
  json.update(Json{{"studies", page.studies}, {"numbers", page.numbers}});
  set(json, "uncertainty", page.uncertainty);
  if (page.costs) json.update(to_json(*page.costs));
  set(json, "hard", page.hard);
  set(json, "digits", page.digits);
  set(json, "paper", page.paper);
  json.emplace("headline", to_json(page.headline));
  return json;
}

SceneDescription describe(const Scene& scene, const Scene& on_page, const std::filesystem::path& file) {
  const solver::Model model = solver::make_model(on_page);
  const solver::Grid grid = model.grid_in_m();
  return {.name = scene.name,
          .text = read_text(file),
          .summary = summary(scene, on_page, grid),
          .gap = gap_of_bodies(model, grid)};
}

}  // namespace slipstick::convergence
