#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "bench/plane/speed_error.hpp"

namespace slipstick::bench {
namespace {

std::string seconds_text(const Json& seconds) {
  return seconds.is_number() ? fmt::format("{:.3g} s", seconds.get<double>()) : "-";
}

/// The choices of a point; those that are the default are left out.
std::string choice_text(const Json& point) {
  static const PlaneChoice usual;
  std::string text = fmt::format("{0} x {0} cells, tolerance {1:g}", point["cells"].get<int>(),
                                 point["tolerance"].get<double>());
  for (const ChoiceKey& key : kChoiceKeys) {
    const std::string word = point[key.name];
    if (word != usual.*key.word) text += fmt::format(", {} {}", key.name, word);
  }
  return text;
}

std::string envelope_text(const Json& scene, const Json& quantity) {
  const std::string name = quantity["name"];
  std::string text = fmt::format("  {}\n", quantity["label"].get<std::string>());
  for (const Json& place : scene["envelope"][name]) {
    const Json& point = scene["points"][place.get<std::size_t>()];
    text += fmt::format("    {:>9.2e}  {:>10}   {}\n", point["error"][name].get<double>(),
                        seconds_text(point["seconds"]["median"]), choice_text(point));
  }
  return text;
}

std::string time_text(const Json& scene, const Json& quantity) {
  std::string text;
  for (const Json& row : scene["time_to"]) {
    if (row["quantity"] != quantity["name"] || row["method"] == "any") continue;
    const Json& place = row["point"];
    text += fmt::format("    {:>7.0e}  {:<19} {:>10}   {}\n", row["error"].get<double>(),
                        row["method"].get<std::string>(), seconds_text(row["seconds"]),
                        place.is_number() ? choice_text(scene["points"][place.get<std::size_t>()])
                                          : row["reason"].get<std::string>());
  }
  return text;
}

}  // namespace

std::string times_text(const Json& plane) {
  std::string text = "the least time to an error (all choices in plane.txt)\n";
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

std::string plane_text(const Json& plane) {
  std::string text;
  for (const Json& scene : plane["scenes"]) {
    text += fmt::format("{}: the quickest at each error\n", scene["name"].get<std::string>());
    for (const Json& quantity : plane["quantities"]) text += envelope_text(scene, quantity);
    text += fmt::format("{}: time to an error\n", scene["name"].get<std::string>());
    for (const Json& quantity : plane["quantities"]) {
      text += fmt::format("  {}\n", quantity["label"].get<std::string>()) + time_text(scene, quantity);
    }
  }
  text += "never worth taking\n";
  for (const Json& choice : plane["dominated"]) {
    text += fmt::format("  {} ({}): {}\n", choice["quantity"].get<std::string>(),
                        choice["scene"].get<std::string>(), choice["text"].get<std::string>());
  }
  for (const Json& row : plane["not_timed"]) {
    text += fmt::format("not timed ({}): {}: {}\n", row["scene"].get<std::string>(),
                        choice_text(row["choice"]), row["reason"].get<std::string>());
  }
  return text;
}

}  // namespace slipstick::bench
