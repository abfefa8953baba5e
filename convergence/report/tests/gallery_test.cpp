#include "convergence/report/gallery.hpp"

#include <gtest/gtest.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <ostream>
#include <set>

#include "convergence/oracle/oracle.hpp"
#include "convergence/runs/process_pool.hpp"

namespace slipstick::convergence {

void PrintTo(const GalleryScene& scene, std::ostream* stream) { *stream << scene.stem; }

namespace {

namespace fs = std::filesystem;

constexpr std::array<solver::Index, 3> kAcross{12, 24, 48};

/// A scene of the gallery; its folder goes with the test.
class Gallery : public testing::TestWithParam<GalleryScene> {
 protected:
  ~Gallery() override { fs::remove_all(folder_); }
  std::vector<Json> meshes() {
    const ProcessPool pool({.folder = folder_ / "points", .program = SLIPSTICK_PROGRAM});
    return pool.run(gallery_runs(GetParam(), SLIPSTICK_SCENES, kAcross, folder_));
  }
  fs::path folder_ = fs::path(testing::TempDir()) / ("slipstick-gallery-" + std::to_string(getpid()));
};

solver::Scene scene_of(const GalleryScene& scene) {
  return solver::read_scene(fs::path(SLIPSTICK_SCENES) / (scene.stem + ".toml"));
}

/// Whether there is an exact answer to more than the normal contact.
bool has_exact_answer(const GalleryScene& scene) {
  const auto oracle = find_oracle(scene_of(scene)).oracle;
  return oracle && oracle->only_normal.empty();
}

/// The most that so few cells may be wrong by, relative: (h/a)^2, of cell size and contact radius, for what
/// answers to the contact as a whole; h/a where the pressure is singular at the edge, which the cells place
/// to h; h over the stick radius for a stick ratio, whose front the cells place to h; and where the contact
/// grows in load steps, also the part by which its radius grows in one.
double mesh_bound(const GalleryScene& scene, const Json& row) {
  const double size =
      std::sqrt(std::numbers::pi / row["contact_cells"].get<double>());  // h/a of a circle's cells
  const double growth = scene.stem == "spence_sphere" ? std::cbrt(1.5) - 1.0 : 0.0;
  if (scene.quantity.key == "stick_ratio") return size / row["reference"].get<double>() + growth;
  return scene.stem == "flat_punch" ? size : size * size;
}

void expect_shape_of_own_grid(const Json& row, const std::array<solver::Index, 2>& own) {
  const std::array<solver::Index, 2> cells = row["cells"];
  if (own == std::array<solver::Index, 2>{}) {
    EXPECT_EQ(cells, (std::array<solver::Index, 2>{64, 64}));  // the height map's
  } else {
    EXPECT_EQ(std::max(cells[0], cells[1]), kAcross.back());
    EXPECT_EQ(cells[0] * own[1], cells[1] * own[0]);
  }
}

/// A limit L and an order p put each mesh on value = L + c size^p.
void expect_meshes_lead_to_one_point(const Json& row) {
  const auto scaled = [&](std::size_t mesh) {
    const Json& at = row["meshes"][mesh];
    return (at["value"].get<double>() - row["reference"].get<double>()) /
           std::pow(at["cell_size"][0].get<double>(), row["order"].get<double>());
  };
  constexpr double rounding = 1e-8;  // of values to 16 digits, over changes above 1e-6 of them
  EXPECT_NEAR(scaled(0) / scaled(2), 1.0, rounding);
  EXPECT_NEAR(scaled(1) / scaled(2), 1.0, rounding);
}

void expect_sums_of_steps(const Json& row, const Json& steps) {
  double applications = 0.0;
  double worst = 0.0;
  for (const Json& step : steps) {
    applications += step["operator_applications"].get<double>();
    worst = std::max(worst, step["certificate"]["gap"].get<double>());
  }
  EXPECT_EQ(row["steps"], steps.size());
  EXPECT_DOUBLE_EQ(row["operator_applications"].get<double>(), applications);
  EXPECT_EQ(row["gap"].get<double>(), worst);
}

TEST_P(Gallery, IsSolvedCertifiedAndJudged) {
  const std::vector<Json> results = meshes();
  const Json found = gallery_row(GetParam(), results);
  EXPECT_EQ(found["status"], "converged");
  EXPECT_LE(found["gap"].get<double>(), found["tolerance"].get<double>());
  EXPECT_TRUE(fs::exists(folder_ / found["fields"].get<std::string>()));
  const solver::Scene scene = scene_of(GetParam());
  expect_shape_of_own_grid(found, scene.cells);
  EXPECT_EQ(found["meshes"].size(), scene.cells[0] == 0 ? 1 : kAcross.size());
  EXPECT_EQ(found["basis"] == "none", GetParam().rough);
  EXPECT_EQ(found["basis"] == "exact", has_exact_answer(GetParam()));
  if (found["basis"] == "exact") {
    EXPECT_LE(std::abs(found["error"].get<double>()), mesh_bound(GetParam(), found));
  }
  if (GetParam().stem ==
      "imposed_displacement") {  // a smooth contact's moment: second order, well told by its meshes
    EXPECT_EQ(found["basis"], "extrapolated");
  }
  if (found["basis"] == "extrapolated") expect_meshes_lead_to_one_point(found);
  const Json& result = results.back();
  if (result.contains("steps")) expect_sums_of_steps(found, result["steps"]);
}

INSTANTIATE_TEST_SUITE_P(Scenes, Gallery, testing::ValuesIn(gallery_scenes()),
                         [](const auto& scene) { return scene.param.stem; });

/// Which scenes have an exact answer is known from theory, not found by the run.
TEST(GalleryOfAll, IsJudgedByTheExactAnswerWhereThereIsOne) {
  const std::set<std::string> exact{"paper",         "off_centre",       "cone",    "flat_punch",
                                    "rounded_punch", "mindlin",          "goodman", "fretting_force",
                                    "growing_load",  "fretting_torsion", "spence",  "spence_sphere"};
  for (const GalleryScene& scene : gallery_scenes()) {
    EXPECT_EQ(has_exact_answer(scene), exact.contains(scene.stem)) << scene.stem;
  }
}

}  // namespace
}  // namespace slipstick::convergence
