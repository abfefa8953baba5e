#include "convergence/exchange/program_solve.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <utility>

#include "convergence/exchange/exchange_files.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/results/json_text.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

using solver::Scene;

/// A field whose errors are larger belongs to another scene. Coarse meshes are off by a hundredth. The gap is
/// not limited: it depends on the discretisation.
constexpr solver::CertificateBounds kSameLoads{
    .gap = std::numeric_limits<double>::infinity(), .moment = 0.05, .force = 0.05, .friction_bound = 0.05};

/// The largest count of iterations that is taken seriously.
constexpr double kMaxIterations = 1e9;

/// The scene under loads in N and N m.
Scene under_given_loads(Scene scene, double limit) {
  solver::Step& step = scene.steps.front();
  if (const auto ratio = solver::value_if<solver::MomentRatio>(step.torsion)) {
    step.torsion = solver::Moment{*ratio * limit};
  }
  return scene;
}

/// The scene's normal contact only.
Scene normal_contact_of(Scene scene) {
  solver::Step& step = scene.steps.front();
  step.torsion = solver::Moment{0.0};
  step.force = {};
  step.displacement.reset();
  scene.contact.coupling = solver::Coupling::none;
  return scene;
}

}  // namespace

ProgramAnswer solve_by_program(const Scene& scene, const AllowedPrograms& allowed) {
  const SolverProgram program = read_solver_program(scene.solver.program);
  const auto ratio = solver::value_if<solver::MomentRatio>(scene.steps.front().torsion);
  const bool by_ratio = ratio.value_or(0.0) != 0.0;
  const PosedScene posed = pose(scene, by_ratio);
  ProgramAnswer answer{
      .scene = under_given_loads(scene, posed.moment_limit), .exact = {}, .solution = {}, .program = {}};

  const TemporaryFolder folder;
  const ExchangeFiles files{folder / "scene.json", folder / "field.csv", folder / "numbers.json"};
  write_exchange(program, files, answer.scene, posed);
  const auto start = std::chrono::steady_clock::now();
  const ProgramEnd end = run_solver_program(program, files, allowed.tied_by);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const ReadFields read = read_exchange(program, files, answer.scene, posed);
  const OwnNumbers own = read_own_numbers(program, files);

  if (!read.tractions) answer.scene = normal_contact_of(std::move(answer.scene));
  answer.exact = find_oracle(read.tractions ? scene : answer.scene);
  answer.solution = describe_given(answer.scene, read.fields);
  const std::string off = solver::violated_bounds(answer.solution.certificate, kSameLoads);
  if (read.tractions && !off.empty()) {
    answer.solution.status = solver::Status::not_converged;
    answer.solution.message = off + ": no answer to these loads, although " + program.name + " returned it";
  }
  if (!own.converged.value_or(true)) {
    answer.solution.status = solver::Status::not_converged;
    answer.solution.message =
        own.message.empty() ? program.name + " says that it did not converge" : own.message;
  }
  const double said = own.seconds.value_or(wall);
  const double seconds = said >= 0.0 && said <= wall ? said : wall;
  answer.solution.seconds = {.traction = seconds, .total = seconds};
  answer.solution.iterations =
      static_cast<int>(std::clamp(own.iterations.value_or(0.0), 0.0, kMaxIterations));
  answer.program = {.name = program.name,
                    .file = program.file.string(),
                    .version = allowed.version ? *allowed.version : version_of(program, allowed.tied_by),
                    .fields = read.tractions ? "pressure and tractions" : "pressure",
                    .wall_seconds = wall,
                    .cpu_seconds = end.cpu_seconds,
                    .own = own};
  return answer;
}

}  // namespace slipstick::convergence
