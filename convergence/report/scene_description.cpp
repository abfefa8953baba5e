#include "convergence/report/scene_description.hpp"

#include <fmt/core.h>

#include <cmath>

#include "convergence/runs/run_spec.hpp"
#include "solver/elasticity/law/law_kind.hpp"
#include "solver/model/make_model.hpp"
#include "solver/scene/scene_keys.hpp"

namespace slipstick::convergence {
namespace {

using solver::Scene;
using Summary = decltype(SceneDescription::summary);

std::string shape_text(const solver::Surface& surface) {
  std::string text = solver::to_string(surface.shape);
  for (const solver::ShapeNumber& number : solver::shape_numbers()) {
    if (!number.belongs_to(surface.shape)) continue;
    text += fmt::format(", {} {:g}{}{}", number.name, number.of(surface), number.unit.empty() ? "" : " ",
                        number.unit);
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
    layer = fmt::format(", {:g} mm of {} on it", 1e3 * c->thickness,
                        material_text({c->young_modulus, c->poisson_ratio}));
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
  const auto add = [&](const std::string& words, const std::string& value) {
    rows.emplace_back(words, value);
  };
  for (const solver::Surface& surface : scene.surfaces) add("Indenter", shape_text(surface));
  add("Upper body", material_text(scene.upper));
  add("Lower body", material_text(scene.lower));
  if (scene.layer.kind != nullptr) add("Layer", scene.layer.kind->word);
  add_friction_rows(scene.contact.friction, add);
  add("Pressure", solver::word_of(solver::kPressureModels, scene.contact.pressure));
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
    cells +=
        fmt::format(" on this page; the scene file has {} x {}", scene.grid.cells[0], scene.grid.cells[1]);
  }
  add("Grid", cells);
  const std::string solved_by = scene.solver.program.empty()
                                    ? solver::word_of(solver::kMethods, scene.solver.method)
                                    : scene.solver.program.string();
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
    for (solver::Index j = 0; j < grid.n2; j += 1 + grid.n2 / kShownOnMap)
      row.push_back(coarse(gap_at(i, j)));
  }
  return gap;
}

}  // namespace

SceneDescription describe(const Scene& scene, const Scene& on_page, const std::filesystem::path& file) {
  const solver::Model model = solver::make_model(on_page);
  const solver::Grid grid = model.grid_in_m();
  return {.name = scene.name,
          .text = read_text(file),
          .summary = summary(scene, on_page, grid),
          .gap = gap_of_bodies(model, grid)};
}

}  // namespace slipstick::convergence
