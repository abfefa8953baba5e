#include "solver/solve.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/contact/full_coupling.hpp"
#include "solver/elasticity/random_rounding.hpp"
#include "solver/grid/threads.hpp"
#include "solver/history/history_state.hpp"
#include "solver/history/load_parts.hpp"
#include "solver/input/input_error.hpp"
#include "solver/load_path.hpp"
#include "solver/model/make_model.hpp"
#include "solver/model/memory_plan.hpp"
#include "solver/model/within_double.hpp"
#include "solver/step/describe_step.hpp"
#include "solver/step/grid_edge.hpp"
#include "solver/step/pressure.hpp"
#include "solver/step/resolution.hpp"
#include "solver/step/tractions.hpp"

namespace slipstick::solver {
namespace {

using Eigen::ArrayXd;

/// Rounding of a sum over a million cells, relative to the sum of sizes.
constexpr double kSumRounding = 1e-12;
/// Rounding of the duality gap, in which sums cancel, relative to the energy.
constexpr double kGapRounding = 1e-13;

/// The bounds that a result's certificate must keep. The paper's method stops on change, Eq. (26), and
/// freezes slip directions: it promises no gap. Loads and friction bounds are met to the tolerance, or to
/// rounding. The other methods have stopped on the gap of the part of the grid that they solved; the whole
/// grid's differs by rounding.
CertificateBounds promised(const Scene& scene) {
  const double loads = std::max(scene.tolerance, kSumRounding);
  const double gap = scene.method == Method::paper ? std::numeric_limits<double>::infinity()
                                                   : scene.tolerance + kGapRounding;
  return {.gap = gap, .moment = loads, .force = loads, .friction_bound = loads};
}

RigidMotion moved(const RigidMotion& before, const TangentialSolution& tangential) {
  return {before.delta1 + tangential.displacement[0], before.delta2 + tangential.displacement[1],
          before.twist + tangential.twist};
}

/// ContactState's slip after a step that is not the first.
ArrayXd slip_onwards(const ContactState& before, const ArrayXd& pressure,
                     const TangentialSolution& tangential) {
  if ((pressure > 0.0 && before.pressure == 0.0).any()) return {};
  if (before.slip.size() == 0) return tangential.slip;
  const ArrayXd onwards =
      (tangential.stick == 0.0 && dot_products(before.slip, tangential.slip) > 0.0).cast<double>();
  return tangential.slip + onwards.replicate(2, 1) * before.slip;
}

/// Pressure and tractions, each under the other.
LoadStep solve_coupled(ModelSolution& solution, const Scene& scene, const Step& step,
                       const ContactState& state, const Progress& progress) {
  const Model& model = solution.model;
  const Reduction whole(model.grid);
  LoadStep loads;
  solution.operator_applications = solution.pressure_applications = 0.0;
  const CoupledProblem problem{
      .gap = model.gap,
      .traction = state.traction.size() > 0 ? state.traction : ArrayXd::Zero(2 * model.grid.cells()),
      .tolerance = scene.tolerance,
      .friction_bound = [&](const ArrayXd& pressure) { return model.friction.bound(pressure); },
      .solve_pressure =
          [&](const ArrayXd& opening, const StaggeredTarget& goal) {
            NormalSolution normal = find_pressure(scene, model, step, opening, goal, progress);
            solution.pressure_applications += finest_grid_applications(normal.grids);
            solution.safeguards += normal.safeguards;
            return normal;
          },
      .solve_tractions =
          [&](const ArrayXd& pressure, const StaggeredTarget& goal) {
            loads = load_step(scene, model, step, pressure, state);
            if (goal.gap > 0.0 && !loads.carried()) return TangentialSolution{};
            require_carried(scene, model, step, loads);
            TangentialSolution found =
                find_tractions(solution.model, scene, loads, pressure, state, progress, goal);
            solution.operator_applications += finest_grid_applications(found.grids);
            solution.safeguards += found.safeguards;
            return found;
          }};
  CoupledSolution coupled = solve_fully_coupled(elasticity(scene, model, whole), model.grid, problem);
  if (coupled.tangential.status == Status::converged) {
    require_contact_within_grid(scene, model, step, coupled.normal, coupled.tangential.traction);
  }
  solution.normal = std::move(coupled.normal);
  solution.tangential = std::move(coupled.tangential);
  solution.turns = coupled.turns;
  return loads;
}

LoadStep solve_in_sequence(ModelSolution& solution, const Scene& scene, const Step& step,
                           const Step* previous, const ContactState& state, const Progress& progress) {
  Stopwatch watch(solution.model.cache.get());
  solution.pressure_applications = 0.0;
  if (previous == nullptr || previous->normal != step.normal) {
    solution.normal = find_pressure(scene, solution.model, step, {}, {}, progress);
    solution.pressure_applications = finest_grid_applications(solution.normal.grids);
    solution.safeguards += solution.normal.safeguards;
    require_contact_within_grid(scene, solution.model, step, solution.normal);
  }
  solution.seconds.pressure = watch.lap();
  LoadStep loads = load_step(scene, solution.model, step, solution.normal.pressure, state);
  require_carried(scene, solution.model, step, loads);
  solution.tangential =
      find_tractions(solution.model, scene, loads, solution.normal.pressure, state, progress);
  solution.operator_applications = finest_grid_applications(solution.tangential.grids);
  solution.safeguards += solution.tangential.safeguards;
  solution.seconds.traction = watch.lap();
  return loads;
}

/// after: filled in, unless null.
void solve_step(ModelSolution& solution, const Scene& scene, const Step& step, const Step* previous,
                const ContactState& before, const Progress& progress, ContactState* after) {
  Stopwatch watch(solution.model.cache.get());
  const KeptRounding rounding;  // what draws its own
  const Model& model = solution.model;
  solution.safeguards = {};
  const LoadStep loads = model.shear_coupling && model.law->couples()
                             ? solve_coupled(solution, scene, step, before, progress)
                             : solve_in_sequence(solution, scene, step, previous, before, progress);
  const TangentialSolution& tangential = solution.tangential;
  const bool pressed = solution.pressure_applications > 0.0;
  const CandidateFraction parts{pressed ? solution.normal.part : 0.0, tangential.part};
  solution.predicted_bytes = predicted_memory(scene, model, parts).total();
  const RigidMotion motion = moved(before.motion, tangential);
  solution.loads = step;
  solution.twist_angle = motion.twist;
  solution.displacement = {motion.delta1 * model.length_unit, motion.delta2 * model.length_unit};
  const bool converged =
      solution.normal.status == Status::converged && tangential.status == Status::converged;
  solution.status = converged ? Status::converged : Status::not_converged;
  solution.message.clear();
  if (!solution.normal.message.empty()) solution.message = "pressure: " + solution.normal.message;
  if (!tangential.message.empty()) {
    solution.message += (solution.message.empty() ? "traction: " : "; traction: ") + tangential.message;
  }
  const ArrayXd onwards =
      previous != nullptr ? slip_onwards(before, solution.normal.pressure, tangential) : ArrayXd();
  const ArrayXd& slip = previous != nullptr ? onwards : tangential.slip;
  describe(solution, scene, loads, slip);
  OpenHistory open = before.open;
  open.add(before.end, end_of(solution), solution.resolution);
  solution.resolution.mesh = open.mesh();
  if (solution.status == Status::converged) {
    solution.message = violated_bounds(solution.certificate, promised(scene));
    if (!solution.message.empty()) solution.status = Status::not_converged;
  }
  if (after != nullptr) {
    *after = {solution.normal.pressure,
              tangential.traction,
              slip,
              motion,
              std::max(loads.problem.energy_before, solution.certificate.energy),
              end_of(solution),
              open};
  }
  if (solution.detail == Detail::all) {
    add_slip_without_friction(solution.tangential, scene, model, loads.problem.friction_bound,
                              solution.normal.pressure, before);
  }
  solution.seconds.total = solution.seconds.setup + watch.lap();
}

/// Takes the step before from a resumed history. Throws std::invalid_argument for a state of another scene.
void take_up(ModelSolution& solution, ContactState& state, const HistoryState& resumed, const Scene& scene) {
  const Index cells = solution.model.grid.cells();
  const ContactState& at = resumed.contact;
  if (resumed.finished == 0 ||
      resumed.finished >= scene.steps.size() * static_cast<std::size_t>(scene.cycles) ||
      at.pressure.size() != cells || at.traction.size() != 2 * cells ||
      (at.slip.size() != 0 && at.slip.size() != 2 * cells)) {
    throw std::invalid_argument("the state of a history is not one of this scene");
  }
  state = at;
  solution.normal = resumed.normal;
  solution.normal.pressure = at.pressure;
}

/// Hands on where the history stands.
void hand_on(const SolveOptions& options, std::size_t finished, ContactState& state,
             const NormalSolution& normal) {
  if (!options.on_state) return;
  HistoryState at{finished, std::move(state), normal};
  at.normal.pressure.resize(0);
  options.on_state(at);
  state = std::move(at.contact);
}

/// Numbers that add up over the parts of a step.
class Spent {
 public:
  explicit Spent(double setup) { seconds_.setup = setup; }
  void add(const Solution& part) {
    seconds_.pressure += part.seconds.pressure;
    seconds_.traction += part.seconds.traction;
    seconds_.total += part.seconds.total;
    for (std::size_t k = 0; k < kSummed.size(); ++k) sums_[k] += part.*kSummed[k];
  }
  void put(Solution& step) {
    seconds_.total += seconds_.setup;
    step.seconds = seconds_;
    for (std::size_t k = 0; k < kSummed.size(); ++k) step.*kSummed[k] = sums_[k];
  }

 private:
  static constexpr std::array kSummed{&Solution::dissipated, &Solution::work,
                                      &Solution::operator_applications, &Solution::pressure_applications};
  Seconds seconds_;
  std::array<double, kSummed.size()> sums_{};
};

/// A step that broke off in its k-th part says so, and no number of that part stands for its end.
void break_off(ModelSolution& solution, const Step& step, std::size_t k, std::size_t parts) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  solution.message = fmt::format("{}, part {} of {}: {}", step.key, k, parts, solution.message);
  solution.loads = step;
  for (double* const number : {&solution.twist_angle, &solution.moment, &solution.limit.factor,
                               &solution.elastic_energy, &solution.dissipated, &solution.work})
    *number = kUnknown;
  solution.displacement = solution.force = {kUnknown, kUnknown};
}

/// Step by step, until one does not converge. after_step may take the solution's fields where it is the last.
using AfterStep = std::function<void(ModelSolution& solution, bool last)>;
void solve_steps(const Scene& scene, const SolveOptions& options, const AfterStep& after_step) {
  std::shared_ptr<SolveCache> cache = options.cache;
  Stopwatch watch(cache.get());
  ModelSolution solution;
  solution.model = make_model(scene, options.ranks);
  const ThreadPool threads(solution.model.threads);
  const Memory memory = predicted_memory(scene, solution.model);
  solution.bytes = memory.solver;
  const bool repeats = scene.steps.size() > 1 || scene.cycles > 1 || solution.model.shear_coupling;
  if (!cache && repeats) cache = std::make_shared<SolveCache>();
  if (cache) {
    const double room = scene.memory_limit.value_or(std::numeric_limits<double>::infinity()) - memory.total();
    cache->begin_solve(scene.rounding_seed == 0 ? room : 0.0);  // rounding changes with every application
  }
  solution.model.cache = cache;
  solution.detail = options.detail;
  std::optional<PathUncertainty> path;
  if (options.detail == Detail::all) path.emplace(scene, solution.model);
  solution.seconds.setup = watch.lap();
  ContactState state;
  if (options.resumed) take_up(solution, state, *options.resumed, scene);
  const std::size_t of_cycle = scene.steps.size();
  const std::size_t all = of_cycle * static_cast<std::size_t>(scene.cycles);
  const std::size_t first = options.resumed ? options.resumed->finished : 0;
  for (std::size_t k = first; k < all; ++k) {
    const Step step = step_of(scene, k);
    const Step last_step = step_of(scene, k > 0 ? k - 1 : 0);
    const Step* previous = k > 0 ? &last_step : nullptr;
    const std::vector<Step> parts = parts_of(scene, step, previous, state.end);
    solution.cycle = static_cast<int>(k / of_cycle) + 1;
    const bool last = k + 1 == all;
    Spent spent(k == first ? solution.seconds.setup : 0.0);
    std::size_t of_step = 0;
    for (const Step& part : parts) {
      ++of_step;
      solution.seconds = {};
      const bool ends = last && &part == &parts.back();
      ContactState after;
      solve_step(solution, scene, part, previous, state, options.progress, ends ? nullptr : &after);
      spent.add(solution);
      if (solution.status != Status::converged) break;
      state = std::move(after);
      previous = &part;
    }
    spent.put(solution);
    if (of_step < parts.size()) break_off(solution, step, of_step, parts.size());
    if (path) solution.resolution.path = path->at(k);
    state_uncertainty(solution, scene, k);
    const bool failed = solution.status != Status::converged;
    if (last || failed) solution.model.cache = nullptr;
    after_step(solution, last || failed);
    if (failed) return;
    if (!last) hand_on(options, k + 1, state, solution.normal);
  }
}

/// Throws where an answer that was found without units leaves double precision in the scene's units.
void require_finite(const Solution& solution) {
  const bool finite = std::isfinite(solution.twist_angle) && std::isfinite(solution.moment) &&
                      solution.pressure.isFinite().all() && solution.traction.isFinite().all();
  if (solution.status == Status::converged && !finite) {
    throw std::domain_error("the answer in the scene's units");
  }
}

void require_can_solve(const Scene& scene) {
  validate(scene);
  if (scene.model == ModelChoice::exact) {
    throw InputError(scene.source.string(), "solver.model", "\"exact\"", "auto, full for a solve on a grid");
  }
  if (!scene.program.empty()) {
    throw InputError(scene.source.string(), "solver.program", scene.program.string(),
                     "left out: another program answers where the slipstick program runs it");
  }
}

}  // namespace

ModelSolution solve_in_model_units(const Scene& scene,
                                   const std::function<void(const ModelSolution&)>& on_step) {
  require_can_solve(scene);
  ModelSolution result;
  solve_steps(scene, {}, [&](ModelSolution& solution, bool last) {
    if (on_step) on_step(solution);
    if (last) result = std::move(solution);
  });
  return result;
}

Solution solve(const Scene& scene, const SolveOptions& options) {
  require_can_solve(scene);
  Solution result;
  within_double(scene, [&] {
    solve_steps(scene, options, [&](ModelSolution& solution, bool last) {
      if (!last && !options.on_step) return;
      result = in_si(last ? std::move(solution) : ModelSolution(solution));
      require_finite(result);
      if (options.on_step) options.on_step(result);
    });
  });
  return result;
}

}  // namespace slipstick::solver
