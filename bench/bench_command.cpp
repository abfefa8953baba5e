#include "bench/bench_command.hpp"

#include <fmt/chrono.h>
#include <fmt/core.h>
#include <fmt/ranges.h>

#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "bench/compare/ab_run.hpp"
#include "bench/compare/baseline.hpp"
#include "bench/compare/pace.hpp"
#include "bench/compare/second_run.hpp"
#include "bench/compare/survey.hpp"
#include "bench/plane/accuracy_from_plane.hpp"
#include "bench/plane/speed_error.hpp"
#include "bench/scaling/scaling_result.hpp"
#include "bench/timing/machine.hpp"
#include "convergence/programs/python_script.hpp"
#include "convergence/results/markup.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/runs/progress.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/run_spec.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::bench {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;
using solver::InputError;

/// What is compared unless a filter says otherwise: each part and the whole at two sizes, so small that it is
/// done often.
constexpr const char* kCompared =
    "^(application/(direct|dcfft[a-z_]*)|influence/tangential|setup/dcfft[a-z_]*|normal/solve|solve/[a-z_]+)"
    "/cells:(64|256)(/permille:900)?$|^exact/.*/hertz$";
/// A survey's: repetitions for intervals.
constexpr RunLength kSurveyLength{.seconds = 0.02, .repetitions = 7};

struct Options {
  std::string program = SLIPSTICK_BENCHMARK_PROGRAM;
  std::string output = "build/benchmarks";
  std::string filter;
  std::string accuracy_data;
  std::string against;
  std::vector<std::string> pair;
  std::string baselines;
  std::optional<std::string> renew;
  int rounds = 16;
  double effect = ComparisonRules{}.effect;
  bool quick = false;
  bool machine = false;
};

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))); }

/// What `solve --accuracy` picks by.
void keep_accuracy_data(const std::string& file, const Json& plane) {
  const std::string origin = fmt::format("Measured by slipstick bench on {}, {}.", machine_key(), today());
  convergence::write_option_file("--accuracy-data", file,
                                 convergence::accuracy_toml(accuracy_from_plane(plane), origin));
}

/// Everything, one after the other, and the page.
int survey(const Options& options, std::ostream& text, Json& result) {
  const fs::path folder = options.output;
  const fs::path data = folder / "data";
  Pace pace;
  const AtFullPace at_full_pace = [&] { return pace.is_full(); };
  result = run_survey(options.program, list_benchmarks(options.program, options.filter), kSurveyLength,
                      data / "finished", at_full_pace);
  convergence::write_json_file(data / "timings.json", result);
  const Json laws = scaling_json(parse_timings(result.dump(), "timings.json"));
  convergence::write_json_file(data / "scaling.json", laws);

  Patience patience = kPatience;
  convergence::Progress progress(plane_size(options.quick), static_cast<double>(plane_size(options.quick)));
  const Json plane = measure_plane({.scene = convergence::project_file("convergence/scenes/paper.toml"),
                                    .output = data / "finished",
                                    .quick = options.quick,
                                    .progress = [&](const std::string& point) {
                                      progress.finished(point, 1.0);
                                      wait_for_full_pace(at_full_pace, patience);
                                    }});
  convergence::write_json_file(data / "plane.json", plane);
  if (!options.accuracy_data.empty()) keep_accuracy_data(options.accuracy_data, plane);
  convergence::run_report_script("speed_page.py", {data, "--output", folder},
                                 "the timings are in " + data.string());
  convergence::write_option_file("--output", data / "scaling.txt", scaling_text(laws));
  convergence::write_option_file("--output", data / "plane.txt", plane_text(plane));
  text << crossovers_text(laws) << times_text(plane) << "page: " << (folder / "index.html").string() << '\n';
  return 0;
}

int report_contest(const Options& options, const ContestResult& held, std::ostream& text, Json& result) {
  const fs::path folder = options.output;
  fs::create_directories(folder);
  convergence::write_json_file(folder / "base.json", held.first.files[0]);
  convergence::write_json_file(folder / "new.json", held.first.files[1]);
  convergence::write_json_file(folder / "comparison.json", comparison_json(held.report));
  result = held.first.files[1];
  text << comparison_text(held.report);
  return exit_code(held.report.comparison);
}

/// Two builds or two methods in turn.
int contest(const Options& options, std::ostream& text, Json& result) {
  const auto heats = options.pair.empty() ? two_builds(options.against, options.program,
                                                       options.filter.empty() ? kCompared : options.filter)
                                          : two_methods(options.program, options.pair[0], options.pair[1]);
  ContestResult held =
      hold_contest({.heats = heats, .rounds = options.rounds, .rules = {.effect = options.effect}});
  held.report.base = options.pair.empty() ? options.against : options.pair[0];
  held.report.now = options.pair.empty() ? options.program : options.pair[1];
  return report_contest(options, held, text, result);
}

/// What this build is remembered by.
Sitting sitting_to_remember(const Options& options, const std::vector<std::string>& names, Pace& pace) {
  std::vector<Heat> heats;
  for (const std::string& name : names) heats.push_back({{options.program, name, name}});
  const std::size_t parts = heats.size() * static_cast<std::size_t>(options.rounds);
  convergence::Progress progress(parts, static_cast<double>(parts));
  Sitting sitting = run_in_turn(
      heats, options.rounds, {}, [&](const Heat& heat) { progress.finished(heat.front().name, 1.0); },
      [&] { return pace.is_full(); });
  sitting.files.front()["context"]["pace_seconds"] = pace.best();
  return sitting;
}

std::string unsteady(const Sitting& sitting) {
  return fmt::format("in {} of {} runs the machine was slowed down by others", sitting.unsteady,
                     sitting.heats);
}

Json read_baseline(const fs::path& file) {
  return fs::exists(file) ? Json::parse(convergence::read_text(file)) : Json();
}

int renew(const Options& options, std::ostream& text, Json& result) {
  if (options.renew->empty()) {
    throw InputError("command line", "--renew", "", "the reason, in a sentence: what changed the times");
  }
  const fs::path file = baseline_file(options.baselines, machine_key());
  Pace pace;
  const Sitting sitting = sitting_to_remember(options, list_benchmarks(options.program, kCompared), pace);
  result = sitting.files.front();
  if (10 * sitting.unsteady > sitting.heats) {
    throw std::runtime_error(unsteady(sitting) + ": nothing is remembered; try again when it is idle");
  }
  const Json made_by = convergence::provenance(1);
  write_baseline(file, make_baseline(result, read_baseline(file),
                                     {.date = today(),
                                      .version = made_by["version"],
                                      .commit = made_by["commit"],
                                      .reason = *options.renew}));
  text << "baseline: " << file.string() << '\n';
  return 0;
}

/// Times of another day mean something only if the machine works as it did then.
std::vector<std::string> obstacles(const Sitting& sitting, const Pace& pace) {
  std::vector<std::string> found;
  if (10 * sitting.unsteady > sitting.heats) found.push_back(unsteady(sitting));
  if (pace.is_below_reference()) {
    found.push_back(fmt::format("bare transforms take {:.3g} times as long as when the base was timed",
                                pace.best() / pace.reference()));
  }
  return found;
}

/// Throws InputError for a second run that proves nothing.
void require_full_pace(const Sitting& sitting, const Pace& pace) {
  const std::vector<std::string> found = obstacles(sitting, pace);
  if (!found.empty()) throw InputError("second run", fmt::format("{}", fmt::join(found, "; ")));
}

int compare_with_baseline(const Options& options, std::ostream& text, Json& result) {
  const fs::path file = baseline_file(options.baselines, machine_key());
  if (!fs::exists(file)) {
    throw InputError(file.string(),
                     "no times of this kind of machine are kept, so none can be compared; keep those of this "
                     "build with --renew REASON");
  }
  const std::vector<std::string> names =
      list_benchmarks(options.program, options.filter.empty() ? kCompared : options.filter);
  Timings base = read_timings(file);
  if (!options.filter.empty()) base = select(base, names);
  Pace pace(read_baseline(file).at("context").value("pace_seconds", 0.0));
  const auto timings = [](const Sitting& sitting) {
    return parse_timings(sitting.files.front().dump(), "new");
  };
  const Sitting sitting = sitting_to_remember(options, names, pace);
  ComparisonRules rules{.effect = options.effect};
  rules.obstacles = obstacles(sitting, pace);
  ComparisonReport report =
      compare_twice({base, timings(sitting)}, rules, [&](const std::vector<std::string>& suspects) {
        const Sitting second = sitting_to_remember(options, suspects, pace);
        require_full_pace(second, pace);
        return TwoTimings{select(base, suspects), timings(second)};
      });
  report.base = file.string();
  report.now = options.program;
  result = sitting.files.front();
  text << comparison_text(report);
  return exit_code(report.comparison);
}

int run(const Options& options, std::ostream& text, Json& result) {
  if (options.machine) {
    text << machine_key() << '\n';
    return 0;
  }
  if (options.renew) return renew(options, text, result);
  if (!options.baselines.empty()) return compare_with_baseline(options, text, result);
  if (!options.against.empty() || !options.pair.empty()) return contest(options, text, result);
  return survey(options, text, result);
}

constexpr const char* kFooter = R"(Example:
  slipstick bench                                    everything, and the page build/benchmarks/index.html
  slipstick bench --against ../before/build/bench/slipstick_benchmarks
                                                     is this build slower than that one?
  slipstick bench --pair application/direct/cells:64 application/dcfft/cells:64
                                                     two methods, one over the other
  slipstick bench --baselines bench/baselines        is it slower than what is remembered of this machine?
Two builds or methods are timed in turn, in one sitting; what is at least 10 % slower is timed once more before it
is called so. Finished timings of a survey are kept: an interrupted command goes on from there.
Exit code 0: done, nothing is slower; 1: something is; 2: it could not be judged.)";

}  // namespace

std::function<int(std::ostream&, nlohmann::ordered_json&)> add_bench_command(CLI::App& app) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command = app.add_subcommand("bench", "Time everything beside the error that it buys");
  command->add_option("--program", options->program, "program of Google Benchmark")->capture_default_str();
  command->add_option("--output", options->output, "folder for timings and the page")->capture_default_str();
  command->add_option("--filter", options->filter, "benchmarks whose names fit this regular expression");
  command->add_flag("--quick", options->quick, "a small speed-error plane");
  command->add_option("--accuracy-data", options->accuracy_data,
                      "write what `solve --accuracy` picks by, from this plane, to this file (TOML)");
  CLI::Option* const against =
      command->add_option("--against", options->against, "the same program of another build: the base");
  CLI::Option* const pair =
      command->add_option("--pair", options->pair, "two benchmarks, the second over the first")->expected(2);
  CLI::Option* const baselines =
      command->add_option("--baselines", options->baselines, "folder that remembers times by machine");
  command
      ->add_option("--renew", options->renew,
                   "remember this build's times in that folder; the reason, in a sentence")
      ->needs(baselines);
  command->add_flag("--machine", options->machine, "print what this machine is called there, and stop");
  command->add_option("--rounds", options->rounds, "repetitions of what is compared")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command->add_option("--effect", options->effect, "smallest change that counts, as a part")
      ->check(CLI::Range(0.001, 1.0))
      ->capture_default_str();
  against->excludes(pair)->excludes(baselines);
  pair->excludes(baselines);
  command->footer(kFooter);
  return
      [options](std::ostream& text, nlohmann::ordered_json& result) { return run(*options, text, result); };
}

}  // namespace slipstick::bench
