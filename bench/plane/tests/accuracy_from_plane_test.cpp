// Data to pick by, from made points.

#include "bench/plane/accuracy_from_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

namespace {

using slipstick::bench::accuracy_from_plane;
using slipstick::bench::Json;
using slipstick::convergence::AccuracyData;

/// Two grids whose errors are +-error, and an iteration that adds a part of the tolerance to both.
Json point(double cells, double tolerance, double error, double iteration) {
  Json made{{"method", "coulomb"},          {"operator", "dcfft"},  {"model", "auto"},
            {"pressure", "solved"},         {"cells", cells},       {"tolerance", tolerance},
            {"contact_cells", cells - 4.0}, {"applications", cells}};
  made["seconds"] = {{"median", 1e-3 * cells}};
  for (const char* name : {"twist", "traction_l2", "stick_radius"}) {
    made["errors"][name] = {error + iteration, -error + iteration};
    made["error"][name] = std::hypot(error, iteration);
  }
  return made;
}

/// Errors 1/cells^2 at one load, half that at the other; iterations leave the tolerance.
Json made_plane() {
  Json plane{{"application_seconds", 1e-4}};
  for (const double part : {1.0, 0.5}) {
    Json scene;
    for (const double cells : {16.0, 64.0}) {
      for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8}) {
        scene["points"].push_back(point(cells, tolerance, part / (cells * cells), tolerance));
      }
    }
    plane["scenes"].push_back(scene);
  }
  return plane;
}

TEST(AccuracyFromPlane, IsTheEnvelopeOfTheLoads) {
  const AccuracyData data = accuracy_from_plane(made_plane());
  ASSERT_EQ(data.meshes.size(), 2U);
  EXPECT_EQ(data.meshes[0].cells_across, 12.0);
  EXPECT_NEAR(data.meshes[0].errors[0].error, 1.0 / 256.0, 1e-9);
  EXPECT_NEAR(data.meshes[1].errors[2].error, 1.0 / 4096.0, 1e-9);
  EXPECT_DOUBLE_EQ(data.meshes[1].work[0], 640.0);
}

/// A tenth of 1/256 is 3.9e-4, of 1/4096 2.4e-5.
TEST(AccuracyFromPlane, TakesTheLoosestToleranceThatChangesATenth) {
  const AccuracyData data = accuracy_from_plane(made_plane());
  EXPECT_EQ(data.meshes[0].errors[0].tolerance, 1e-4);
  EXPECT_EQ(data.meshes[1].errors[0].tolerance, 1e-6);
}

TEST(AccuracyFromPlane, IsMonotone) {
  Json plane = made_plane();
  for (Json& scene : plane["scenes"]) {  // a lucky coarse mesh
    for (Json& made : scene["points"]) {
      if (made["cells"] == 16.0) made["error"]["twist"] = 1e-9;
    }
  }
  const AccuracyData data = accuracy_from_plane(plane);
  EXPECT_EQ(data.meshes[0].errors[0].error, data.meshes[1].errors[0].error);
}

TEST(AccuracyFromPlane, LeavesOutWhatWasNotTimedAtEachLoad) {
  Json plane = made_plane();
  for (Json& made : plane["scenes"][1]["points"]) {
    if (made["cells"] == 16.0) made["seconds"] = nullptr;
  }
  EXPECT_THROW(accuracy_from_plane(plane), std::runtime_error);  // one mesh is left
}

}  // namespace
