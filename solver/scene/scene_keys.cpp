#include "solver/scene/scene_keys.hpp"

#include <fmt/ranges.h>

#include <array>

#include "solver/elasticity/law/law_kind.hpp"
#include "solver/scene/roughness.hpp"

namespace slipstick::solver {
namespace {

constexpr KeyType kNumber = KeyType::number;
constexpr KeyType kWord = KeyType::word;

std::string shown(double number) { return fmt::format("{:g}", number); }
std::string shown(const std::array<double, 2>& pair) { return fmt::format("[{:g}, {:g}]", pair[0], pair[1]); }

/// A range that depends on another key: its words; the reader checks the numbers.
Range depending(const std::string& words) { return {words, nullptr}; }

/// The keys of a body's table that give its shape, or of each of its tables [[upper.shape]].
void add_shape(SettingKeys& keys, const std::string& table) {
  const Surface surface;
  const std::string at = table + ".";
  using Shapes = std::vector<std::string>;
  const Shapes rough{"roughness"};
  const Shapes map{"height_map"};
  const Shapes with_axis = words_with_axis();
  const auto add = [&](const std::string& name, const std::string& unit, const std::string& otherwise,
                       const Range& allowed, const std::string& meaning, const Shapes& shapes, KeyType type = kNumber) {
    keys.push_back({at + name, type, unit, otherwise, allowed, meaning, shapes});
  };
  const auto add_numbers = [&](const auto& picked) {
    for (const ShapeNumber& number : shape_numbers()) {
      if (!picked(number)) continue;
      Shapes words;
      for (const Shape shape : number.shapes) words.push_back(word_of(shape_words(), shape));
      add(number.name, number.unit, kRequired, number.allowed, number.meaning, words);
    }
  };
  const bool of_shape = table.ends_with(".shape");
  add("shape", "", of_shape ? kRequired : "required; of `[lower]` a plane", one_of(shape_words()),
      "The shape of the body's surface: this word, or tables `[[upper.shape]]`, `[[lower.shape]]`. The gap "
      "is the "
      "sum of both bodies' gaps.",
      {}, kWord);
  add_numbers([](const ShapeNumber& number) { return number.own != nullptr; });
  add("inner_radius", "m", shown(surface.inner_radius), depending(inner_radius_below(1.0).words),
      "Radius of the hole that makes the punch an annulus.", {"flat_punch"});
  add("at", "m", shown(surface.at), kFinite, "Position of the shape's axis.", with_axis, KeyType::pair);
  add("angle", "rad", shown(surface.angle), kFinite, "From x1 to the shape's first axis, positive towards x2.",
      with_axis);
  add("file", "", kRequired, kAny,
      "Heights, one a cell, larger where further away: a CSV matrix with a line for each x1, or the HDF5 "
      "dataset `height`.",
      map, KeyType::file);
  add("spacing", "m", kRequired, kPositive, "Distance of the file's samples.", map, KeyType::pair);
  add("unit", "", word_of(kHeightUnits, surface.map.unit), one_of(kHeightUnits), "Unit of the file's heights.", map,
      kWord);
  add("seed", "", kRequired, kSeeds, "Draws the phases of the random surface.", rough);
  add_numbers([](const ShapeNumber& number) { return number.rough != nullptr; });
  add("shortest", "m", kRequired, depending(fmt::format("from a {:g}th of the period, to half of longest", kMaxWaves)),
      "Shortest wavelength.", rough);
  add("period", "m", "4 times longest", depending("at least longest, finite"),
      "Length after which the surface repeats itself.", rough);
}

void add_body(SettingKeys& keys, const std::string& table) {
  const std::string at = table + ".";
  const SettingKeys body{
      {at + "rigid", KeyType::flag, "", "false", kAny,
       "Whether the body is rigid: then it has neither of the next two keys. One body may be."},
      {at + "young_modulus", kNumber, "Pa", kRequired, kPositive, "Young's modulus."},
      {at + "poisson_ratio", kNumber, "", kRequired, kPoisson, "Poisson's ratio."},
      {at + "yield_stress", kNumber, "Pa", "none", kPositive,
       "Yield stress: a warning says where the peak pressure exceeds it, and --stresses compares with it."},
      {at + "layer.thickness", kNumber, "m", kRequired, kPositive,
       "Thickness of the layer that is bonded to the body."},
      {at + "layer.young_modulus", kNumber, "Pa", kRequired, kPositive, "Young's modulus of that layer."},
      {at + "layer.poisson_ratio", kNumber, "", kRequired, kPoisson, "Poisson's ratio of that layer."}};
  keys.insert(keys.end(), body.begin(), body.end());
}

/// The keys of [layer]: a word for the law, and the law's own numbers.
void add_layer(SettingKeys& keys) {
  std::string meaning = "The layer between the bodies: none";
  for (const LawKind& kind : law_kinds()) meaning += fmt::format(", or {} ({})", kind.meaning, kind.word);
  keys.push_back(
      {"layer.kind", kWord, "", word_of(layer_words(), Scene().layer.kind), one_of(layer_words()), meaning + "."});
  for (const LawKind& kind : law_kinds()) {
    for (const LawParameter& parameter : kind.parameters) {
      keys.push_back({"layer." + parameter.key, kNumber, parameter.unit,
                      fmt::format("required with kind = \"{}\"", kind.word), kNotNegative,
                      fmt::format("{} Only with kind = \"{}\".", parameter.meaning, kind.word)});
    }
  }
}

/// The keys of [load], or of each [[step]], which leaves what it does not say as it was.
void add_loads(SettingKeys& keys, const std::string& table, bool is_step) {
  const std::string at = table + ".";
  const auto first = [&](const std::string& otherwise) { return is_step ? "as before" : otherwise; };
  const SettingKeys loads{
      {at + "normal", kNumber, "N", first(kRequired), kPositive,
       "Normal load; of a pressure from a file it may be left out."},
      {at + "moment_ratio", kNumber, "", first("0 with a force, a displacement or steps; otherwise required"), kRatio,
       "Moment over the limit moment of this pressure and mesh. One of this and the next two."},
      {at + "moment", kNumber, "N m", first("none"), kFinite, "Moment about the grid's origin."},
      {at + "twist", kNumber, "rad", first("none"), kFinite,
       "Imposed twist instead of a moment, counted from the first step: `twist_angle` of a result, whose "
       "`twist` "
       "is normalised."},
      {at + "force", KeyType::pair, "N", first("[0, 0]"), kFinite,
       "Tangential force on the indenter. One of this and the next."},
      {at + "displacement", KeyType::pair, "m", first("none"), kFinite,
       "Imposed displacement instead of a force, counted from the first step."}};
  keys.insert(keys.end(), loads.begin(), loads.end());
}

void add_contact(SettingKeys& keys, const Scene& scene) {
  const SettingKeys contact{
      {"contact.friction", kNumber, "", "required but with friction_law = \"tresca\"", kNotNegative,
       "Coefficient of friction mu; with friction_law = \"power\" k, Pa^(1 - n)."},
      {"contact.friction_law", kWord, "", word_of(kFrictionLaws, scene.contact.friction.kind), one_of(kFrictionLaws),
       "The shear that friction carries under a pressure p: mu p (coulomb); the shear strength (tresca); the "
       "lesser of the two (capped); k p^n (power)."},
      {"contact.shear_strength", kNumber, "Pa", "required with friction_law = \"tresca\" or \"capped\"", kPositive,
       "Largest shear that the interface carries. Only for tresca and capped."},
      {"contact.friction_exponent", kNumber, "", "required with friction_law = \"power\"", kFrictionExponent,
       "Exponent n of the pressure. Only for power."},
      {"contact.friction_map", KeyType::file, "", "\"\"", kAny,
       "Factors of the friction, one a cell: a CSV matrix with a line for each x1, or the HDF5 dataset "
       "`friction`. Empty: 1 everywhere."},
      {"contact.pressure", kWord, "", word_of(kPressureModels, scene.contact.pressure), one_of(kPressureModels),
       "Where the pressure comes from: solved on the same grid, Hertz's at cell centres, Hertz's averaged "
       "over each cell, a file."},
      {"contact.pressure_file", KeyType::file, "", "required with pressure = \"file\"", kAny,
       "Columns x1, x2 (m), pressure (Pa), one row for each contact cell: .csv or .h5. Only with pressure = "
       "\"file\"."},
      {"contact.coupling", kWord, "", word_of(kCouplings, scene.contact.coupling), one_of(kCouplings),
       "auto: the pressure's tangential displacement enters where the bodies are dissimilar; none: it is "
       "neglected; pressure: it enters; full: the shear's normal displacement enters too."}};
  keys.insert(keys.end(), contact.begin(), contact.end());
}

void add_grid_and_solver(SettingKeys& keys, const Scene& scene) {
  const SettingKeys solver{
      {"grid.cells", KeyType::pair, "", "required; of a height map as many as its samples", kCells,
       "Cells along x1 and x2."},
      {"grid.extent", KeyType::pair, "m", "the expected contact and two cells around it", kPositive,
       "Lengths of the grid's sides; not with a height map, required with a pressure from a file. The "
       "contact expected on a bonded layer is computed with the softer of layer and base."},
      {"solver.method", kWord, "", word_of(kMethods, scene.solver.method), one_of(kMethods),
       "Newton's method on the convex program; the paper's algorithm as published."},
      {"solver.program", KeyType::file, "", "\"\"", kAny,
       "Another program that finds pressure and tractions instead of the method: the TOML file with its "
       "command line. It runs only with --allow-programs, or if the command line names it. Empty: none."},
      {"solver.operator", kWord, "", word_of(kOperators, scene.solver.op), one_of(kOperators),
       "Convolution by FFT, direct summation, a dense matrix: the same numbers."},
      {"solver.tolerance", kNumber, "", shown(scene.solver.tolerance), kTolerance,
       "Gap over energy at which a solve stops; of the paper's method Eq. (26) over the sum of mu p."},
      {"solver.max_iterations", kNumber, "", shown(scene.solver.max_iterations), kIterations,
       "Iterations after which a solve gives up."},
      {"solver.model", kWord, "", word_of(kModels, scene.solver.model), one_of(kModels),
       "auto: use symmetry and the contact's size to solve fewer cells; full: the whole grid; exact: no "
       "grid, for a scene that has an exact answer."},
      {"solver.cell_traction", kWord, "", word_of(kCellTractions, scene.solver.cell_traction), one_of(kCellTractions),
       "constant: the traction is constant over each cell; smooth: the number is the value at the cell's "
       "centre of a smooth traction, which gives smaller errors where the pressure falls to zero at the "
       "contact's edge."},
      {"solver.substeps", kNumber, "", shown(scene.solver.substeps), kSubsteps,
       "Parts into which each step's change of load is divided; each is one implicit step. More parts reduce "
       "the error `resolved.path` of a result."},
      {"solver.threads", kNumber, "", shown(scene.solver.threads), kThreads,
       "Threads of one solve, which change no digit. 0: one a processor where the part of the grid that is "
       "solved has many cells, 32,768 for each thread; one for each of many solves (studies, gates)."},
      {"solver.rounding_seed", kNumber, "", shown(static_cast<double>(scene.solver.rounding_seed)), kRoundingSeeds,
       "0: round to nearest; otherwise every operation is rounded at random with this seed."}};
  keys.insert(keys.end(), solver.begin(), solver.end());
}

SettingKeys make_scene_keys() {
  const Scene scene;
  SettingKeys keys{{"name", KeyType::text, "", "the file's name", kAny, "Heads what is printed."},
                   {"cycles", kNumber, "", shown(scene.cycles), depending(cycles_of(1).words),
                    "Repetitions of all steps; steps times cycles is limited."},
                   {"units", kWord, "", word_of(kUnitSets, 0), one_of(kUnitSets),
                    "Units of all numbers of the scene: m, N and Pa, or mm, N and MPa, with N mm for moments. A "
                    "text with a unit, as in radius = \"10 mm\", is in its own unit."}};
  add_shape(keys, "upper");
  keys.push_back({"upper.combine", kWord, "", word_of(kCombinations, scene.combine), one_of(kCombinations),
                  "How several shapes make one surface: their gaps add up, or each point has the nearest. "
                  "Only with two or more tables `[[upper.shape]]`."});
  keys.push_back({"upper.ends_at_grid_edge", KeyType::flag, "", "false", kAny,
                  "Whether the body itself ends at the edge of the grid, so that its contact may reach it."});
  add_body(keys, "upper");
  add_shape(keys, "upper.shape");
  add_shape(keys, "lower");
  add_shape(keys, "lower.shape");
  add_body(keys, "lower");
  add_layer(keys);
  add_contact(keys, scene);
  add_loads(keys, "load", false);
  keys.push_back({"step", KeyType::tables, "", "the loads of `[load]`, at once",
                  depending(fmt::format("at most {} tables", kMaxSteps)),
                  "Tables `[[step]]`: a history, whose steps are solved one after another."});
  keys.push_back({"step.name", KeyType::text, "", "the step's number", kAny, "Names the step in the result."});
  keys.push_back({"step.points", kNumber, "", "1", kPoints,
                  "Equal parts in which the step's loads are brought, each with results and fields as a step."});
  add_loads(keys, "step", true);
  add_grid_and_solver(keys, scene);
  return keys;
}

}  // namespace

const Words<const LawKind*>& layer_words() {
  static const Words<const LawKind*> words = [] {
    Words<const LawKind*> made{{"none", nullptr}};
    for (const LawKind& kind : law_kinds()) made.emplace_back(kind.word, &kind);
    return made;
  }();
  return words;
}

const SettingKeys& scene_keys() {
  static const SettingKeys keys = make_scene_keys();
  return keys;
}

}  // namespace slipstick::solver
