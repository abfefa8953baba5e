#include "bench/compare/ab_run.hpp"

#include <fmt/core.h>
#include <unistd.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <utility>

#include "convergence/runs/progress.hpp"

namespace slipstick::bench {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

/// Distinguishes sessions: when, and by which process.
std::string new_session() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return fmt::format("{}-{}", std::chrono::duration_cast<std::chrono::milliseconds>(now).count(), getpid());
}

/// Adds the rows of a run, as one repetition of all.
void add_repetition(Json& file, const Json& run, const std::string& name, int round, int rounds) {
  if (file["context"].empty()) file["context"] = run.at("context");
  for (Json row : run.at("benchmarks")) {
    if (row.value("run_type", "iteration") != "iteration") continue;
    row["name"] = row["run_name"] = name;
    row["repetitions"] = rounds;
    row["repetition_index"] = round;
    file["benchmarks"].push_back(std::move(row));
  }
}

TwoTimings timings_of(const SessionFiles& files) {
  return {parse_timings(files[0].dump(), "base"), parse_timings(files[1].dump(), "new")};
}

}  // namespace

std::vector<InterleavedPair> two_builds(const fs::path& base, const fs::path& now,
                                        const std::string& filter) {
  const std::vector<std::string> of_base = list_benchmarks(base, filter);
  const std::vector<std::string> of_now = list_benchmarks(now, filter);
  std::vector<InterleavedPair> pairs;
  for (const std::string& name : of_base) {
    pairs.push_back({name, {{{base, name}, {now, contains(of_now, name) ? name : ""}}}});
  }
  for (const std::string& name : of_now) {
    if (!contains(of_base, name)) pairs.push_back({name, {{{base, ""}, {now, name}}}});
  }
  return pairs;
}

std::vector<InterleavedPair> two_methods(const fs::path& program, const std::string& base,
                                         const std::string& now) {
  for (const std::string& name : {base, now}) list_benchmarks(program, benchmark_filter({name}));
  return {{fmt::format("{} over {}", now, base), {{{program, base}, {program, now}}}}};
}

SessionFiles run_session(const std::vector<InterleavedPair>& pairs, int rounds, const RunLength& length) {
  const std::size_t parts = pairs.size() * static_cast<std::size_t>(rounds);
  convergence::Progress progress(parts, static_cast<double>(parts));
  SessionFiles files;
  files.fill({{"context", Json::object()}, {"benchmarks", Json::array()}});
  for (int round = 0; round < rounds; ++round) {
    for (const InterleavedPair& pair : pairs) {
      for (const std::size_t turn : {0U, 1U}) {
        const std::size_t side = round % 2 == 0 ? turn : 1 - turn;
        const auto& [program, benchmark] = pair.sides[side];
        if (benchmark.empty()) continue;
        add_repetition(files[side], run_benchmark(program, benchmark, length), pair.name, round, rounds);
      }
      progress.finished(pair.name, 1.0);
    }
  }
  files[0]["context"]["session"] = files[1]["context"]["session"] = new_session();
  return files;
}

ABRunResult run_ab(const std::vector<InterleavedPair>& pairs, int rounds, const ComparisonRules& rules,
                   const RunLength& length) {
  SessionFiles files = run_session(pairs, rounds, length);
  ComparisonReport report{"base", "new", rules, compare(timings_of(files), rules), {}};
  std::vector<InterleavedPair> again = pairs;
  const std::vector<std::string> names = suspicious(report.comparison);
  std::erase_if(again, [&](const InterleavedPair& pair) { return !contains(names, pair.name); });
  if (!again.empty()) {
    report.second = compare(timings_of(run_session(again, 2 * rounds, length)), rules);
    report.comparison = confirm(report.comparison, *report.second);
  }
  return {std::move(report), std::move(files)};
}

}  // namespace slipstick::bench
