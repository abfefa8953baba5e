// Counts the work of solves and their parts and prints it as JSON, which gates read.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "bench/work/work_counts_cases.hpp"
#include "bench/work/work_counts_instructions.hpp"
#include "convergence/results/output.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/system/machine.hpp"
#include "solver/input/whole_file.hpp"

namespace {

using namespace slipstick::bench;
using slipstick::convergence::Json;

struct Options {
  std::string json = "-";
  std::vector<std::string> only;
  bool instructions = false;
  std::string to_do;
};

std::vector<WorkCase> selected_cases(const std::vector<std::string>& names) {
  const std::vector<WorkCase> all = work_cases();
  if (names.empty()) return all;
  std::vector<WorkCase> selected;
  for (const std::string& name : names) {
    const auto found = std::ranges::find(all, name, &WorkCase::name);
    if (found == all.end()) {
      std::string allowed;
      for (const WorkCase& known : all) allowed += (allowed.empty() ? "" : ", ") + known.name;
      throw std::invalid_argument(fmt::format("there is no {}; allowed: {}", name, allowed));
    }
    selected.push_back(*found);
  }
  return selected;
}

Json case_json(const CaseCounts& found) {
  const WorkCounts& counts = found.counts;
  return {{"applications", found.solve.applications},
          {"pressure_applications", found.solve.pressure_applications},
          {"iterations", found.solve.iterations},
          {"plans", counts.plans},
          {"transforms", counts.transforms},
          {"transformed_points", counts.transformed_points},
          {"allocations", counts.allocations},
          {"allocated_bytes", counts.allocated_bytes},
          {"kernel_evaluations", counts.kernel_evaluations}};
}

Json instructions_json(const Instructions& instructions, const std::string& program) {
  Json json{{"total", 0L}, {"program", 0L}, {"libraries", Json::object()}};
  long total = 0;
  for (const auto& [object, count] : instructions) {
    total += count;
    (object == program ? json["program"] : json["libraries"][object]) = count;
  }
  json["total"] = total;
  return json;
}

void add_instructions(Json& counts, const std::vector<WorkCase>& cases, bool wanted) {
  const std::filesystem::path program = slipstick::convergence::own_program_file();
  const auto found = wanted ? run_callgrind(program, cases) : std::nullopt;
  for (const WorkCase& work_case : cases) {
    Json& json = counts[work_case.name];
    if (found) {
      json["instructions"] = instructions_json(found->at(work_case.name), program.filename());
    } else {
      slipstick::convergence::set_missing(
          json, "instructions",
          wanted ? "valgrind is not installed" : "counted with --instructions, by valgrind");
    }
  }
}

void write(const std::string& path, const Json& result) {
  const std::string text = result.dump(2) + "\n";
  if (path == "-") return slipstick::convergence::write_standard_output(text);
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  if (!folder.empty()) slipstick::solver::make_folder(folder);
  slipstick::convergence::write_option_file("--json", path, text);
}

void run(const Options& options) {
  if (!options.to_do.empty()) {
    do_case(selected_cases({options.to_do}).front());
    return;
  }
  const std::vector<WorkCase> cases = selected_cases(options.only);
  Json result;
  for (const WorkCase& work_case : cases) result["counts"][work_case.name] = case_json(count_work(work_case));
  add_instructions(result["counts"], cases, options.instructions);
  result["provenance"] = slipstick::convergence::provenance(1);
  write(options.json, result);
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{"Counts the work that solves and their parts take"};
  app.add_option("--json", options.json, "write the counts to this file (- is stdout)")
      ->capture_default_str();
  app.add_option("--only", options.only, "only these cases");
  app.add_flag("--instructions", options.instructions, "count instructions too, by valgrind's callgrind");
  app.add_option("--do", options.to_do,
                 "do this case's work once without counting, to be run under valgrind");
  app.footer("Example:\n  slipstick_work --instructions --json work.json");
  CLI11_PARSE(app, argc, argv);
  try {
    run(options);
  } catch (const std::exception& error) {
    std::cerr << "slipstick_work: " << error.what() << '\n';
    return 2;
  }
}
