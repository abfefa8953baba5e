#include "bench/compare/rounds.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "bench/compare/second_run.hpp"
#include "bench/timing/timings.hpp"
#include "convergence/programs/run_program.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/runs/run_spec.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::bench {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;
using convergence::run_program;
using convergence::TemporaryFolder;

/// A path that is not looked up on PATH.
std::string program_word(const fs::path& program) { return fs::absolute(program).string(); }

/// Tells sittings apart: when, and by which process.
std::string new_sitting() {
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

RunHeat run_once(const Heat& heat, bool reverse, const RunLength& length) {
  RunHeat result{.runs = std::vector<Json>(heat.size())};
  for (std::size_t i = 0; i < heat.size(); ++i) {
    const std::size_t place = reverse ? heat.size() - 1 - i : i;
    const Contestant& now = heat[place];
    if (!now.benchmark.empty()) result.runs[place] = run_benchmark(now.program, now.benchmark, length);
  }
  return result;
}

}  // namespace

std::vector<std::string> list_benchmarks(const fs::path& program, const std::string& filter) {
  if (!fs::is_regular_file(program)) {
    throw solver::InputError(program.string(), "there is no such program; allowed: one of Google Benchmark");
  }
  const TemporaryFolder folder;
  const fs::path list = folder / "list";
  std::vector<std::string> words{program_word(program), "--benchmark_list_tests"};
  if (!filter.empty()) words.push_back(fmt::format("--benchmark_filter={}", filter));
  const int status = run_program(words, list);
  std::vector<std::string> names;
  std::ifstream lines(list);
  for (std::string line; std::getline(lines, line);) names.push_back(line);
  if (status != 0 || names.empty()) {
    throw solver::InputError(program.string(), fmt::format("lists no benchmark that fits \"{}\"", filter));
  }
  return names;
}

Json run_benchmark(const fs::path& program, const std::string& name, const RunLength& length) {
  const TemporaryFolder folder;
  const fs::path out = folder / "timings.json";
  const int status =
      run_program({program_word(program), fmt::format("--benchmark_filter={}", benchmark_filter({name})),
                   fmt::format("--benchmark_out={}", out.string()), "--benchmark_out_format=json",
                   fmt::format("--benchmark_min_time={}", length.seconds),
                   fmt::format("--benchmark_repetitions={}", length.repetitions)},
                  folder / "shown", folder / "complaints");
  if (status != 0) {
    throw std::runtime_error(
        fmt::format("{}: benchmark {} ended with code {}", program.string(), name, status));
  }
  return parse_benchmark_json(convergence::read_text(out),
                              fmt::format("{}: benchmark {}", program.string(), name));
}

void wait_for_full_pace(const AtFullPace& at_full_pace, Patience& left) {
  constexpr Patience kPause{0.25};
  for (; left > Patience(0.0) && !at_full_pace(); left -= kPause) std::this_thread::sleep_for(kPause);
}

RunHeat run_heat(const Heat& heat, bool reverse, const RunLength& length, const AtFullPace& at_full_pace,
                 Patience& left) {
  if (!at_full_pace) return run_once(heat, reverse, length);
  for (;;) {
    wait_for_full_pace(at_full_pace, left);
    const auto start = std::chrono::steady_clock::now();
    RunHeat result = run_once(heat, reverse, length);
    result.steady = at_full_pace();
    if (result.steady || !(left > Patience(0.0))) return result;
    left -= std::chrono::steady_clock::now() - start;
  }
}

Sitting run_in_turn(const std::vector<Heat>& heats, int rounds, const RunLength& length,
                    const RoundProgress& progress, const AtFullPace& at_full_pace) {
  std::size_t places = 0;
  for (const Heat& heat : heats) places = std::max(places, heat.size());
  Patience patience = kPatience;
  Sitting sitting;
  sitting.files.resize(places, {{"context", Json::object()}, {"benchmarks", Json::array()}});
  for (int round = 0; round < rounds; ++round) {
    for (const Heat& heat : heats) {
      const RunHeat run = run_heat(heat, round % 2 != 0, length, at_full_pace, patience);
      for (std::size_t place = 0; place < heat.size(); ++place) {
        if (run.runs[place].is_null()) continue;
        add_repetition(sitting.files[place], run.runs[place], heat[place].name, round, rounds);
      }
      ++sitting.heats;
      if (!run.steady) ++sitting.unsteady;
      if (progress) progress(heat);
    }
  }
  const std::string name = new_sitting();
  for (Json& file : sitting.files) file["context"]["sitting"] = name;
  return sitting;
}

}  // namespace slipstick::bench
