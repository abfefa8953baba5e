#include "convergence/check/mesh_request.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "convergence/check/foreign_field.hpp"
#include "convergence/oracle/oracle.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/table_text.hpp"

namespace slipstick::convergence {
namespace {

/// Intervals of the tables of exact fields over the radius, which are the smaller the nearer the edge.
constexpr int kRadii = 2000;

/// Pressure and shear traction at radii up to the contact's. A pressure that is infinite on the axis or at
/// the edge is left out there.
Json exact_fields(const Oracle& exact) {
  Json radii = Json::array();
  Json pressures = Json::array();
  Json shears = Json::array();
  for (int k = 0; k < kRadii; ++k) {
    const double radius = exact.contact_radius * std::sin(std::numbers::pi / 2.0 * (k + 0.5) / kRadii);
    radii.push_back(radius);
    pressures.push_back(exact.pressure(radius));
    shears.push_back(exact.traction(radius));
  }
  return {{"radii", radii}, {"pressure", pressures}, {"shear", shears}};
}

/// The exact answer after the last step; null: there is none, or none of the tractions.
Json exact_json(const solver::Scene& scene) {
  auto history = exact_history(scene);
  OracleAnswer answer;
  const std::size_t steps = scene.steps.size() * static_cast<std::size_t>(scene.cycles);
  for (std::size_t k = 0; k < steps; ++k) answer = history.advance(step_of(scene, k));
  if (!answer.oracle || !answer.oracle->shear || !std::isfinite(answer.oracle->moment)) return nullptr;
  const Oracle& exact = *answer.oracle;
  Json json = exact_fields(exact);
  json.update({{"centre", exact.place.centre},
               {"direction", exact.place.direction},
               {"contact_radius", exact.contact_radius},
               {"stick_radius", exact.stick_radius},
               {"normal_load", *step_of(scene, steps - 1).normal},
               {"moment", exact.moment},
               {"twist", exact.twist_angle},
               {"force", exact.force},
               {"displacement", exact.displacement},
               {"profile", exact.friction.bound ? exact.friction.bound->name() : ""},
               {"shear_unit", exact.friction.reference_bound},
               {"moment_ratio", exact.moment / exact.friction.moment_limit}});
  return json;
}

/// The exact answer of a program that forgets the history: a first loading by the last step. Null where there
/// is no history.
Json first_loading_json(const solver::Scene& scene) {
  if (scene.steps.size() * static_cast<std::size_t>(scene.cycles) == 1) return nullptr;
  solver::Scene last = scene;
  last.steps = {scene.steps.back()};
  last.cycles = 1;
  if (const auto* ratio = std::get_if<solver::MomentRatio>(&last.steps[0].torsion); ratio && ratio->value < 0)
    last.steps[0].torsion = solver::MomentRatio{-ratio->value};
  return exact_json(last);
}

/// The key of a single step's torsion and its value; null: there is none, or a history.
Json torsion_json(const solver::Scene& scene) {
  if (scene.steps.size() != 1) return nullptr;
  const solver::TorsionLoad& load = scene.steps[0].torsion;
  const char* const keys[] = {"load.moment_ratio", "load.moment", "load.twist"};
  const double value = std::visit([](const auto& torsion) { return torsion.value; }, load);
  return value == 0.0 ? Json() : Json{{keys[load.index()], value}};
}

/// The sphere's radius, m; null: the indenter is another one, or several.
Json sphere_json(const solver::Scene& scene) {
  const solver::Surface& surface = scene.surfaces[0];
  return scene.surfaces.size() == 1 && surface.shape == solver::Shape::sphere ? Json(surface.radius) : Json();
}

Json body_json(const solver::Material& body) {
  return {{"shear_compliance", 2.0 * (1.0 + body.poisson_ratio) / body.young_modulus},
          {"poisson_ratio", body.poisson_ratio}};
}

Json friction_json(const solver::FrictionLaw& law) {
  return {{"kind", to_string(law.kind)},
          {"coefficient", law.coefficient},
          {"shear_strength", law.shear_strength},
          {"exponent", law.exponent}};
}

}  // namespace

bool MeshOptions::any() const { return stick_slope || normal_stiffness || !held_at.empty() || !read_as.empty(); }

bool is_mesh_file(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  for (const char* regular : {".h5", ".hdf5", ".vti", ".npz", ".npy", ".json"}) {
    if (ending == regular) return false;
  }
  for (const char* mesh :
       {".vtu", ".vtk", ".vtp", ".frd", ".xdmf", ".xmf", ".e", ".exo", ".ex2", ".med", ".msh", ".inp", ".contact"}) {
    if (ending == mesh) return true;
  }
  const std::vector<std::string> names = solver::text_table_names(file);
  const auto has = [&](const char* name) { return std::ranges::find(names, name) != names.end(); };
  if (has("fn") || (has("r") && !has("x1"))) return true;
  if (!has("x1") || !has("x2")) return has("x") && has("y");
  const auto columns = solver::read_columns(file, {"x1", "x2"}, {.may_be_missing = true});
  return !lies_on_grid(columns[0], columns[1]);
}

Json mesh_request(const solver::Scene& scene, const std::vector<std::string>& overrides,
                  const std::filesystem::path& file, const CheckOptions& options, const MeshOptions& mesh) {
  const solver::FrictionLaw& law = scene.contact.friction;
  if (law.is_frictionless() || !law.map.empty()) {
    throw solver::InputError(scene.source.string(), "contact.friction", law.map.empty() ? "0" : law.map.string(),
                             "a coefficient above zero without a map, for a field on a mesh");
  }
  const auto or_null = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  return {{"scene", scene.source.string()},
          {"name", scene.name},
          {"overrides", overrides},
          {"field", file.string()},
          {"steps", scene.steps.size() * static_cast<std::size_t>(scene.cycles)},
          {"half_spaces", !is_coated(scene)},
          {"upper", body_json(scene.upper)},
          {"lower", body_json(scene.lower)},
          {"sphere", sphere_json(scene)},
          {"friction", friction_json(law)},
          {"exact", exact_json(scene)},
          {"first_loading", first_loading_json(scene)},
          {"torsion", torsion_json(scene)},
          {"layer", scene.layer.kind != nullptr},
          {"twist", or_null(options.twist)},
          {"tolerance", or_null(options.tolerance)},
          {"strict", options.strict},
          {"stick_slope", or_null(mesh.stick_slope)},
          {"normal_stiffness", or_null(mesh.normal_stiffness)},
          {"held_at", mesh.held_at},
          {"read_as", mesh.read_as}};
}

}  // namespace slipstick::convergence
