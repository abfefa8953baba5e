#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <ostream>

#include "bench/commands.hpp"
#include "convergence/programs/package_module.hpp"
#include "convergence/results/markup.hpp"
#include "convergence/results/output.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"

namespace slipstick::bench {
namespace {

using namespace convergence;

struct CompareRequest {
  std::string base;
  std::string now;
  std::string effect = "10%";
  double level = 0.01;
  bool same_machine = false;
  bool debug_library = false;
  std::string summary;
  std::string junit;
};

std::string read_timings(const std::string& file) {
  constexpr const char* kAllowed =
      "what Google Benchmark (--benchmark_format=json), pytest-benchmark (--benchmark-json) or hyperfine "
      "(--export-json) writes";
  std::string text = solver::read_input_file(file, solver::kLargestJson, kAllowed);
  if (as_utf8(text) == text) return text;
  throw solver::InputError(file, fmt::format("is not JSON (bytes that are not UTF-8); allowed: {}", kAllowed));
}

int run_compare(const CompareRequest& request, std::ostream& text, Json& result) {
  require_output("--summary", request.summary);
  require_output("--junit", request.junit);
  const ModuleAnswer answer = run_package_module("speed.compare", {{"base", request.base},
                                                                   {"new", request.now},
                                                                   {"base_text", read_timings(request.base)},
                                                                   {"new_text", read_timings(request.now)},
                                                                   {"effect", request.effect},
                                                                   {"level", request.level},
                                                                   {"same_machine", request.same_machine},
                                                                   {"debug_library", request.debug_library}});
  result = answer.result;
  text << answer.text;
  append_option_file("--summary", request.summary, answer.rest.at("markdown"));
  write_option_file("--junit", request.junit, answer.rest.at("junit"));
  return answer.exit_code;
}

constexpr const char* kCompareFooter = R"(Example:
  slipstick compare base.json new.json --junit times.xml
  new.json against base.json, as independent runs
    benchmark     base       new  new/base   95 % interval  verdict
    solve/256  61.2 ms   73.4 ms     1.199  1.187 to 1.212  slower (p 3e-06)
    solve/128  14.1 ms   14.2 ms     1.004  0.997 to 1.011  same
  2 benchmarks: 1 same, 1 slower
Both files are of Google Benchmark (--benchmark_out=FILE), pytest-benchmark (--benchmark-json=FILE) or hyperfine
(--export-json FILE), with 10 repetitions or so. Run the two builds in turn, on an idle machine.
Exit code 0: nothing is slower; 1: a benchmark is slower, or fails in the new file alone; 2: it could not be judged:
a benchmark is in one file only, failed before, has too few repetitions or is as much slower as counts without being
so significantly; or the machines differ, were loaded, or the builds are debug builds: then no time is judged.)";

}  // namespace

RunCommand add_compare_command(CLI::App& app) {
  const auto request = std::make_shared<CompareRequest>();
  CLI::App* const command =
      app.add_subcommand("compare", "Compare two files of benchmarks' times: is anything slower?");
  command->add_option("base", request->base, "JSON of the build to compare with")->required();
  command->add_option("new", request->now, "JSON of the build in question")->required();
  command->add_option("--effect", request->effect, "smallest change that counts, as 10% or 0.10")
      ->capture_default_str();
  command->add_option("--level", request->level, "chance of a false alarm, over all benchmarks together")
      ->capture_default_str();
  command->add_flag("--same-machine", request->same_machine, "whatever the files say, it is one machine");
  command->add_flag("--debug-library", request->debug_library,
                    "only Google Benchmark's library is a debug build, the programs are not");
  command->add_option("--summary", request->summary,
                      "add a Markdown table, the worst first, below 64 kB, to this file");
  command->add_option("--junit", request->junit, "write JUnit XML, as CI servers read it, to this file");
  command->footer(kCompareFooter);
  return [request](std::ostream& text, Json& result) { return run_compare(*request, text, result); };
}

}  // namespace slipstick::bench
