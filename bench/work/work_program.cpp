// slipstick_work: counts the work of solves and their parts and prints it as JSON. count_work.py adds the
// instructions, which valgrind counts while this program does one case.

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <filesystem>
#include <functional>
#include <iostream>
#include <nlohmann/json.hpp>

#include "bench/work/work_counts.hpp"
#include "convergence/results/output.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/path_uncertainty.hpp"
#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/elasticity/linear_operator.hpp"
#include "solver/solve.hpp"

namespace {

using namespace slipstick;
using bench::WorkCounts;
using convergence::Json;

/// The work that a solve reports; zeros for a case that is no solve.
struct SolveWork {
  double applications = 0.0;  ///< of the tangential operator, all grids converted to applications on the finest
  double pressure_applications = 0.0;  ///< of the normal operator, converted in the same way
  int iterations = 0;
};

using Work = std::function<SolveWork()>;

/// A piece of work whose counts are known.
struct WorkCase {
  std::string name;
  std::function<Work()> prepare;  ///< reads and makes what is not counted, and returns what is
};

WorkCase solve_case(const std::string& name, const std::string& scene_name, const std::vector<std::string>& overrides) {
  return {name, [=]() -> Work {
            const auto file = std::filesystem::path(SLIPSTICK_SCENES) / (scene_name + ".toml");
            return [name, scene = solver::read_scene(file, overrides)] {
              const solver::Solution solution = convergence::solve_with_path(scene);
              if (solution.status != solver::Status::converged) {
                throw std::runtime_error(fmt::format("{}: {}", name, solution.message));
              }
              return SolveWork{solution.operator_applications, solution.pressure_applications, solution.iterations};
            };
          }};
}

std::unique_ptr<solver::LinearOperator> make_operator(solver::Index cells) {
  const solver::HalfSpaces law(solver::elastic_pair({2.0, 0.3}, {2.0, 0.3}));
  return solver::make_operator(solver::OperatorKind::dcfft, {cells, cells, 1.0, 1.0}, solver::tangential_kernel(), law);
}

/// The tangential operator's coefficients and their transforms.
WorkCase setup_case(const std::string& name, solver::Index cells) {
  return {name, [cells]() -> Work {
            return [cells] {
              make_operator(cells);
              return SolveWork{};
            };
          }};
}

/// Tractions to displacements, once.
WorkCase application_case(const std::string& name, solver::Index cells) {
  return {name, [cells]() -> Work {
            const std::shared_ptr<solver::LinearOperator> op = make_operator(cells);
            const Eigen::ArrayXd traction = Eigen::ArrayXd::Ones(2 * op->grid().cells());
            return [op, traction, displacement = Eigen::ArrayXd(traction.size())]() mutable {
              op->apply(traction, displacement);
              return SolveWork{.applications = 1.0};
            };
          }};
}

/// Scenes on one thread that take less than a second, and parts of a solve.
std::vector<WorkCase> work_cases() {
  const std::string full = "solver.model=full";
  return {
      solve_case("paper-64-auto", "paper", {"grid.cells=[64,64]"}),
      solve_case("paper-64-full", "paper", {"grid.cells=[64,64]", full}),
      solve_case("paper-128-auto", "paper", {"grid.cells=[128,128]"}),
      solve_case("paper-128-full", "paper", {"grid.cells=[128,128]", full}),
      solve_case("hertz-128", "paper", {"grid.cells=[128,128]", "contact.pressure=hertz"}),
      solve_case("ellipse-64", "ellipse", {"grid.cells=[64,32]"}),
      solve_case("force-64", "mindlin", {"grid.cells=[64,64]"}),
      solve_case("dense-16", "paper", {"grid.cells=[16,16]", full, "solver.operator=dense"}),
      solve_case("direct-16", "paper", {"grid.cells=[16,16]", full, "solver.operator=direct"}),
      setup_case("setup-64", 64),
      application_case("application-64", 64),
  };
}

/// Does it once before, so that what is made at first use and kept is not counted.
Json counted(const WorkCase& work_case) {
  work_case.prepare()();
  const Work work = work_case.prepare();
  const WorkCounts before = bench::work_counts();
  const SolveWork done = work();
  const WorkCounts counts = bench::work_counts() - before;
  Json json{{"applications", done.applications},
            {"pressure_applications", done.pressure_applications},
            {"iterations", done.iterations},
            {"plans", counts.plans},
            {"transforms", counts.transforms},
            {"transformed_points", counts.transformed_points},
            {"allocations", counts.allocations},
            {"allocated_bytes", counts.allocated_bytes},
            {"kernel_evaluations", counts.kernel_evaluations}};
  convergence::set_missing(json, "instructions", "counted by count_work.py, with valgrind");
  return json;
}

/// The function in which callgrind counts.
[[gnu::noinline]] void do_counted_work(const Work& work) { work(); }

void run(const std::vector<std::string>& only, const std::string& to_do) {
  Json result;
  for (const WorkCase& work_case : work_cases()) {
    const bool chosen = only.empty() || std::ranges::find(only, work_case.name) != only.end();
    if (work_case.name == to_do) return do_counted_work(work_case.prepare());
    if (to_do.empty() && chosen) result["counts"][work_case.name] = counted(work_case);
  }
  result["provenance"] = convergence::provenance(1);
  convergence::write_standard_output(result.dump(2) + "\n");
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> names;
  for (const WorkCase& work_case : work_cases()) names.push_back(work_case.name);
  std::vector<std::string> only;
  std::string to_do;
  CLI::App app{"Counts the work that solves and their parts take, as JSON"};
  app.add_option("--only", only, "only these cases")->check(CLI::IsMember(names));
  app.add_option("--do", to_do, "do this case's work once without counting, to be run under valgrind")
      ->check(CLI::IsMember(names));
  CLI11_PARSE(app, argc, argv);
  try {
    run(only, to_do);
  } catch (const std::exception& error) {
    std::cerr << "slipstick_work: " << error.what() << '\n';
    return 2;
  }
}
