#include "convergence/report/gallery.hpp"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "convergence/orders/limit.hpp"
#include "solver/scene/scene.hpp"
#include "solver/scene/surface_geometry.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;
using solver::Index;

const GalleryQuantity kTwist{"twist", "twist_angle", "rad"};
const GalleryQuantity kDisplacement{"displacement", "displacement", "m"};
const GalleryQuantity kMoment{"moment", "moment", "N m"};
const GalleryQuantity kStickRatio{"stick ratio", "stick_ratio", ""};
const GalleryQuantity kLost{"lost in the last step", "dissipated", "J"};

const GalleryScene kScenes[] = {
    {"paper", "Sphere in torsion", "the paper’s case: a ring slips, the middle sticks", kTwist},
    {"off_centre", "Off centre", "under a pure moment a contact turns about its own centre", kTwist},
    {"cone", "Cone", "a pressure with a peak on the axis", kTwist},
    {"flat_punch", "Flat punch", "a pressure singular at the edge", kTwist},
    {"rounded_punch", "Rounded punch", "between a sphere and a flat punch", kTwist},
    {"annulus", "Flat-ended tube", "a ring of contact, singular at both edges", kTwist},
    {"ellipse", "Ellipse", "a contact nearly twice as long as wide", kTwist},
    {"turned_ellipse", "Turned ellipse", "no mirror axis of the contact lies along the grid", kTwist},
    {"patches", "Two spheres", "two contacts turn about the point between them", kTwist},
    {"unequal_patches", "Unequal spheres", "the point that they turn about is found by the solve", kTwist},
    {"rough_sphere", "Rough sphere", "a random surface: the contact breaks into many spots", kTwist, true},
    {"honed_surface", "Honed surface", "a height map: grooves carry nothing", kTwist, true},
    {"mindlin", "Tangential force", "Cattaneo’s and Mindlin’s contact", kDisplacement},
    {"fretting_force", "Fretting by force", "two cycles of a force", kLost},
    {"fretting_torsion", "Fretting by torsion", "two cycles of a moment, Masing’s rule", kLost},
    {"torsion_and_force", "Force, then torsion", "slip by both together", kTwist},
    {"imposed_displacement", "Imposed motion", "moved and turned by so much, as by a stiff machine", kMoment},
    {"growing_load", "Changing load", "the normal load rises under a force, and falls", kDisplacement},
    {"dissimilar", "Steel on aluminium", "pressure alone makes it slip, torsion adds to that", kTwist},
    {"goodman", "Goodman’s punch", "pressed with friction; the pressure is that without", kStickRatio},
    {"spence", "Spence’s punch", "the same, shear and pressure solved together", kStickRatio},
    {"spence_sphere", "Spence’s sphere", "pressed in four load steps, which leave 6 % whatever the mesh",
     kStickRatio},
};

/// A height map has its own grid.
bool has_height_map(const solver::Scene& scene) { return solver::find_height_map(scene.surfaces) != nullptr; }

/// Order in the cell size of numbers that answer to a smooth contact as a whole.
constexpr double kSmoothOrder = 2.0;

std::string picture(const GalleryScene& scene) { return fmt::format("gallery-{}.h5", scene.stem); }

/// A number of a result, or the length of a pair; NaN where there is none.
double read(const Json& result, const std::string& key) {
  const Json& found = result.at(key);
  if (found.is_array()) return std::hypot(found[0].get<double>(), found[1].get<double>());
  return found.is_number() ? found.get<double>() : NAN;
}

/// The reference, where it comes from, and how far the finest mesh is from it.
void add_judgement(Json& row, const GalleryScene& scene, const std::vector<Json>& meshes) {
  const std::string& key = scene.quantity.key;
  const Json& finest = meshes.back();
  const double value = read(finest, key);
  const double exact = finest.contains("exact") ? read(finest["exact"], key) : NAN;
  if (std::isfinite(exact)) {
    row["reference"] = exact;
    row["basis"] = "exact";
    set_number(row, "error", value / exact - 1.0, "the solve broke down");
    return;
  }
  if (meshes.size() < 3 || scene.rough) {
    const std::string reason = "finer meshes see more of a rough surface: nothing is extrapolated";
    set_missing(row, "reference", reason);
    row["basis"] = "none";
    set_missing(row, "error", reason);
    return;
  }
  std::vector<MeshSample> samples;
  for (const Json& mesh : meshes) samples.push_back({mesh["cell_size"][0].get<double>(), read(mesh, key)});
  const Limit limit = richardson_limit(samples, kSmoothOrder);
  const bool extrapolated = limit.value != value;
  set_number(row, "reference", limit.value, "the solve broke down");
  row["basis"] = extrapolated ? "extrapolated" : "finest mesh";
  set_number(row, "uncertainty", limit.uncertainty / std::abs(limit.value), "the solve broke down");
  const std::string unfitted = "the meshes give no order between 0.5 and 3: the finest value stands";
  set_number(row, "order", extrapolated ? limit.order.value : NAN, unfitted);
  set_number(row, "error", extrapolated ? value / limit.value - 1.0 : NAN, unfitted);
}

Json mesh_json(const GalleryScene& scene, const Json& result) {
  const bool history = result.contains("history");
  const Json& sums = history ? result["history"] : result;
  Json json;
  json["cells"] = result["cells"];
  json["cell_size"] = result["cell_size"];
  set_number(json, "value", read(result, scene.quantity.key), "the solve broke down");
  json["gap"] = history ? sums["worst_gap"] : result["certificate"]["gap"];
  json["operator_applications"] = sums["operator_applications"];
  json["seconds"] = history ? sums["seconds"] : result["seconds"]["total"];
  return json;
}

}  // namespace

const std::vector<GalleryScene>& gallery_scenes() {
  static const std::vector<GalleryScene> scenes(std::begin(kScenes), std::end(kScenes));
  return scenes;
}

std::vector<RunSpec> gallery_runs(const GalleryScene& scene, const fs::path& scenes,
                                  const std::array<Index, 3>& across, const fs::path& fields) {
  const fs::path file = scenes / (scene.stem + ".toml");
  const solver::Scene own = solver::read_scene(file);
  std::vector<RunSpec> runs;
  if (has_height_map(own)) {
    runs.push_back({.scene = file});
  } else {
    for (const Index cells : across) {
      runs.push_back({.scene = file, .overrides = {cells_override(own, cells)}});
    }
  }
  runs.back().fields = fields / picture(scene);
  return runs;
}

Json gallery_row(const GalleryScene& scene, const std::vector<Json>& meshes) {
  Json row{{"scene", scene.stem},
           {"title", scene.title},
           {"shows", scene.shows},
           {"quantity", scene.quantity.name},
           {"unit", scene.quantity.unit}};
  const Json& finest = meshes.back();
  row.update(mesh_json(scene, finest));
  add_judgement(row, scene, meshes);
  for (const char* key : {"status", "tolerance", "contact_cells", "stick_cells"}) {
    row[key] = finest[key];
  }
  row["steps"] = finest.contains("steps") ? finest["steps"].size() : 1;
  row["fields"] = picture(scene);
  for (const Json& mesh : meshes) row["meshes"].push_back(mesh_json(scene, mesh));
  return row;
}

}  // namespace slipstick::convergence
