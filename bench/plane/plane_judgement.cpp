#include <fmt/core.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "bench/plane/envelope.hpp"
#include "bench/plane/speed_error.hpp"

namespace slipstick::bench {
namespace {

/// Errors of the rows of the table of times.
const std::vector<double> kWanted{1e-2, 1e-3, 1e-4, 1e-5};

const std::string kAnyMethod = "any";

/// The points as ways to one quantity, place by place; not a number where not timed, or of another method.
std::vector<Way> ways_to(const Json& points, const std::string& quantity, const std::string& method) {
  const auto number = [](const Json& value) {
    return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
  };
  std::vector<Way> ways;
  for (const Json& point : points) {
    const bool counts = point["seconds"].is_object() && (method == kAnyMethod || point["method"] == method);
    ways.push_back(
        {counts ? number(point["seconds"]["median"]) : number({}), number(point["error"][quantity])});
  }
  return ways;
}

/// The best error among ways, as the reason why a smaller one was not reached.
std::string best_text(const Json& points, const std::vector<Way>& ways) {
  const std::vector<std::size_t> front = pareto_front(ways);
  if (front.empty()) return "no timed point";
  const auto best = *std::ranges::min_element(front, {}, [&](std::size_t way) { return ways[way].error; });
  return fmt::format("the best is {0:.2g}, on {1} x {1} cells", ways[best].error,
                     points[best]["cells"].get<double>());
}

Json time_to(const Json& points, const std::string& quantity, const std::string& method, double error) {
  const std::vector<Way> ways = ways_to(points, quantity, method);
  Json row{{"quantity", quantity}, {"error", error}, {"method", method}};
  const std::optional<std::size_t> place = quickest_to(ways, error);
  if (place) {
    row["point"] = *place;
    row["seconds"] = ways[*place].seconds;
  } else {
    convergence::set_missing(row, "seconds", best_text(points, ways));
    row["point"] = nullptr;
    row["reason"] = row["seconds_reason"];
  }
  return row;
}

void add_times(Json& scene, const std::string& quantity) {
  std::set<std::string> methods;
  for (const Json& point : scene["points"]) methods.insert(point["method"]);
  Json& rows = scene["time_to"];
  for (const double error : kWanted) {
    rows.push_back(time_to(scene["points"], quantity, kAnyMethod, error));
    for (const std::string& method : methods) {
      rows.push_back(time_to(scene["points"], quantity, method, error));
    }
    if (!scene.contains("exact")) continue;
    rows.push_back({{"quantity", quantity},
                    {"error", error},
                    {"method", "exact"},
                    {"point", nullptr},
                    {"reason", "no grid"},
                    {"seconds", scene["exact"]["seconds"]["median"]}});
  }
}

void list_not_timed(Json& plane, const Json& scene) {
  for (const Json& point : scene["points"]) {
    if (!point.contains("not_timed")) continue;
    Json choice;
    for (const ChoiceKey& key : kChoiceKeys) choice[key.name] = point[key.name];
    for (const char* const key : {"tolerance", "cells"}) choice[key] = point[key];
    plane["not_timed"].push_back(
        {{"scene", scene["name"]}, {"choice", choice}, {"reason", point["not_timed"]}});
  }
}

std::string seconds_text(const Json& seconds) {
  return seconds.is_number() ? fmt::format("{:.3g} s", seconds.get<double>()) : "-";
}

}  // namespace

void judge_plane(Json& plane) {
  plane["not_timed"] = Json::array();
  for (Json& scene : plane["scenes"]) {
    scene["envelope"] = Json::object();
    scene["time_to"] = Json::array();
    for (const Json& quantity : plane["quantities"]) {
      const std::string name = quantity["name"];
      scene["envelope"][name] = pareto_front(ways_to(scene["points"], name, kAnyMethod));
      add_times(scene, name);
    }
    list_not_timed(plane, scene);
  }
}

std::string times_text(const Json& plane) {
  std::string text = "the least time to an error\n";
  for (const Json& scene : plane["scenes"]) {
    for (const Json& quantity : plane["quantities"]) {
      text += fmt::format("  {:<12} {:<32}", scene["name"].get<std::string>(),
                          quantity["label"].get<std::string>());
      for (const Json& row : scene["time_to"]) {
        if (row["quantity"] != quantity["name"] || row["method"] != "any") continue;
        text += fmt::format("  {:.0e} {:>8}", row["error"].get<double>(), seconds_text(row["seconds"]));
      }
      text += '\n';
    }
    if (scene["exact"].is_object()) {
      text += fmt::format("  {:<12} {:<32}  all   {:>8}\n", scene["name"].get<std::string>(),
                          "exact, no grid", seconds_text(scene["exact"]["seconds"]["median"]));
    }
  }
  return text;
}

}  // namespace slipstick::bench
