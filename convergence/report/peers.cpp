#include "convergence/report/peers.hpp"

#include <nlohmann/json.hpp>

#include "convergence/check/check.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {
namespace {

/// A field of check/fields/, at 0.9 of the limit moment.
struct KnownField {
  const char* program;
  const char* file;
  double twist;  ///< rad, that the program reported
  const char* expected;
};

constexpr KnownField kFields[] = {{"CONTACT", "contact-64-0.9.csv", 2.361048651456917e-3, "good"},
                                  {"CGContact", "cgcontact-64-0.9.csv", 2.21775472e-3, "bad"}};

}  // namespace

Json judge_peers(const std::filesystem::path& inputs) {
  const solver::Scene scene = solver::read_scene(inputs / "scenes" / "paper.toml", {"load.moment_ratio=0.9"});
  Json rows = Json::array();
  for (const KnownField& field : kFields) {
    const Json result = check_field(scene, inputs / "check" / "fields" / field.file, {.twist = field.twist});
    Json& row = rows.emplace_back(
        Json{{"program", field.program}, {"file", field.file}, {"expected", field.expected}});
    for (const char* key : {"verdict", "why", "cells", "twist_error", "moment_error", "stick_radius_error",
                            "traction_error", "certificate", "slip_direction", "judged"}) {
      row[key] = result[key];
    }
  }
  return rows;
}

}  // namespace slipstick::convergence
