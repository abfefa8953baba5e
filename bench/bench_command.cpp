#include <fmt/chrono.h>
#include <fmt/core.h>
#include <CLI/CLI.hpp>

#include <ctime>
#include <memory>
#include <ostream>

#include "bench/commands.hpp"
#include "bench/plane/speed_error.hpp"
#include "convergence/hard/hard_run.hpp"
#include "convergence/programs/package_module.hpp"
#include "convergence/programs/python_script.hpp"
#include "convergence/report/scene_cost.hpp"
#include "convergence/results/json_text.hpp"
#include "convergence/results/output.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/runs/run_options.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/system/machine.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::bench {
namespace {

using Json = nlohmann::ordered_json;
namespace fs = std::filesystem;

/// The default filter of a comparison: each part and the whole at two sizes, small enough for many rounds.
constexpr const char* kCompared =
    "^(application/(direct|dcfft[a-z_]*)|influence/tangential|setup/dcfft[a-z_]*|normal/solve|solve/[a-z_]+)"
    "/cells:(64|256)(/permille:900)?$|^exact/.*/hertz$";
/// A survey's length of one run, with repetitions for intervals.
constexpr double kSurveySeconds = 0.02;
constexpr int kSurveyRepetitions = 7;

struct BenchRequest {
  std::string scene;
  std::vector<std::string> overrides;
  std::vector<std::string> beside;
  std::string program = SLIPSTICK_BENCHMARK_PROGRAM;
  std::string output = "build/benchmarks";
  std::string filter;
  std::string accuracy_data;
  std::string against;
  std::vector<std::string> pair;
  int rounds = 16;
  double effect = 0.10;
  bool quick = false;
};

/// Writes the file from which `solve --accuracy` picks mesh and tolerance. plane: judged.
void keep_accuracy_data(const std::string& file, const Json& plane) {
  const std::string origin =
      fmt::format("Measured by slipstick bench on {}, {:%Y-%m-%d}.",
                  plane.at("provenance").at("cpu").get<std::string>(), fmt::gmtime(std::time(nullptr)));
  const Json request{{"what", "accuracy"}, {"plane", plane}, {"origin", origin}};
  convergence::write_option_file("--accuracy-data", file, convergence::run_package_module("speed.plane", request).text);
}

/// Runs a program of Google Benchmark; `what` and further keys are the module's.
convergence::ModuleAnswer run_benchmarks(const BenchRequest& request, Json what) {
  what["program"] = request.program;
  what["starter"] = convergence::own_program_file().string();
  return convergence::run_package_module("speed.programs", what);
}

/// Times parts of the solver by the program of Google Benchmark, and writes timings and how they grow.
void time_parts(const BenchRequest& request, const fs::path& data, std::ostream& text, Json& result) {
  const convergence::ModuleAnswer timed = run_benchmarks(request, {{"what", "survey"},
                                                                   {"filter", request.filter},
                                                                   {"seconds", kSurveySeconds},
                                                                   {"repetitions", kSurveyRepetitions},
                                                                   {"folder", (data / "finished").string()}});
  result = timed.result;
  convergence::write_json_file(data / "timings.json", result);
  convergence::write_json_file(data / "scaling.json", timed.rest.at("scaling"));
  text << timed.text;
}

/// Everything, one after the other, and the page. A wheel has no program of Google Benchmark: there only
/// whole solves are timed.
int survey(const BenchRequest& request, std::ostream& text, Json& result) {
  const fs::path folder = request.output;
  const fs::path data = folder / "data";
  convergence::require_output("--accuracy-data", request.accuracy_data);
  if (request.program.empty()) {
    for (const char* old : {"timings.json", "scaling.json"}) fs::remove(data / old);
  } else {
    time_parts(request, data, text, result);
  }
  const Json plane = measure_plane({.scene = convergence::project_file("convergence/scenes/paper.toml"),
                                    .output = data / "finished",
                                    .quick = request.quick});
  const convergence::ModuleAnswer judged =
      convergence::run_package_module("speed.plane", {{"what", "judge"}, {"plane", plane}});
  convergence::write_json_file(data / "plane.json", judged.result);
  if (request.program.empty()) result = judged.result;
  if (!request.accuracy_data.empty()) keep_accuracy_data(request.accuracy_data, judged.result);
  convergence::run_report_script("speed_page.py", {"--output=" + folder.string(), "--", data},
                                 "the timings are in " + data.string());
  text << judged.text << "page: " << (folder / "index.html").string() << '\n';
  return 0;
}

/// Two builds or two methods in interleaved pairs.
int compare_ab(const BenchRequest& request, std::ostream& text, Json& result) {
  const bool builds = request.pair.empty();
  const fs::path folder = request.output;
  solver::make_folder(folder);
  solver::require_writable(folder);
  Json what{{"what", builds ? "builds" : "methods"}, {"rounds", request.rounds}, {"effect", request.effect}};
  if (builds) {
    what["base"] = request.against;
    what["filter"] = request.filter.empty() ? kCompared : request.filter;
  } else {
    what["base"] = request.pair[0];
    what["now"] = request.pair[1];
  }
  const convergence::ModuleAnswer found = run_benchmarks(request, what);
  const Json& files = found.rest.at("files");
  convergence::write_json_file(folder / "base.json", files[0]);
  convergence::write_json_file(folder / "new.json", files[1]);
  convergence::write_json_file(folder / "comparison.json", found.result);
  result = files[1];
  text << found.text;
  return found.exit_code;
}

/// One scene: methods, meshes, direct sums against convolution, other programs.
int time_scene(const BenchRequest& request, std::ostream& text, Json& result) {
  const fs::path folder = request.output;
  convergence::RunOptions runs{.output = folder / "points", .overrides = request.overrides};
  std::vector<convergence::BesideMethod> beside;
  for (const std::string& file : request.beside) {
    beside.push_back(convergence::read_beside_method(file));
    runs.overrides.push_back(beside.back().override);
  }
  const convergence::ProcessPool pool = runs.pool();
  convergence::SceneCosts costs;
  {
    const convergence::Interrupts interrupts;
    costs = convergence::scene_costs(
        {.scene = request.scene, .overrides = request.overrides},
        convergence::page_size(request.quick ? convergence::Effort::quick : convergence::Effort::usual), beside,
        folder / "data", pool);
  }
  result = convergence::to_json(costs);
  text << convergence::costs_text(costs);
  return 0;
}

int run_bench(const BenchRequest& request, std::ostream& text, Json& result) {
  if (!request.scene.empty()) return time_scene(request, text, result);
  const bool is_ab = !request.against.empty() || !request.pair.empty();
  return is_ab ? compare_ab(request, text, result) : survey(request, text, result);
}

constexpr const char* kBenchFooter = R"(Example:
  slipstick bench                                    everything, and the page build/benchmarks/index.html
  slipstick bench convergence/scenes/ellipse.toml    one scene: methods, meshes, direct sums against DC-FFT
  slipstick bench --against ../before/build/bench/slipstick_benchmarks
                                                     is this build slower than that one?
  slipstick bench --pair application/direct/cells:64 application/dcfft/cells:64
                                                     two methods, one over the other
Two builds or methods are timed in interleaved pairs; what is at least 10 % slower is timed once more before it is
called so. Finished timings of a survey are kept: an interrupted command goes on from there.
Exit code 0: done, nothing is slower; 1: something is; 2: it could not be judged.)";

}  // namespace

RunCommand add_bench_command(CLI::App& app) {
  const auto request = std::make_shared<BenchRequest>();
  CLI::App* const command = app.add_subcommand("bench", "Time methods and meshes, with the error of each");
  CLI::Option* const scene = command->add_option("scene", request->scene,
                                                 "scene file (TOML) to time: methods, "
                                                 "meshes, tolerances, direct sums against convolution");
  convergence::add_set_option(*command, request->overrides, "override a key of the scene");
  command->add_option("--beside", request->beside, "files of other programs (TOML), timed on the scene too")
      ->delimiter(',')
      ->needs(scene);
  command->add_option("--program", request->program, "program of Google Benchmark")->capture_default_str();
  command->add_option("--output", request->output, "folder for timings and the page")->capture_default_str();
  command->add_option("--filter", request->filter, "benchmarks whose names fit this regular expression");
  command->add_flag("--quick", request->quick, "a small speed-error plane");
  command->add_option("--accuracy-data", request->accuracy_data,
                      "write what `solve --accuracy` picks by, from this plane, to this file (TOML)");
  CLI::Option* const against =
      command->add_option("--against", request->against, "the same program of another build: the base");
  CLI::Option* const pair =
      command->add_option("--pair", request->pair, "two benchmarks, the second over the first")->expected(2);
  command->add_option("--rounds", request->rounds, "repetitions of each compared benchmark")
      ->check(CLI::Range(2, 1000))
      ->capture_default_str();
  command->add_option("--effect", request->effect, "smallest change that counts, as a part")
      ->check(CLI::Range(0.001, 1.0))
      ->capture_default_str();
  against->excludes(pair);
  for (CLI::Option* const other : {against, pair}) other->excludes(scene);
  command->footer(kBenchFooter);
  return [request](std::ostream& text, Json& result) { return run_bench(*request, text, result); };
}

}  // namespace slipstick::bench
