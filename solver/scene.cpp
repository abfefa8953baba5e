#include "solver/scene.hpp"

#include <fmt/core.h>

#include <cmath>
#include <limits>

#include "solver/input_error.hpp"
#include "solver/scene_reader.hpp"

namespace slipstick::solver {
namespace {

template <typename Value>
using Words = std::vector<std::pair<std::string, Value>>;

const Words<Shape> kShapes{{"sphere", Shape::sphere},
                           {"ellipsoid", Shape::ellipsoid},
                           {"cone", Shape::cone},
                           {"flat_punch", Shape::flat_punch},
                           {"height_map", Shape::height_map}};
const Words<PressureModel> kPressureModels{{"solved", PressureModel::solved},
                                           {"hertz", PressureModel::hertz},
                                           {"hertz_averaged", PressureModel::hertz_averaged},
                                           {"file", PressureModel::file}};
const Words<Coupling> kCouplings{
    {"auto", Coupling::automatic}, {"none", Coupling::none}, {"pressure", Coupling::pressure}};
const Words<OperatorKind> kOperators{
    {"dcfft", OperatorKind::dcfft}, {"direct", OperatorKind::direct}, {"dense", OperatorKind::dense}};
const Words<Method> kMethods{{"coulomb", Method::coulomb},
                             {"projected_gradient", Method::projected_gradient},
                             {"paper", Method::paper}};
const Words<ModelChoice> kModels{
    {"auto", ModelChoice::automatic}, {"full", ModelChoice::full}, {"exact", ModelChoice::exact}};
const Words<Precision> kPrecisions{{"double", Precision::double_precision}, {"mixed", Precision::mixed}};

template <typename Value>
std::string word_of(const Words<Value>& words, Value value) {
  for (const auto& [word, meaning] : words) {
    if (meaning == value) return word;
  }
  throw std::logic_error("a value without a word");
}

const Range kPositive{"positive and finite", [](double x) { return x > 0.0 && std::isfinite(x); }};
const Range kNotNegative{"zero or positive, finite", [](double x) { return x >= 0.0 && std::isfinite(x); }};
const Range kRatio{"from 0 to below 1 (1 is gross slip)", [](double x) { return x >= 0.0 && x < 1.0; }};
const Range kPoisson{"from 0 to 0.5", [](double x) { return x >= 0.0 && x <= 0.5; }};
const Range kZero{"0 (tangential forces are not modelled)", [](double x) { return x == 0.0; }};
const Range kTolerance{"from 1e-15 to below 1", [](double x) { return x >= 1e-15 && x < 1.0; }};

Range whole(double low, double high) {
  return {fmt::format("a whole number from {:g} to {:g}", low, high),
          [low, high](double x) { return x >= low && x <= high && x == std::floor(x); }};
}

Surface read_surface(SceneReader& reader) {
  Surface surface;
  surface.shape = reader.choice("upper.shape", kShapes);
  switch (surface.shape) {
    case Shape::sphere:
    case Shape::flat_punch:
      surface.radius = reader.number("upper.radius", kPositive);
      break;
    case Shape::ellipsoid:
      surface.radius_1 = reader.number("upper.radius_1", kPositive);
      surface.radius_2 = reader.number("upper.radius_2", kPositive);
      break;
    case Shape::cone:
      surface.slope = reader.number("upper.slope", kPositive);
      break;
    case Shape::height_map:
      surface.file = reader.path("upper.file");
      surface.spacing = reader.pair("upper.spacing", kPositive);
      break;
  }
  return surface;
}

Material read_material(SceneReader& reader, const std::string& body) {
  if (reader.flag_or(body + ".rigid", false)) {
    for (const char* key : {".young_modulus", ".poisson_ratio"}) {
      if (reader.has(body + key))
        reader.fail(body + ".rigid", "true", fmt::format("{}{} left out beside it", body, key));
    }
    return {std::numeric_limits<double>::infinity(), 0.0};
  }
  return {reader.number(body + ".young_modulus", kPositive),
          reader.number(body + ".poisson_ratio", kPoisson)};
}

TorsionLoad read_torsion(SceneReader& reader) {
  reader.prefer_overridden({"load.moment_ratio", "load.moment", "load.twist"});
  const TorsionLoad load{reader.find_number("load.moment_ratio", kRatio),
                         reader.find_number("load.moment", kNotNegative),
                         reader.find_number("load.twist", kNotNegative)};
  const int given = load.moment_ratio.has_value() + load.moment.has_value() + load.twist.has_value();
  if (given != 1) {
    const char* key = load.moment ? "load.moment" : load.twist ? "load.twist" : "load.moment_ratio";
    reader.fail(key, given == 0 ? "(missing)" : "(with another torsion load beside it)",
                "exactly one of load.moment_ratio, load.moment, load.twist");
  }
  return load;
}

std::array<Index, 2> read_cells(SceneReader& reader, const Surface& surface) {
  const Range allowed = whole(1, 65536);
  if (surface.shape == Shape::height_map && !reader.has("grid.cells")) return {0, 0};  // as many as samples
  const auto cells = reader.pair("grid.cells", allowed);
  return {static_cast<Index>(cells[0]), static_cast<Index>(cells[1])};
}

void require_consistent(SceneReader& reader, const Scene& scene) {
  if (std::isinf(scene.upper.young_modulus) && std::isinf(scene.lower.young_modulus)) {
    reader.fail("lower.rigid", "true", "false, since the upper body is rigid");
  }
  const bool hertzian = scene.surface.shape == Shape::sphere || scene.surface.shape == Shape::ellipsoid;
  const bool asks_hertz =
      scene.pressure == PressureModel::hertz || scene.pressure == PressureModel::hertz_averaged;
  if (asks_hertz && !hertzian) {
    reader.fail("contact.pressure", fmt::format("\"{}\"", to_string(scene.pressure)),
                "solved, file (Hertz's pressure belongs to a sphere or an ellipsoid)");
  }
  if (scene.precision == Precision::mixed &&
      (scene.op != OperatorKind::dcfft || scene.method != Method::coulomb)) {
    reader.fail("solver.precision", "\"mixed\"",
                "double, or mixed with method = \"coulomb\" and operator = \"dcfft\"");
  }
  if (scene.surface.shape == Shape::height_map && scene.extent) {
    reader.fail("grid.extent", "(given)", "left out for a height map: upper.spacing says it");
  }
  if (scene.pressure == PressureModel::file && !scene.extent) {
    reader.fail("grid.extent", "(missing)", "[L1, L2] in m, since the pressure's cells come from a file");
  }
}

}  // namespace

std::string to_string(Shape shape) { return word_of(kShapes, shape); }
std::string to_string(PressureModel model) { return word_of(kPressureModels, model); }
std::string to_string(OperatorKind kind) { return word_of(kOperators, kind); }
std::string to_string(Method method) { return word_of(kMethods, method); }
std::string to_string(Precision precision) { return word_of(kPrecisions, precision); }

Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  SceneReader reader(file, overrides);
  Scene scene;
  scene.source = file;
  scene.name = reader.text_or("name", file.stem().string());
  scene.surface = read_surface(reader);
  scene.upper = read_material(reader, "upper");
  scene.lower = read_material(reader, "lower");

  scene.friction = reader.number("contact.friction", kNotNegative);
  scene.pressure = reader.choice_or("contact.pressure", PressureModel::solved, kPressureModels);
  if (scene.pressure == PressureModel::file) scene.pressure_file = reader.path("contact.pressure_file");
  scene.coupling = reader.choice_or("contact.coupling", Coupling::automatic, kCouplings);

  scene.normal_load = scene.pressure == PressureModel::file ? reader.find_number("load.normal", kPositive)
                                                            : reader.number("load.normal", kPositive);
  scene.torsion = read_torsion(reader);
  reader.find_pair("load.force", kZero);

  scene.cells = read_cells(reader, scene.surface);
  scene.extent = reader.find_pair("grid.extent", kPositive);

  scene.method = reader.choice_or("solver.method", scene.method, kMethods);
  scene.model = reader.choice_or("solver.model", scene.model, kModels);
  scene.precision = reader.choice_or("solver.precision", scene.precision, kPrecisions);
  scene.op = reader.choice_or("solver.operator", OperatorKind::dcfft, kOperators);
  scene.tolerance = reader.number_or("solver.tolerance", scene.tolerance, kTolerance);
  scene.max_iterations =
      static_cast<int>(reader.number_or("solver.max_iterations", scene.max_iterations, whole(1, 1e9)));
  scene.threads = static_cast<int>(reader.number_or("solver.threads", scene.threads, whole(1, 1024)));
  reader.reject_unknown();
  require_consistent(reader, scene);
  return scene;
}

}  // namespace slipstick::solver
