#include <fmt/core.h>

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <vector>

#include "bench/plane/envelope.hpp"
#include "bench/plane/speed_error.hpp"

namespace slipstick::bench {
namespace {

/// Errors that the table of times asks for.
const std::vector<double> kWanted{1e-2, 1e-3, 1e-4, 1e-5};

double number_or_nan(const Json& value) {
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// The points as ways to one quantity, place by place; not a number where not timed.
std::vector<Way> ways_to(const Json& points, const std::string& quantity) {
  std::vector<Way> ways;
  for (const Json& point : points) {
    Way way;
    for (const ChoiceKey& key : kChoiceKeys) way.choice[key.name] = point[key.name];
    way.choice[kTolerance] = fmt::format("{:g}", point[kTolerance].get<double>());
    way.cells = point["cells"].get<double>();
    way.error = number_or_nan(point["error"][quantity]);
    const bool timed = point["seconds"].is_object();
    way.seconds = timed ? point["seconds"]["median"].get<double>() : std::numeric_limits<double>::quiet_NaN();
    way.low = timed ? point["seconds"]["low"].get<double>() : way.seconds;
    way.high = timed ? point["seconds"]["high"].get<double>() : way.seconds;
    ways.push_back(way);
  }
  return ways;
}

std::string dominated_text(const DominatedChoice& choice) {
  const std::string where =
      choice.everywhere ? "" : fmt::format(" from {} x {} cells on", choice.from_cells, choice.from_cells);
  return fmt::format("{} {}{}: {:.2g} times slower at the same error than {} ({:.2g} to {:.2g})", choice.key,
                     choice.word, where, choice.times_slower, choice.by, choice.least, choice.most);
}

Json dominated_json(const Json& scene, const std::string& quantity, const DominatedChoice& choice) {
  return {{"scene", scene["name"]},
          {"quantity", quantity},
          {"key", choice.key},
          {"value", choice.word},
          {"by", choice.by},
          {"everywhere", choice.everywhere},
          {"from_cells", choice.from_cells},
          {"times_slower", {{"median", choice.times_slower}, {"low", choice.least}, {"high", choice.most}}},
          {"points", choice.ways},
          {"text", dominated_text(choice)}};
}

/// Best error among ways, for the reason why a smaller one was not reached.
std::string best_text(const std::vector<Way>& ways) {
  const Way* best = nullptr;
  for (const Way& way : ways) {
    if (std::isfinite(way.error) && std::isfinite(way.seconds) &&
        (best == nullptr || way.error < best->error)) {
      best = &way;
    }
  }
  if (best == nullptr) return "no timed point";
  return fmt::format("the best is {:.2g}, on {} x {} cells", best->error, best->cells, best->cells);
}

/// method: "any", or one; ways of others do not count.
Json time_to(std::vector<Way> ways, const std::string& method, double error) {
  for (Way& way : ways) {
    if (method != "any" && way.choice["method"] != method)
      way.error = std::numeric_limits<double>::quiet_NaN();
  }
  Json row{{"error", error}, {"method", method}};
  const std::optional<std::size_t> place = quickest_to(ways, error);
  if (place) {
    row["point"] = *place;
    row["seconds"] = ways[*place].seconds;
  } else {
    convergence::set_missing(row, "seconds", best_text(ways));
    row["point"] = nullptr;
    row["reason"] = row["seconds_reason"];
  }
  return row;
}

Json exact_time_to(const Json& exact, double error) {
  return {{"error", error},
          {"method", "exact"},
          {"point", nullptr},
          {"reason", "no grid"},
          {"seconds", exact["seconds"]["median"]}};
}

void add_times(Json& scene, const std::string& quantity, const std::vector<Way>& ways) {
  std::set<std::string> methods;
  for (const Way& way : ways) methods.insert(way.choice.at("method"));
  for (const double error : kWanted) {
    std::vector<Json> rows{time_to(ways, "any", error)};
    for (const std::string& method : methods) rows.push_back(time_to(ways, method, error));
    if (scene.contains("exact")) rows.push_back(exact_time_to(scene["exact"], error));
    for (Json& row : rows) {
      Json named{{"quantity", quantity}};
      named.update(row);
      scene["time_to"].push_back(std::move(named));
    }
  }
}

void list_not_timed(Json& plane, const Json& scene) {
  for (const Json& point : scene["points"]) {
    if (!point.contains("not_timed")) continue;
    Json choice;
    for (const ChoiceKey& key : kChoiceKeys) choice[key.name] = point[key.name];
    choice[kTolerance] = point[kTolerance];
    choice["cells"] = point["cells"];
    plane["not_timed"].push_back(
        {{"scene", scene["name"]}, {"choice", choice}, {"reason", point["not_timed"]}});
  }
}

}  // namespace

void judge_plane(Json& plane) {
  plane["dominated"] = Json::array();
  plane["not_timed"] = Json::array();
  for (Json& scene : plane["scenes"]) {
    scene["envelope"] = Json::object();
    scene["time_to"] = Json::array();
    for (const Json& quantity : plane["quantities"]) {
      const std::string name = quantity["name"];
      const std::vector<Way> ways = ways_to(scene["points"], name);
      scene["envelope"][name] = pareto_front(ways);
      add_times(scene, name, ways);
      for (const DominatedChoice& choice : dominated_choices(ways)) {
        plane["dominated"].push_back(dominated_json(scene, name, choice));
      }
    }
    list_not_timed(plane, scene);
  }
}

}  // namespace slipstick::bench
