#include "convergence/loops/check_loop.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <vector>

#include "convergence/laws/contact_law.hpp"
#include "convergence/loops/loop_contact.hpp"
#include "convergence/loops/loop_judgement.hpp"
#include "convergence/loops/loop_record.hpp"
#include "convergence/results/provenance.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

const std::string kNotShown = "the loop does not show it";

/// A contact under one normal load, and the loop in its units.
struct LoopUnderLoad {
  LoopContact contact;
  LoopPath path;
};

/// How a record's units and signs differ from the scene's.
struct LoopConventions {
  double load = 1.0;    ///< N m, or N, of one unit
  double motion = 1.0;  ///< rad, or m, of one unit
  std::vector<std::string> notes;
};

struct UnitName {
  double size;
  const char* name;
};
const std::vector<UnitName> kMomentUnits{{1e-3, "N mm"}, {1e-6, "mN mm, or uN m"}, {1e3, "kN m"}};
const std::vector<UnitName> kRotationUnits{
    {std::numbers::pi / 180.0, "degrees"}, {1e-3, "mrad"}, {1e-6, "urad"}};
const std::vector<UnitName> kForceUnits{{1e-3, "mN"}, {1e3, "kN"}};
const std::vector<UnitName> kLengthUnits{{1e-3, "mm"}, {1e-6, "um"}, {1e-9, "nm"}};

/// The unit in which a ratio is nearest to 1, where it is far from that in the scene's unit and near in this.
void choose_unit(const std::vector<UnitName>& units, double ratio, const char* what, double& unit,
                 std::vector<std::string>& notes) {
  constexpr double kFar = 10.0;
  const auto distance = [&](double size) { return std::abs(std::log(ratio * size)); };
  if (!(distance(1.0) > std::log(kFar))) return;
  const auto nearest =
      std::ranges::min_element(units, {}, [&](const UnitName& each) { return distance(each.size); });
  if (!(distance(nearest->size) <= std::log(kFar))) return;
  unit = nearest->size;
  notes.push_back(fmt::format("the {} is in {}", what, nearest->name));
}

double largest(const std::vector<double>& values) {
  double size = 0.0;
  for (const double value : values) size = std::max(size, std::abs(value));
  return size;
}

/// The load's unit by its size over the limit, the motion's by the stiffness of the first rows, the sign by
/// which way the load goes at first.
LoopConventions find_conventions(const LoopRecord& loop, const LoopContact& contact) {
  LoopConventions found;
  choose_unit(loop.of_force ? kForceUnits : kMomentUnits, largest(loop.load) / contact.limit,
              contact.words.load, found.load, found.notes);
  double above = 0.0;
  double below = 0.0;
  const double enough = largest(loop.load) / 3.0;
  for (std::size_t row = 0; row < loop.load.size(); ++row) {
    if (std::abs(loop.load[row]) > enough && below > 0.0) break;
    above += loop.load[row] * loop.motion[row];
    below += loop.motion[row] * loop.motion[row];
  }
  if (!(below > 0.0)) return found;
  const double rest = contact.stiffness * contact.limit / contact.motion_unit;
  const double softness = rest * below / (found.load * std::abs(above));  // 1: rad, 57: degrees
  if (softness > 1.0) {
    choose_unit(loop.of_force ? kLengthUnits : kRotationUnits, softness, contact.words.motion, found.motion,
                found.notes);
  }
  if (above < 0.0) {
    found.load = -found.load;
    found.notes.push_back(fmt::format("the {} is that on the other body, or the {} the other way round",
                                      contact.words.load, contact.words.motion));
  }
  return found;
}

/// Rows of a path: as many as a fit needs.
constexpr std::size_t kMaxPathRows = 2000;

LoopPath make_path(const LoopRecord& loop, std::size_t from, std::size_t to,
                   const LoopConventions& conventions, const LoopContact& contact) {
  const std::size_t step = (to - from + kMaxPathRows - 1) / kMaxPathRows;
  LoopPath path;
  const auto add = [&](std::size_t row) {
    path.twist.push_back((loop.motion[row] - loop.motion[from]) * conventions.motion / contact.motion_unit);
    path.moment.push_back(loop.load[row] * conventions.load / contact.limit);
    if (!loop.time.empty()) {
      path.time.push_back((loop.time[row] - loop.time[from]) / (loop.time[to - 1] - loop.time[from]));
    }
  };
  for (std::size_t row = from; row < to; row += step) add(row);
  if (!loop.time.empty()) path.duration = loop.time[to - 1] - loop.time[from];
  path.turns = find_turns(path.twist);
  return path;
}

/// Rows of one normal load, as it is given, follow each other.
struct LoadRows {
  std::size_t from;
  std::size_t to;
  double normal_load;
};
std::vector<LoadRows> rows_by_load(const LoopRecord& loop, double scene_load) {
  constexpr double kSameLoad = 0.02;
  if (loop.normal_load.empty()) return {{0, loop.load.size(), scene_load}};
  std::vector<LoadRows> groups{{0, 1, loop.normal_load[0]}};
  for (std::size_t row = 1; row < loop.normal_load.size(); ++row) {
    if (std::abs(loop.normal_load[row] / groups.back().normal_load - 1.0) > kSameLoad) {
      groups.push_back({row, row, loop.normal_load[row]});
    }
    groups.back().to = row + 1;
  }
  for (const LoadRows& group : groups) {
    if (group.to - group.from >= kMinLoopRows) continue;
    throw solver::InputError(
        loop.file.string(),
        fmt::format(
            "rows {} to {}: normal_load = {} for {} rows; allowed: loops one after another, each under a "
            "load of its own for at least {} rows",
            group.from + 1, group.to, group.normal_load, group.to - group.from, kMinLoopRows));
  }
  return groups;
}

Json number_json(const LoopNumber& number, double unit) {
  Json json;
  set_number(json, "value", number.value * unit, kNotShown);
  set_number(json, "exact", number.exact * unit, kNotShown);
  return json;
}

Json under_load_json(const LoopUnderLoad& loop, const LoopJudgement& judgement) {
  const double motion = loop.contact.motion_unit;
  const double limit = loop.contact.limit;
  Json json{{"normal_load", loop.contact.normal_load},
            {"verdict", judgement.good ? "good" : "bad"},
            {"why", judgement.why}};
  if (judgement.law.empty()) {
    set_missing(json, "law", "none of the laws that were tried explains it");
  } else {
    json["law"] = judgement.law;
  }
  json["rows"] = loop.path.twist.size();
  json["reversals"] = loop.path.turns.size() - 2;
  json["limit"] = limit;
  set_number(json, "residual", judgement.residual, "not a number");
  json["stiffness"] = number_json(judgement.stiffness, limit / motion);
  json["largest_load"] = number_json(judgement.largest_load, limit);
  json["presliding"] = number_json(judgement.presliding, motion);
  json["recovered"] = number_json(judgement.recovered, 1.0);
  json["areas"] = Json::array();
  for (const LoopNumber& area : judgement.areas) json["areas"].push_back(number_json(area, limit * motion));
  set_number(json, "masing_error", judgement.masing_error, kNotShown);
  json["tried"] = Json::array();
  for (const LoopHypothesis& law : judgement.fitted) {
    Json tried{{"law", law.name}, {"parameters", law.parameters}};
    set_number(tried, "residual", law.residual, "not a number");
    json["tried"].push_back(tried);
  }
  return json;
}

/// d ln(largest moment)/d ln(normal load), by least squares, of the loops and of the limit.
struct LoadExponent {
  double value;
  double exact;
  bool differs() const {
    constexpr double kSame = 0.05;
    return !(std::abs(value - exact) <= kSame);
  }
};
LoadExponent load_exponent(const std::vector<LoopUnderLoad>& loops) {
  double x_mean = 0.0;
  double y_mean = 0.0;
  std::vector<std::pair<double, double>> points;
  for (const LoopUnderLoad& loop : loops) {
    points.emplace_back(std::log(loop.contact.normal_load),
                        std::log(loop.contact.limit * largest(loop.path.moment)));
    x_mean += points.back().first / static_cast<double>(loops.size());
    y_mean += points.back().second / static_cast<double>(loops.size());
  }
  double above = 0.0;
  double below = 0.0;
  for (const auto& [x, y] : points) {
    above += (x - x_mean) * (y - y_mean);
    below += (x - x_mean) * (x - x_mean);
  }
  return {above / below, loops.front().contact.limit_exponent};
}

/// Whether all of these slide, so that their largest moments are limits.
bool all_slide(const std::vector<LoopUnderLoad>& loops) {
  return std::ranges::all_of(loops, [](const LoopUnderLoad& loop) {
    const std::vector<double> exact = follow(loop.path, masing_law(loop.contact.loading));
    return largest(exact) > 0.95;
  });
}

}  // namespace

Json check_loop(const solver::Scene& scene, const std::filesystem::path& file, const LoopOptions& options) {
  law_contact(scene);  // or why there is none, before the loop is read
  const LoopRecord record = read_loop(file);
  const auto contact_under = record.of_force ? force_contact : torsion_contact;
  const double scene_load = *scene.steps.front().normal;
  const LoopConventions conventions = find_conventions(record, contact_under(scene, scene_load));
  std::vector<LoopUnderLoad> loops;
  for (const auto& [from, to, load] : rows_by_load(record, scene_load)) {
    const LoopContact contact = contact_under(scene, load);
    loops.push_back({contact, make_path(record, from, to, conventions, contact)});
  }
  bool good = !(options.strict && !conventions.notes.empty());
  std::string why = good ? "" : conventions.notes.front();
  Json loads = Json::array();
  for (const LoopUnderLoad& loop : loops) {
    const LoopJudgement judgement = judge_loop(loop.path, loop.contact, options.tolerance);
    if (why.empty() || (good && !judgement.good)) why = judgement.why;
    good = good && judgement.good;
    loads.push_back(under_load_json(loop, judgement));
  }
  Json json{{"name", scene.name}, {"loop", file.string()}, {"of", record.of_force ? "force" : "torsion"}};
  json["verdict"] = "";
  json["why"] = "";
  json["conventions"] = conventions.notes;
  json["tolerance"] = options.tolerance;
  if (loops.size() > 1 && all_slide(loops)) {
    const LoadExponent exponent = load_exponent(loops);
    json["load_exponent"] = {{"value", exponent.value}, {"exact", exponent.exact}};
    if (exponent.differs()) {
      why = fmt::format("the limit goes like the normal load to the power {:.2f}, not {:.2f}{}; {}",
                        exponent.value, exponent.exact,
                        std::abs(exponent.value - 1.0) < 0.03 ? ": a contact radius that does not grow" : "",
                        why);
      good = false;
    }
  }
  json["verdict"] = good ? "good" : "bad";
  json["why"] = why;
  json["loads"] = loads;
  json["provenance"] = provenance(1);
  return json;
}

std::string loop_text(const Json& r) {
  const bool of_force = r["of"] == "force";
  const char* const load_unit = of_force ? "N" : "N m";
  const char* const motion_unit = of_force ? "m" : "rad";
  const auto beside = [](const Json& number, const char* unit) {
    return fmt::format("{} {} (exact {})", number_text(number["value"]), unit, number_text(number["exact"]));
  };
  std::string text = fmt::format("{}: {}\n", r["verdict"].get<std::string>(), r["why"].get<std::string>());
  text += text_line("loop", r["loop"].get<std::string>());
  for (const Json& note : r["conventions"]) text += text_line("note", note.get<std::string>());
  if (r.contains("load_exponent")) text += text_line("load exponent", beside(r["load_exponent"], ""));
  for (const Json& load : r["loads"]) {
    text +=
        text_line("normal load", fmt::format("{} N, {} rows, {} reversals", number_text(load["normal_load"]),
                                             load["rows"].get<int>(), load["reversals"].get<int>()));
    text += text_line("stiffness", beside(load["stiffness"], of_force ? "N/m" : "N m/rad") +
                                       ", up to a third of the largest load");
    text += text_line(of_force ? "force" : "moment",
                      fmt::format("{}, of the limit {} {}", beside(load["largest_load"], load_unit),
                                  number_text(load["limit"]), load_unit));
    text += text_line("presliding", beside(load["presliding"], motion_unit) + " at half of the limit");
    text += text_line("recovered",
                      beside(load["recovered"], of_force ? "of the displacement" : "of the rotation"));
    for (const Json& area : load["areas"]) text += text_line("energy lost", beside(area, "J in a loop"));
    text += text_line("Masing's rule",
                      fmt::format("{} of the largest load off", short_text(load["masing_error"])));
  }
  return text;
}

}  // namespace slipstick::convergence
