#include "bench/compare/ab_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <set>

#include "bench/compare/second_run.hpp"
#include "convergence/runs/progress.hpp"

namespace slipstick::bench {
namespace {

using Json = nlohmann::ordered_json;

Sitting run(const std::vector<Heat>& heats, int rounds, const RunLength& length) {
  const std::size_t parts = heats.size() * static_cast<std::size_t>(rounds);
  convergence::Progress progress(parts, static_cast<double>(parts));
  return run_in_turn(heats, rounds, length,
                     [&](const Heat& heat) { progress.finished(heat.front().name, 1.0); });
}

TwoTimings timings_of(const Sitting& sitting) {
  return {parse_timings(sitting.files[0].dump(), "base"), parse_timings(sitting.files[1].dump(), "new")};
}

std::vector<Heat> heats_of(const std::vector<Heat>& heats, const std::vector<std::string>& names) {
  std::vector<Heat> found;
  std::copy_if(heats.begin(), heats.end(), std::back_inserter(found), [&](const Heat& heat) {
    return std::find(names.begin(), names.end(), heat.front().name) != names.end();
  });
  return found;
}

}  // namespace

std::vector<Heat> two_builds(const std::filesystem::path& base, const std::filesystem::path& now,
                             const std::string& filter) {
  const std::vector<std::string> of_base = list_benchmarks(base, filter);
  const std::vector<std::string> of_now = list_benchmarks(now, filter);
  const std::set<std::string> base_names(of_base.begin(), of_base.end());
  const std::set<std::string> now_names(of_now.begin(), of_now.end());
  const auto contestant = [](const auto& program, const auto& names, const std::string& name) {
    return Contestant{program, names.contains(name) ? name : "", name};
  };
  std::vector<Heat> heats;
  const auto add = [&](const std::string& name) {
    heats.push_back({contestant(base, base_names, name), contestant(now, now_names, name)});
  };
  for (const std::string& name : of_base) add(name);
  for (const std::string& name : of_now) {
    if (!base_names.contains(name)) add(name);
  }
  return heats;
}

std::vector<Heat> two_methods(const std::filesystem::path& program, const std::string& base,
                              const std::string& now) {
  for (const std::string& name : {base, now}) list_benchmarks(program, benchmark_filter({name}));
  const std::string both = fmt::format("{} over {}", now, base);
  return {{{program, base, both}, {program, now, both}}};
}

ContestResult hold_contest(const Contest& contest) {
  Sitting first = run(contest.heats, contest.rounds, contest.length);
  const auto again = [&](const std::vector<std::string>& names) {
    return timings_of(run(heats_of(contest.heats, names), 2 * contest.rounds, contest.length));
  };
  ComparisonReport report = compare_twice(timings_of(first), contest.rules, again);
  return {std::move(report), std::move(first)};
}

}  // namespace slipstick::bench
