#include "bench/work/work_counts_cases.hpp"

#include <fmt/core.h>

#include <Eigen/Core>
#include <filesystem>

#include "convergence/runs/path_uncertainty.hpp"
#include "solver/elasticity/law/half_spaces.hpp"
#include "solver/elasticity/linear_operator.hpp"
#include "solver/solve.hpp"

namespace slipstick::bench {
namespace {

using Work = std::function<SolveWork()>;

WorkCase solve_case(const std::string& name, const std::string& scene_name,
                    const std::vector<std::string>& overrides) {
  return {name, [=]() -> Work {
            const auto file = std::filesystem::path(SLIPSTICK_SCENES) / (scene_name + ".toml");
            return [name, scene = solver::read_scene(file, overrides)] {
              const solver::Solution solution = convergence::solve_with_path(scene);
              if (solution.status != solver::Status::converged) {
                throw std::runtime_error(fmt::format("{}: {}", name, solution.message));
              }
              return SolveWork{solution.operator_applications, solution.pressure_applications,
                               solution.iterations};
            };
          }};
}

std::unique_ptr<solver::LinearOperator> make_operator(solver::Index cells) {
  const solver::HalfSpaces law(solver::elastic_pair({2.0, 0.3}, {2.0, 0.3}));
  return solver::make_operator(solver::OperatorKind::dcfft, {cells, cells, 1.0, 1.0},
                               solver::tangential_kernel(), law);
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

}  // namespace

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

CaseCounts count_work(const WorkCase& work_case) {
  work_case.prepare()();
  const Work work = work_case.prepare();
  const WorkCounts before = work_counts();
  const SolveWork done = work();
  return {done, work_counts() - before};
}

}  // namespace slipstick::bench
