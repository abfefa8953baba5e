#include "convergence/check/loops/check_loop.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <utility>

#include "convergence/oracle/law_contact.hpp"
#include "convergence/results/provenance.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

const std::string kNotShown = "the loop does not show it";

/// The units and signs of a record.
struct LoopConventions {
  double load = 1.0;               ///< N m, or N, of one unit; negative: the other sign
  double motion = 1.0;             ///< rad, or m, of one unit
  std::vector<std::string> notes;  ///< how they differ from the scene's
};

struct UnitName {
  double size;
  const char* name;
};
const std::vector<UnitName> kMomentUnits{{1.0, ""}, {1e-3, "N mm"}, {1e-6, "mN mm, or uN m"}, {1e3, "kN m"}};
const std::vector<UnitName> kRotationUnits{
    {1.0, ""}, {std::numbers::pi / 180.0, "degrees"}, {1e-3, "mrad"}, {1e-6, "urad"}};
const std::vector<UnitName> kForceUnits{{1.0, ""}, {1e-3, "mN"}, {1e3, "kN"}};
const std::vector<UnitName> kLengthUnits{{1.0, ""}, {1e-3, "mm"}, {1e-6, "um"}, {1e-9, "nm"}};

/// Rows of a path: a fit gains nothing by more.
constexpr std::size_t kMaxPathRows = 2000;

LoopPath make_path(const LoopRecord& loop, std::size_t from, std::size_t to,
                   const LoopConventions& conventions, const LoopContact& contact) {
  const std::size_t step = (to - from + kMaxPathRows - 1) / kMaxPathRows;
  LoopPath path;
  const auto time_of = [&](std::size_t row) {
    return loop.time.empty() ? static_cast<double>(row) : loop.time[row];
  };
  const auto add = [&](std::size_t row) {
    path.twist.push_back(loop.motion[row] * conventions.motion / contact.motion_unit);
    path.moment.push_back(loop.load[row] * conventions.load / contact.limit);
    path.time.push_back((time_of(row) - time_of(from)) / (time_of(to - 1) - time_of(from)));
  };
  for (std::size_t row = from; row < to; row += step) add(row);
  if (!loop.time.empty()) path.duration = loop.time[to - 1] - loop.time[from];
  find_turns(path);
  return path;
}

/// Consecutive rows under one normal load.
struct LoadRows {
  std::size_t from;
  std::size_t to;
  double normal_load;
};
std::vector<LoadRows> rows_by_load(const LoopRecord& loop, double scene_load) {
  constexpr double kSameLoad = 0.02;  // relative difference of rows under one load
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

Json under_load_json(const LoopUnderLoad& loop) {
  const double motion = loop.contact.motion_unit;
  const double limit = loop.contact.limit;
  const LoopJudgement& judgement = loop.judgement;
  const LoopHypothesis& exact = judgement.exact;
  Json json{{"normal_load", loop.contact.normal_load},
            {"verdict", judgement.good ? "good" : "bad"},
            {"why", judgement.why}};
  if (judgement.law.empty()) {
    set_missing(json, "law", "none of the known laws explains it, or more than one");
  } else {
    json.update({{"law", judgement.law}});
  }
  json.update(
      {{"rows", loop.path.twist.size()}, {"reversals", loop.path.turns.size() - 2}, {"limit", limit}});
  set_number(json, "residual", judgement.residual, "not a number");
  set_number(json, "noise", judgement.noise, "not a number");
  set_number(json, "slip_error", judgement.slip_error, kNotShown);
  set_number(json, "slip_noise", judgement.slip_noise, kNotShown);
  Json areas = Json::array();
  for (const LoopNumber& area : judgement.areas) areas.push_back(number_json(area, limit * motion));
  Json tried = Json::array();
  for (const LoopHypothesis& law : judgement.fitted) {
    set_number(tried.emplace_back(Json{{"law", law.name}, {"parameters", law.parameters}}), "residual",
               law.residual, "not a number");
  }
  json.update({{"start",
                {{"turned", exact.start.turned * motion},
                 {"motion_offset", exact.start.shift == 0.0 ? 0.0 : -exact.start.shift * motion},
                 {"load_offset", exact.offset * limit}}},
               {"stiffness", number_json(judgement.stiffness, limit / motion)},
               {"largest_load", number_json(judgement.largest_load, limit)},
               {"areas", areas},
               {"tried", tried}});
  return json;
}

/// Whether all loops reach gross slip, so that their largest moments are limits.
bool all_slide(const std::vector<LoopUnderLoad>& loops) {
  return std::ranges::all_of(loops, [](const LoopUnderLoad& loop) {
    return largest_of(follow(loop.path, {}, {loop.contact.loading})) > 0.95;
  });
}

std::vector<std::string> notes_of(const UnitName& load, const UnitName& motion, bool other_way,
                                  const LoopWords& words) {
  std::vector<std::string> notes;
  if (load.size != 1.0) notes.push_back(fmt::format("the {} is in {}", words.load, load.name));
  if (motion.size != 1.0) notes.push_back(fmt::format("the {} is in {}", words.motion, motion.name));
  if (other_way) {
    notes.push_back(fmt::format("the {} acts on the other body, or the {} is the other way round", words.load,
                                words.motion));
  }
  return notes;
}

/// Distance of a loop's load from the exact law, over the larger of both, from rest or over whole cycles.
double roughly_off(const LoopUnderLoad& loop) {
  const std::vector<LoopStart> starts = possible_starts(loop.path);
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < std::min<std::size_t>(starts.size(), 3); ++k) {
    std::vector<double> exact = follow(loop.path, starts[k], {loop.contact.loading});
    const double size = std::max(largest_of(exact), largest_of(loop.path.moment));
    double mean = 0.0;
    for (std::size_t row = 0; row < exact.size(); ++row) {
      exact[row] -= loop.path.moment[row];
      mean += exact[row] / static_cast<double>(exact.size());
    }
    for (double& error : exact) error -= mean;
    least = std::min(least, trimmed_mean(exact) / size);
  }
  return least;
}

/// The units and the sign in which a loop is near the exact law, if it is far from it in the scene's. Another
/// unit is taken only where slip shows: loops without slip fit in any unit.
LoopConventions find_conventions(const LoopRecord& record, std::size_t to, const LoopContact& contact,
                                 double tolerance) {
  constexpr double kNear = 0.35;                // roughly_off() at most, in the right units
  constexpr double kFar = 0.7;                  // and at least in wrong ones, where slip shows
  constexpr double kLargestWithoutSlip = 0.05;  // load over the limit
  const auto loop_in = [&](const LoopConventions& conventions) {
    return LoopUnderLoad{contact, make_path(record, 0, to, conventions, contact), {}};
  };
  const LoopUnderLoad given = loop_in({});
  const double as_given = roughly_off(given);
  double least = std::min(kNear, 0.5 * as_given);
  LoopConventions found;
  constexpr double kFalls = -0.9;  // the load as the motion grows, whatever their units
  if (line_through(given.path.twist, given.path.moment).correlation < kFalls)
    found = {-1.0, 1.0, notes_of({1.0, ""}, {1.0, ""}, true, contact.words)};
  const LoopConventions by_sign = found;
  for (const UnitName& load : record.of_force ? kForceUnits : kMomentUnits) {
    for (const UnitName& motion : record.of_force ? kLengthUnits : kRotationUnits) {
      for (const bool other_way : {false, true}) {
        const LoopConventions tried{other_way ? -load.size : load.size, motion.size,
                                    notes_of(load, motion, other_way, contact.words)};
        const double off = roughly_off(loop_in(tried));
        if (!(off < least)) continue;
        least = off;
        found = tried;
      }
    }
  }
  if (found.notes == by_sign.notes) return found;
  const LoopUnderLoad loop = loop_in(found);
  const bool slips = largest_of(loop.path.moment) >= kLargestWithoutSlip;
  if (as_given > kFar && slips) return found;
  const LoopJudgement judgement = judge_loop(loop.path, contact, tolerance);
  const bool has_unit = found.motion != 1.0 || std::abs(found.load) != 1.0;
  // The record itself shows slip, not a start far outside of it.
  const bool shows = judgement.shows_slip() && std::abs(judgement.exact.offset) <= range_of(loop.path.moment);
  return judgement.good && (slips || !has_unit || shows) ? found : by_sign;
}

/// d ln(largest moment)/d ln(normal load) of the loops by least squares, and of the limit.
LoopNumber load_exponent(const std::vector<LoopUnderLoad>& loops) {
  std::vector<double> x;
  std::vector<double> y;
  for (const LoopUnderLoad& loop : loops) {
    x.push_back(std::log(loop.contact.normal_load));
    y.push_back(std::log(loop.contact.limit * largest_of(loop.path.moment)));
  }
  return {line_through(x, y).slope, loops.front().contact.limit_exponent};
}

/// The fault of an exponent in words, empty where there is none.
std::string exponent_fault(const LoopNumber& exponent) {
  constexpr double kSameExponent = 0.05;
  if (std::abs(exponent.value - exponent.exact) <= kSameExponent) return "";
  return fmt::format("the limit goes like the normal load to the power {:.2f}, not {:.2f}{}", exponent.value,
                     exponent.exact,
                     std::abs(exponent.value - 1.0) < 0.03 ? ": a contact radius that does not grow" : "");
}

}  // namespace

LoopCheck check_loop(const solver::Scene& scene, const std::filesystem::path& file,
                     const LoopOptions& options) {
  law_contact(scene);  // or why there is none, before the loop is read
  const LoopRecord record = read_loop(file);
  const auto contact_under = record.of_force ? force_contact : torsion_contact;
  const std::vector<LoadRows> groups = rows_by_load(record, *scene.steps.front().normal);
  std::vector<LoopContact> contacts;
  for (const LoadRows& group : groups) contacts.push_back(contact_under(scene, group.normal_load));
  const auto judged_in = [&](const LoopConventions& conventions) {
    std::vector<LoopUnderLoad> loops;
    for (std::size_t i = 0; i < groups.size(); ++i) {
      LoopPath path = make_path(record, groups[i].from, groups[i].to, conventions, contacts[i]);
      LoopJudgement judgement = judge_loop(path, contacts[i], options.tolerance);
      loops.push_back({contacts[i], std::move(path), std::move(judgement)});
    }
    return loops;
  };
  LoopCheck check{.name = scene.name,
                  .file = file,
                  .of_force = record.of_force,
                  .tolerance = options.tolerance,
                  .conventions = {},
                  .load_exponent = {},
                  .good = true,
                  .why = "",
                  .loads = judged_in({})};
  if (!std::ranges::all_of(check.loads, [](const LoopUnderLoad& loop) { return loop.judgement.good; })) {
    const LoopConventions conventions =
        find_conventions(record, groups.front().to, contacts.front(), options.tolerance);
    check.conventions = conventions.notes;
    if (!conventions.notes.empty() && !options.strict) check.loads = judged_in(conventions);
    if (!conventions.notes.empty() && options.strict) {
      check.good = false;
      check.why = conventions.notes.front();
    }
  }
  for (LoopUnderLoad& loop : check.loads) {
    LoopJudgement& judgement = loop.judgement;
    if (!judgement.good) explain(judgement, loop.path, loop.contact, options.tolerance);
    if (check.why.empty() || (check.good && !judgement.good)) check.why = judgement.why;
    check.good = check.good && judgement.good;
  }
  if (check.loads.size() > 1 && all_slide(check.loads)) {
    check.load_exponent = load_exponent(check.loads);
    if (const std::string fault = exponent_fault(*check.load_exponent); !fault.empty()) {
      check.why = fault + "; " + check.why;
      check.good = false;
    }
  }
  return check;
}

Json to_json(const LoopCheck& check) {
  Json loads = Json::array();
  for (const LoopUnderLoad& loop : check.loads) loads.push_back(under_load_json(loop));
  Json json{{"name", check.name},
            {"loop", check.file.string()},
            {"of", check.of_force ? "force" : "torsion"},
            {"verdict", check.good ? "good" : "bad"},
            {"why", check.why},
            {"conventions", check.conventions},
            {"tolerance", check.tolerance}};
  if (const auto& exponent = check.load_exponent)
    json.update({{"load_exponent", {{"value", exponent->value}, {"exact", exponent->exact}}}});
  json.update({{"loads", loads}, {"provenance", provenance(1)}});
  return json;
}

std::string loop_text(const LoopCheck& check) {
  const char* const load_unit = check.of_force ? "N" : "N m";
  const auto with_exact = [](const LoopNumber& number, double unit, const char* name) {
    const auto text = [&](double value) {
      return std::isfinite(value) ? fmt::format("{:.6g}", value * unit) : std::string("-");
    };
    return fmt::format("{} {} (exact {})", text(number.value), name, text(number.exact));
  };
  std::string text = fmt::format("{}: {}\n", check.good ? "good" : "bad", check.why);
  text += text_line("loop", check.file.string());
  for (const std::string& note : check.conventions) text += text_line("note", note);
  if (check.load_exponent) text += text_line("load exponent", with_exact(*check.load_exponent, 1.0, ""));
  for (const LoopUnderLoad& loop : check.loads) {
    const double motion = loop.contact.motion_unit;
    const double limit = loop.contact.limit;
    const LoopJudgement& judgement = loop.judgement;
    text += text_line("normal load", fmt::format("{:.6g} N, {} rows, {} reversals", loop.contact.normal_load,
                                                 loop.path.twist.size(), loop.path.turns.size() - 2));
    text += text_line("stiffness",
                      with_exact(judgement.stiffness, limit / motion, check.of_force ? "N/m" : "N m/rad") +
                          ", up to a third of the largest load");
    text += text_line(check.of_force ? "force" : "moment",
                      fmt::format("{}, of the limit {:.6g} {}",
                                  with_exact(judgement.largest_load, limit, load_unit), limit, load_unit));
    for (const LoopNumber& area : judgement.areas)
      text += text_line("energy lost", with_exact(area, limit * motion, "J in a loop"));
  }
  return text;
}

}  // namespace slipstick::convergence
