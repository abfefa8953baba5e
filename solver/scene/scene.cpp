#include "solver/scene/scene.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "solver/elasticity/law/law_kind.hpp"
#include "solver/input/input_error.hpp"
#include "solver/scene/last_digits.hpp"
#include "solver/scene/scene_keys.hpp"
#include "solver/scene/surface_geometry.hpp"

namespace slipstick::solver {
namespace {

Surface read_surface(SceneReader& reader, const std::string& table) {
  Surface surface;
  surface.key = table;
  surface.shape = reader.choice(table + ".shape", shape_words());
  Roughness& roughness = surface.roughness;
  if (surface.shape == Shape::roughness) {
    roughness.seed = static_cast<std::uint64_t>(reader.number(table + ".seed"));
  }
  for (const ShapeNumber& number : shape_numbers()) {
    if (number.belongs_to(surface.shape)) number.of(surface) = reader.number(table + "." + number.name);
  }
  if (surface.shape == Shape::power) {  // its unit is m^(1 - exponent)
    surface.coefficient = reader.in_si(surface.coefficient, 1.0 - surface.exponent);
  } else if (surface.shape == Shape::flat_punch) {
    surface.inner_radius =
        reader.number_or(table + ".inner_radius", surface.inner_radius, inner_radius_below(surface.radius));
  } else if (surface.shape == Shape::roughness) {
    const double longest = roughness.longest;
    roughness.period = reader.number_or(table + ".period", 4.0 * longest, period_for(longest));
    roughness.shortest = reader.number(table + ".shortest", shortest_for(longest, roughness.period));
  } else if (surface.shape == Shape::height_map) {
    surface.map.file = reader.path(table + ".file");
    surface.map.spacing = reader.pair(table + ".spacing");
    surface.map.unit = reader.choice_or(table + ".unit", surface.map.unit, kHeightUnits);
  }
  if (!is_measured(surface)) {
    surface.at = reader.find_pair(table + ".at").value_or(surface.at);
    surface.angle = reader.number_or(table + ".angle", surface.angle);
  }
  return surface;
}

/// The shapes of a body: one by the keys of its table, or several by tables [[upper.shape]] with the same keys.
std::vector<Surface> read_surfaces(SceneReader& reader, const std::string& body) {
  const std::string shapes = body + ".shape";
  if (!reader.is_array(shapes)) return {read_surface(reader, body)};
  std::vector<Surface> surfaces;
  const std::size_t count = reader.count(shapes);
  if (count > kMaxShapes) {
    reader.fail(shapes, fmt::format("{} tables", count), fmt::format("at most {}", kMaxShapes));
  }
  for (std::size_t i = 0; i < count; ++i) {
    surfaces.push_back(read_surface(reader, fmt::format("{}[{}]", shapes, i)));
  }
  return surfaces;
}

/// The shapes of both bodies. The gap is the sum of the two bodies' gaps.
void read_shapes(SceneReader& reader, Scene& scene) {
  scene.surfaces = read_surfaces(reader, "upper");
  if (scene.surfaces.size() > 1) scene.combine = reader.choice_or("upper.combine", scene.combine, kCombinations);
  if (!reader.has("lower.shape")) return;
  const std::vector<Surface> lower = read_surfaces(reader, "lower");
  if (scene.combine == Combine::nearest) reader.fail("lower.shape", "(given)", "none with upper.combine = \"nearest\"");
  scene.surfaces.insert(scene.surfaces.end(), lower.begin(), lower.end());
}

std::optional<Coating> read_coating(SceneReader& reader, const std::string& table) {
  const std::array keys{table + ".thickness", table + ".young_modulus", table + ".poisson_ratio"};
  const bool has_key = std::ranges::any_of(keys, [&](const std::string& key) { return reader.has(key); });
  if (!has_key && reader.line(table) == 0) return std::nullopt;
  return Coating{reader.number(keys[0]), reader.number(keys[1]), reader.number(keys[2])};
}

Material read_material(SceneReader& reader, const std::string& body) {
  const std::optional<Coating> coating = read_coating(reader, body + ".layer");
  const std::optional<double> yield_stress = reader.find_number(body + ".yield_stress");
  if (reader.flag_or(body + ".rigid", false)) {
    for (const char* key : {".young_modulus", ".poisson_ratio"}) {
      if (reader.has(body + key)) reader.fail(body + ".rigid", "true", fmt::format("no {}{} with it", body, key));
    }
    return {std::numeric_limits<double>::infinity(), 0.0, coating, yield_stress};
  }
  return {reader.number(body + ".young_modulus"), reader.number(body + ".poisson_ratio"), coating, yield_stress};
}

Layer read_layer(SceneReader& reader) {
  Layer layer{reader.choice_or<const LawKind*>("layer.kind", nullptr, layer_words())};
  if (layer.kind == nullptr) return layer;
  for (const LawParameter& parameter : layer.kind->parameters) {
    layer.values.push_back(reader.number("layer." + parameter.key));
  }
  return layer;
}

/// A number of another law is not a misspelling, so the message lists the numbers of this law.
void refuse_numbers_of_other_laws(SceneReader& reader, FrictionKind kind) {
  const std::string friction = "contact.friction";
  const std::string strength = "contact.shear_strength";
  const std::string exponent = "contact.friction_exponent";
  const std::map<FrictionKind, std::vector<std::string>> numbers{{FrictionKind::coulomb, {friction}},
                                                                 {FrictionKind::tresca, {strength}},
                                                                 {FrictionKind::capped, {friction, strength}},
                                                                 {FrictionKind::power, {friction, exponent}}};
  const std::vector<std::string>& taken = numbers.at(kind);
  for (const std::string& key : {friction, strength, exponent}) {
    if (std::ranges::find(taken, key) != taken.end() || !reader.has(key)) continue;
    reader.fail(key, fmt::format("{}", *reader.find_number(key)),
                fmt::format("left out: friction_law = \"{}\" takes {} and no {}", to_string(kind),
                            fmt::join(taken, ", "), key));
  }
}

FrictionLaw read_friction(SceneReader& reader) {
  FrictionLaw law;
  law.kind = reader.choice_or("contact.friction_law", law.kind, kFrictionLaws);
  const bool tresca = law.kind == FrictionKind::tresca;
  if (law.kind != FrictionKind::capped) reader.prefer_overridden({"contact.shear_strength", "contact.friction"});
  refuse_numbers_of_other_laws(reader, law.kind);
  if (!tresca) law.coefficient = reader.number("contact.friction");
  if (law.kind == FrictionKind::tresca || law.kind == FrictionKind::capped)
    law.shear_strength = reader.number("contact.shear_strength");
  if (law.kind == FrictionKind::power) {  // its coefficient is in Pa^(1 - exponent)
    law.exponent = reader.number("contact.friction_exponent");
    law.coefficient = reader.in_si(law.coefficient, -2.0 * (1.0 - law.exponent));
  }
  if (!reader.text_or("contact.friction_map", "").empty()) law.map = reader.path("contact.friction_map");
  return law;
}

/// Reads the torsion from a table; where the table has none, the torsion is as before.
void read_torsion(SceneReader& reader, const std::string& table, Step& step, std::optional<TorsionLoad>& torsion) {
  const std::vector<std::string> keys{table + ".moment_ratio", table + ".moment", table + ".twist"};
  reader.prefer_overridden(keys);
  const auto ratio = reader.find_number(keys[0]);
  const auto moment = reader.find_number(keys[1]);
  const auto twist = reader.find_number(keys[2]);
  if (ratio.has_value() + moment.has_value() + twist.has_value() > 1) {
    reader.fail(moment ? keys[1] : keys[2], "(together with another torsion load)",
                fmt::format("exactly one of {}", fmt::join(keys, ", ")));
  }
  if (ratio || moment || twist) step.inherited.torsion = false;
  if (ratio) torsion = MomentRatio{*ratio};
  if (moment) torsion = Moment{*moment};
  if (twist) torsion = Twist{*twist};
}

/// Reads a tangential force or displacement; where the table has none, they are as before.
void read_translation(SceneReader& reader, const std::string& table, Step& step) {
  reader.prefer_overridden({table + ".force", table + ".displacement"});
  const auto force = reader.find_pair(table + ".force");
  const auto displacement = reader.find_pair(table + ".displacement");
  if (force && displacement) {
    reader.fail(table + ".displacement", "(together with a force)", "one of force, displacement");
  }
  if (force) step.force = *force;
  if (displacement) step.force = {};
  if (!force && !displacement) return;
  step.displacement = displacement;
  step.inherited.translation = false;
}

/// A step whose torsion may still be missing.
struct ReadStep {
  Step step = {};
  std::optional<TorsionLoad> torsion = {};
  std::size_t points = 1;
};

void read_loads(SceneReader& reader, const std::string& table, ReadStep& read) {
  Step& step = read.step;
  step.key = table;
  if (const auto normal = reader.find_number(table + ".normal")) {
    step.normal = normal;
    step.inherited.normal = false;
  }
  read_torsion(reader, table, step, read.torsion);
  read_translation(reader, table, step);
}

/// The loads before the first step, which brings its normal load at once.
Step unloaded(const Step& step) {
  Step before;
  before.normal = step.normal;
  before.torsion = std::visit([](auto load) -> TorsionLoad { return decltype(load){}; }, step.torsion);
  return before;
}

/// Between a moment and a twist, or a force and a displacement, nothing can be interpolated.
void require_same_loads(SceneReader& reader, const Step& before, const Step& step) {
  const bool torsion = before.torsion.index() == step.torsion.index() || before.torsion == TorsionLoad();
  const bool translation = before.displacement.has_value() == step.displacement.has_value() ||
                           !(brings_translation(before) && brings_translation(step));
  if (!torsion || !translation) {
    reader.fail(step.key + ".points", "(after a step with a load of another kind)",
                "points between loads of one kind, as from a twist to a twist");
  }
}

/// The step of [load], or the steps of [[step]]: each starts from the loads of the step before, the first from [load].
std::vector<Step> read_steps(SceneReader& reader, bool needs_normal, std::size_t& first_points) {
  ReadStep load;
  read_loads(reader, "load", load);
  load.step.inherited = {true, true, true};
  std::vector<ReadStep> read;
  const std::size_t count = reader.count("step");
  if (count > kMaxSteps) {
    reader.fail("step", fmt::format("{} tables", count), fmt::format("at most {}", kMaxSteps));
  }
  for (std::size_t i = 0; i < count; ++i) {
    ReadStep next = read.empty() ? load : read.back();
    read_loads(reader, fmt::format("step[{}]", i), next);
    next.step.name = reader.text_or(next.step.key + ".name", fmt::format("{}", i + 1));
    next.points = static_cast<std::size_t>(reader.number_or(next.step.key + ".points", 1));
    read.push_back(next);
  }
  if (read.empty()) read.push_back(load);
  first_points = read.front().points;
  std::vector<Step> steps;
  for (auto& [step, torsion, points] : read) {
    if (needs_normal && !step.normal) reader.number(step.key + ".normal");  // says what is missing
    if (!torsion && count == 0 && !brings_translation(step)) {
      reader.fail("load.moment_ratio", "(missing)",
                  "exactly one of load.moment_ratio, load.moment, load.twist, or a load.force or "
                  "load.displacement");
    }
    if (torsion) step.torsion = *torsion;
    const Step before = steps.empty() ? unloaded(step) : steps.back();
    if (points > 1) require_same_loads(reader, before, step);
    for (std::size_t i = 1; i < points; ++i) {
      steps.push_back(on_the_way(before, step, static_cast<double>(i) / static_cast<double>(points)));
      steps.back().name = fmt::format("{} {}/{}", step.name, i, points);
    }
    steps.push_back(step);
    if (points > 1) steps.back().name = fmt::format("{0} {1}/{1}", step.name, points);
    if (steps.size() > kMaxSteps)
      reader.fail("step", fmt::format("{} steps", steps.size()), fmt::format("at most {}", kMaxSteps));
  }
  return steps;
}

std::array<Index, 2> read_cells(SceneReader& reader, const std::vector<Surface>& surfaces) {
  if (find_height_map(surfaces) != nullptr && !reader.has("grid.cells")) return {0, 0};  // as many as samples
  const auto cells = reader.pair("grid.cells");
  return {static_cast<Index>(cells[0]), static_cast<Index>(cells[1])};
}

Scene read_scene(SceneReader& reader, const std::filesystem::path& file) {
  Scene scene;
  scene.source = file;
  scene.name = reader.text_or("name", file.stem().string());
  reader.measure_in(reader.choice_or("units", 0, kUnitSets));
  read_shapes(reader, scene);
  scene.ends_at_grid_edge = reader.flag_or("upper.ends_at_grid_edge", scene.ends_at_grid_edge);
  scene.upper = read_material(reader, "upper");
  scene.lower = read_material(reader, "lower");
  scene.layer = read_layer(reader);

  scene.contact.friction = read_friction(reader);
  scene.contact.pressure = reader.choice_or("contact.pressure", scene.contact.pressure, kPressureModels);
  if (scene.contact.pressure == PressureModel::file) scene.contact.pressure_file = reader.path("contact.pressure_file");
  scene.contact.coupling = reader.choice_or("contact.coupling", scene.contact.coupling, kCouplings);

  scene.steps = read_steps(reader, scene.contact.pressure != PressureModel::file, scene.first_points);
  if (scene.steps.size() > 1 || reader.has("cycles")) {
    scene.cycles = static_cast<int>(reader.number_or("cycles", scene.cycles, cycles_of(scene.steps.size())));
    if (scene.cycles > 1 && scene.first_points > 1)
      require_same_loads(reader, scene.steps.back(), scene.steps[scene.first_points - 1]);
  }

  scene.grid.cells = read_cells(reader, scene.surfaces);
  scene.grid.extent = reader.find_pair("grid.extent");

  scene.solver.method = reader.choice_or("solver.method", scene.solver.method, kMethods);
  if (!reader.text_or("solver.program", "").empty()) scene.solver.program = reader.path("solver.program");
  scene.solver.model = reader.choice_or("solver.model", scene.solver.model, kModels);
  scene.solver.cell_traction = reader.choice_or("solver.cell_traction", scene.solver.cell_traction, kCellTractions);
  scene.solver.op = reader.choice_or("solver.operator", scene.solver.op, kOperators);
  scene.solver.tolerance = reader.number_or("solver.tolerance", scene.solver.tolerance);
  scene.solver.max_iterations =
      static_cast<int>(reader.number_or("solver.max_iterations", scene.solver.max_iterations));
  scene.solver.substeps = static_cast<int>(reader.number_or("solver.substeps", scene.solver.substeps));
  scene.solver.threads = static_cast<int>(reader.number_or("solver.threads", scene.solver.threads));
  scene.solver.rounding_seed = static_cast<std::int64_t>(
      reader.number_or("solver.rounding_seed", static_cast<double>(scene.solver.rounding_seed)));
  reader.reject_unknown();
  validate(scene, &reader);
  scene.units = reader.units().words();
  return without_last_digits(std::move(scene));
}

}  // namespace

bool is_coated(const Scene& scene) { return scene.upper.coating || scene.lower.coating; }

bool is_bare(const Scene& scene) { return scene.layer.kind == nullptr && !is_coated(scene); }

bool brings_translation(const Step& step) { return step.displacement || step.force != std::array<double, 2>{}; }

Step on_the_way(const Step& before, const Step& step, double part) {
  Step at = step;
  const auto mix = [part](double from, double to) { return from + part * (to - from); };
  if (step.normal && before.normal) at.normal = mix(*before.normal, *step.normal);
  std::visit(
      [&](auto& load) {
        const auto from = value_if<std::remove_cvref_t<decltype(load)>>(before.torsion);
        load.value = mix(from.value_or(0.0), load.value);
      },
      at.torsion);
  for (std::size_t i = 0; i < 2; ++i) {
    at.force[i] = mix(before.force[i], step.force[i]);
    if (step.displacement)
      (*at.displacement)[i] = mix(before.displacement ? (*before.displacement)[i] : 0.0, (*step.displacement)[i]);
  }
  return at;
}

Step step_of(const Scene& scene, std::size_t k) {
  const std::size_t point = k % scene.steps.size();
  Step step = scene.steps[point];
  if (k < scene.steps.size()) return step;
  const Step& last = scene.steps.back();
  if (point + 1 < scene.first_points) {  // from the end of the last cycle
    const Step end = step_of(scene, k + scene.first_points - 1 - point);
    Step at = on_the_way(last, end, static_cast<double>(point + 1) / static_cast<double>(scene.first_points));
    at.name = step.name;
    return at;
  }
  if (step.inherited.normal) step.normal = last.normal;
  if (step.inherited.torsion) step.torsion = last.torsion;
  if (step.inherited.translation) {
    step.force = last.force;
    step.displacement = last.displacement;
  }
  return step;
}

std::string to_string(Shape shape) { return kind_of(shape).word; }
std::string to_string(PressureModel model) { return word_of(kPressureModels, model); }
std::string to_string(OperatorKind kind) { return word_of(kOperators, kind); }
std::string to_string(FrictionKind kind) { return word_of(kFrictionLaws, kind); }
std::string to_string(Method method) { return word_of(kMethods, method); }
std::string to_string(CellTraction traction) { return word_of(kCellTractions, traction); }

Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return read_scene_text(settings_of(file).text, file, overrides);
}

Scene read_scene_text(const std::string& text, const std::filesystem::path& file,
                      const std::vector<std::string>& overrides) {
  SceneReader reader(SettingsText{text, file}, overrides, scene_keys());
  return read_scene(reader, file);
}

}  // namespace slipstick::solver
