#include "convergence/check/examination.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include "convergence/oracle/errors.hpp"
#include "solver/contact/limit_load.hpp"
#include "solver/grid/grid_transfer.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Grid;
using solver::Index;
using solver::InputError;

/// Fine cells in a cell of the field, along each axis; the middle one has the same centre.
constexpr Index kChildren = 3;
constexpr double kChildrenOfCell = static_cast<double>(kChildren * kChildren);
/// Part of an exact pressure's load that samples at cell centres may miss. A larger part shows that the
/// pressure is infinite at an edge.
constexpr double kMissedLoad = 1e-2;
/// Standard deviation over |q| of the largest noise that a right field is allowed.
constexpr double kLargestNoise = 3e-3;
/// Random errors over what friction leaves sticking cells in the mean, by which they move no number that is judged.
/// Files with all digits of a double have less, unless nearly all cells slip: then the motion follows them.
constexpr double kUnseen = 1e-14;
/// Gap over energy to which the finer mesh is solved. It changes the errors of meshes of up to 512 cells by 1 %.
constexpr double kFinerTolerance = 1e-7;
/// Upper quartile of a normal distribution, in standard deviations.
constexpr double kQuartile = 0.6745;

/// Error of a pressure of constant cells, over the error of other right pressures.
constexpr double kConstantCells = 0.1;

/// One more cell on each side: a contact may cover parts of cells without reaching their centres.
Grid padded(const Grid& grid) { return {grid.n1 + 2, grid.n2 + 2, grid.h1, grid.h2}; }

Grid finer(const Grid& grid) { return solver::divided(grid, kChildren); }

/// The field on fine cells of the padded grid, constant in each of the field's cells.
ArrayXd on_fine_cells(const Grid& grid, const ArrayXd& values) {
  const Grid coarse = padded(grid);
  return solver::spread_to(finer(coarse), coarse, resized(grid, coarse, values));
}

/// A fine field, of one or several components, at the centres of the coarse cells.
ArrayXd sampled(const Grid& coarse, const ArrayXd& values) {
  const Grid fine = finer(coarse);
  const auto centres = Eigen::seq(kChildren / 2, Eigen::last, kChildren);
  ArrayXd result(values.size() / (kChildren * kChildren));
  for (Index c = 0; c * fine.cells() < values.size(); ++c) {
    result.segment(c * coarse.cells(), coarse.cells()) =
        values.segment(c * fine.cells(), fine.cells()).reshaped(fine.n2, fine.n1)(centres, centres).reshaped();
  }
  return result;
}

/// The exact pressure at the centres of a grid; none where they miss too much of its load.
std::optional<ArrayXd> exact_pressure(const Oracle& pressed, const GivenContact& contact, const Grid& grid,
                                      double load) {
  const ArrayXd x1 = solver::cell_x1(grid);
  const ArrayXd x2 = solver::cell_x2(grid);
  // On a cone's axis the pressure is infinite; the mean over a cell there is that a third of a cell away.
  const double nearest = 0.35 * std::min(grid.h1, grid.h2) * contact.length_unit;
  ArrayXd pressure(grid.cells());
  for (Index cell = 0; cell < grid.cells(); ++cell) {
    const double radius = pressed.radius(x1[cell] * contact.length_unit - pressed.place.centre[0],
                                         x2[cell] * contact.length_unit - pressed.place.centre[1]);
    pressure[cell] = pressed.pressure(std::max(radius, nearest)) / contact.stress_unit;
  }
  const double carried = pressure.sum() * grid.cell_area() * contact.force_unit();
  if (!(std::abs(carried / load - 1.0) <= kMissedLoad)) return std::nullopt;
  return pressure;
}

/// The right field under a pressure on the finer mesh, as near to the limit as the field's own loads are.
solver::TangentialSolution solve_finer(const GivenContact& contact, const solver::Step& load, const Grid& fine,
                                       ArrayXd pressure) {
  solver::TangentialProblem problem = own_problem(contact, load);
  const double own = solver::limit_of(problem, contact.grid).factor;
  problem.friction_bound = resampled(contact.friction, contact.grid, fine).bound(pressure);
  problem.initial_displacement = pressure_displacement(contact, fine, pressure);
  pressure.resize(0);  // large, and no more needed
  leave_out_translations(problem, fine, contact.traction);
  scale_loads(problem, kChildrenOfCell);
  const double limit = solver::limit_of(problem, fine).factor;
  problem.limit_factor = limit;
  if (std::isfinite(limit)) scale_loads(problem, solved_multiple(own) * limit / own);
  return solve_problem(contact, fine, std::move(problem), kFinerTolerance);
}

/// Loads that a field carries, about the grid's centre; areas are in the grid's units.
struct Sums {
  double normal, moment, force1, force2;
};

Sums sums_of(const Grid& grid, double total_pressure, const ArrayXd& traction) {
  const double area = grid.cell_area();
  return {area * total_pressure, area * (traction * solver::rotation_field(grid)).sum(),
          area * traction.head(grid.cells()).sum(), area * traction.tail(grid.cells()).sum()};
}

LoadErrors load_errors(const Sums& coarse, const Sums& fine, double friction) {
  return {.normal = std::abs(coarse.normal / fine.normal - 1.0),
          .moment = fine.moment == 0.0 ? 0.0 : std::abs(coarse.moment / fine.moment - 1.0),
          .force = std::hypot(coarse.force1 - fine.force1, coarse.force2 - fine.force2) / (friction * fine.normal)};
}

Grid field_grid_in_m(const GivenContact& contact, const Grid& grid) {
  return {grid.n1, grid.n2, grid.h1 * contact.length_unit, grid.h2 * contact.length_unit};
}

/// The scene's pressure on cells of the field's size, over the scene's whole grid.
struct WidePressure {
  Grid grid;  ///< contains the field's grid with a cell on each side
  ArrayXd values;
};

std::optional<WidePressure> wide_pressure(const GivenContact& contact, const solver::Scene& scene,
                                          const solver::Model& model) {
  WidePressure wide{padded(contact.grid), {}};
  auto values = scene_pressure(contact, scene, model, wide.grid);
  if (!values || !(values->sum() > 0.0)) return std::nullopt;
  wide.values = std::move(*values);
  return wide;
}

ArrayXd deviation_from(const ArrayXd& right, const ArrayXd& pressure) {
  return (pressure * (right.sum() / pressure.sum()) - right).abs();
}

/// The right pressure on a grid of fine cells: the exact one, otherwise the solved one if `solve` says so.
/// None where neither is known.
std::optional<ArrayXd> fine_pressure(const GivenContact& contact, const solver::Scene& scene,
                                     const solver::Model& model, const std::optional<Oracle>& pressed, const Grid& fine,
                                     bool solve) {
  if (const auto& normal = scene.steps.front().normal; pressed && normal) {
    if (auto exact = exact_pressure(*pressed, contact, fine, *normal)) return exact;
  }
  Grid same = fine;
  const auto solved = solve ? scene_pressure(contact, scene, model, same) : std::nullopt;
  return solved ? std::optional(resized(same, fine, *solved)) : std::nullopt;
}

/// Measures the errors of right fields on a contact's grid.
class MeshMeasurement {
 public:
  MeshMeasurement(const GivenContact& contact, const solver::Step& load, const Regions& regions, bool twist_reported)
      : contact_(contact), load_(load), grid_(padded(contact.grid)), twist_reported_(twist_reported) {
    regions_.inner = resized(contact.grid, grid_, regions.inner);
    const bool all = (regions.ring > 0.0).all();
    regions_.ring = all ? ArrayXd(ArrayXd::Ones(grid_.cells())) : resized(contact.grid, grid_, regions.ring);
    errors.pressures = errors.tractions = ArrayXd::Zero(contact.pressure.size());
  }

  /// Right pressures of the wide grid, against the one solved on its cells.
  void add_pressures(const WidePressure& wide, const ArrayXd& fine) {
    for (const ArrayXd& p : {sampled(wide.grid, fine), solver::restrict_to(wide.grid, finer(wide.grid), fine)}) {
      const ArrayXd off = deviation_from(wide.values, p);
      errors.deviation.pressure = std::max(errors.deviation.pressure, off.sum() / wide.values.sum());
      errors.pressures = errors.pressures.max(resized(wide.grid, contact_.grid, off));
    }
  }

  /// A right field whose program meant these loads and reported this twist.
  void add_field(ArrayXd p, ArrayXd q, const Sums& meant, double twist) {
    const GivenContact field = with_fields(contact_, grid_, std::move(p), std::move(q));
    const LoadErrors loads =
        load_errors(sums_of(grid_, field.pressure.sum(), field.traction), meant, contact_.mean_friction());
    errors.loads = {.normal = std::max(errors.loads.normal, loads.normal),
                    .moment = std::max(errors.loads.moment, loads.moment),
                    .force = std::max(errors.loads.force, loads.force)};
    const State fitted = find_state(field, known_motion(field, load_, std::nullopt));
    const State reported = twist_reported_ ? find_state(field, known_motion(field, load_, twist)) : fitted;
    const RightAnswer right = find_right_answer(field, load_);
    Deviation deviation = find_deviation(field, right, reported, fitted, regions_);
    deviation.pressure = errors.deviation.pressure;
    errors.deviation = larger(errors.deviation, deviation);
    errors.tractions =
        errors.tractions.max(resized(grid_, contact_.grid, solver::norms(field.traction - right.traction)));
    errors.direction = std::max(errors.direction, noticeable_direction(field, fitted, deviation.tractions).mean);
  }

  /// The exact answer shows an error that no finer mesh shows: its slip ring may be narrower than a cell.
  void add_exact(const Oracle& exact) {
    const ExactFields fields = exact_fields(exact, field_grid_in_m(contact_, grid_));
    const double carried = fields.pressure.sum() * grid_.cell_area() / contact_.stress_unit;
    const double normal = load_.normal.value_or(0.0) / contact_.force_unit();
    if (!(std::abs(carried / normal - 1.0) <= kMissedLoad) || !fields.traction.allFinite()) return;
    const bool torsion = exact.force == std::array<double, 2>{};
    add_field(fields.pressure / contact_.stress_unit, fields.traction / contact_.stress_unit,
              {normal, torsion ? exact.moment / contact_.moment_unit() : 0.0, exact.force[0] / contact_.force_unit(),
               exact.force[1] / contact_.force_unit()},
              exact.twist_angle);
  }

  MeshErrors errors;

 private:
  const GivenContact& contact_;
  const solver::Step& load_;
  Grid grid_;
  Regions regions_;
  bool twist_reported_;
};

/// Answers and choices that do not come from the field.
struct Known {
  std::optional<Oracle> pressed;  ///< the exact normal contact, about the grid's centre
  std::optional<Oracle> exact;    ///< the exact answer, about the grid's centre
  bool twist;                     ///< the program reported its twist; right fields then report theirs
  bool pressure;                  ///< the field's pressure is taken as given
};

MeshErrors measure_mesh(const GivenContact& contact, const solver::Scene& scene, const solver::Model& model,
                        const Regions& regions, const Known& known, const std::optional<WidePressure>& wide) {
  const solver::Step& load = scene.steps.front();
  const Grid grid = padded(contact.grid);
  const Grid fine = finer(grid);
  const Grid fine_whole = wide ? finer(wide->grid) : fine;
  MeshMeasurement measurement(contact, load, regions, known.twist);
  auto found = fine_pressure(contact, scene, model, known.pressed, fine_whole, wide.has_value());
  const bool is_known = found.has_value();
  ArrayXd pressure;
  if (is_known) {
    if (wide) measurement.add_pressures(*wide, *found);
    const double sum = found->sum();
    pressure = resized(fine_whole, fine, *std::exchange(found, std::nullopt));
    if (!(pressure.sum() >= (1.0 - kMissedLoad) * sum)) pressure.resize(0);
  }
  if (pressure.size() == 0) pressure = on_fine_cells(contact.grid, contact.pressure);
  MeshErrors& errors = measurement.errors;
  errors.moment_limit =
      solver::free_moment_limit(fine, resampled(contact.friction, contact.grid, fine).bound(pressure)) /
      kChildrenOfCell;
  ArrayXd at_centres = sampled(grid, pressure);
  ArrayXd means = restrict_to(grid, fine, pressure);
  const double total_pressure = pressure.sum();
  const solver::TangentialSolution solution = solve_finer(contact, load, fine, std::move(pressure));
  const Sums sums = sums_of(fine, total_pressure, solution.traction);
  measurement.add_field(std::move(at_centres), sampled(grid, solution.traction), sums, solution.twist);
  measurement.add_field(std::move(means), restrict_to(grid, fine, solution.traction), sums, solution.twist);
  if (wide && !is_known) {
    // A pressure that no finer mesh knows has the errors of its tractions, which end where it does.
    errors.deviation.pressure = errors.deviation.tractions;
    errors.pressures = errors.tractions / contact.mean_friction();
  }
  if (wide && known.exact && known.exact->shear) measurement.add_exact(*known.exact);
  return errors;
}

ScenePressure on_field(const GivenContact& contact, const WidePressure& wide) {
  const ArrayXd off = deviation_from(wide.values, resized(contact.grid, wide.grid, contact.pressure));
  return {.values = resized(wide.grid, contact.grid, wide.values),
          .deviation = resized(wide.grid, contact.grid, off),
          .off = off.sum() / wide.values.sum()};
}

/// Standard deviation of |q| that a field shows where it slips, for each cell: in parts of mu p or of the
/// largest mu p, whichever is more. Noisy values of |q| lie above mu p as often as below; a program that
/// keeps |q| <= mu p shows no noise.
ArrayXd noise_size(const GivenContact& contact, const RightAnswer& right) {
  const std::vector<Index> ring = slip_ring(contact, right);
  if (ring.empty()) return ArrayXd::Zero(contact.pressure.size());
  const ArrayXd size = solver::norms(contact.traction);
  const auto deviation = [&](const ArrayXd& scale) {
    std::vector<double> beyond;
    for (const Index cell : ring) beyond.push_back((size[cell] - contact.friction_bound[cell]) / scale[cell]);
    std::ranges::sort(beyond);
    const double upper = beyond[beyond.size() * 3 / 4];
    const double middle = beyond[beyond.size() / 2];
    return std::clamp(std::min(upper, upper - middle) / kQuartile, 0.0, kLargestNoise);
  };
  const ArrayXd largest = ArrayXd::Constant(size.size(), contact.friction_bound.maxCoeff());
  return (deviation(contact.friction_bound) * contact.friction_bound).max(deviation(largest) * largest) *
         (contact.friction_bound > 0.0).cast<double>();
}

/// The deviation of the right answer with random errors, whose standard deviation is given for each cell: the
/// larger one of a draw and its opposite.
Deviation disturbed(const GivenContact& contact, const RightAnswer& right, const Regions& regions,
                    const solver::Step& load, const ArrayXd& size) {
  const ArrayXd left = (contact.friction_bound - solver::norms(right.traction)).max(0.0);
  if (!(size.maxCoeff() > kUnseen * left.mean())) return {};
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  ArrayXd error(right.traction.size());
  for (Index k = 0; k < error.size(); ++k) error[k] = normal(random) * size[k % size.size()];
  Deviation worst;
  for (const double sign : {1.0, -1.0}) {
    const GivenContact field = with_fields(contact, contact.grid, contact.pressure, right.traction + sign * error);
    const State fitted = find_state(field, known_motion(field, load, std::nullopt));
    worst = larger(worst, find_deviation(field, right, fitted, fitted, regions));
  }
  return worst;
}

ReferenceOnGrid find_reference_on_grid(const GivenContact& contact, const solver::Scene& scene,
                                       const solver::Model& model, const Known& known) {
  const solver::Step& load = scene.steps.front();
  const auto wide = known.pressure ? std::nullopt : wide_pressure(contact, scene, model);
  const RightAnswer right = find_right_answer(contact, load);
  const Regions regions = find_regions(contact, right);
  MeshErrors mesh = measure_mesh(contact, scene, model, regions, known, wide);
  const ArrayXd noise = noise_size(contact, right);
  return {.pressure = wide ? std::optional(on_field(contact, *wide)) : std::nullopt,
          .right = right,
          .regions = regions,
          .mesh = std::move(mesh),
          .rounding = disturbed(contact, right, regions, load, contact.traction_rounding + contact.bound_rounding),
          .noise = disturbed(contact, right, regions, load, noise),
          .noise_size = noise};
}

void require_judgeable(const solver::Scene& scene) {
  const std::string file = scene.source.string();
  if (scene.steps.size() > 1 || scene.cycles > 1) {
    throw InputError(file, "step", fmt::format("{} steps", scene.steps.size() * static_cast<std::size_t>(scene.cycles)),
                     "a scene of one load: a field does not show the steps before");
  }
  if (scene.contact.friction.is_frictionless()) {
    throw InputError(file, "contact.friction", fmt::format("{}", scene.contact.friction.coefficient),
                     "larger than zero: without friction there is no traction to judge");
  }
}

/// The same answer with positions about `centre`.
OracleAnswer about(OracleAnswer exact, const std::array<double, 2>& centre) {
  if (!exact.oracle) return exact;
  for (std::size_t k = 0; k < 2; ++k) exact.oracle->place.centre[k] -= centre[k];
  return exact;
}

/// The exact pressure of a scene, whatever its tangential loads.
OracleAnswer exact_normal_contact(solver::Scene scene) {
  solver::Step& load = scene.steps.front();
  if (!load.normal) return {std::nullopt, "the normal load is not known"};
  constexpr double kAnyRatio = 0.5;
  load.torsion = solver::MomentRatio{kAnyRatio};
  load.force = {};
  load.displacement.reset();
  scene.contact.coupling = solver::Coupling::none;
  scene.contact.friction = 1.0;
  return find_oracle(scene);
}

/// Whether a twist differs from the one that fits the tractions in its sign, and is more than rounding.
bool is_turned_over(const GivenContact& c, double twist, double fitted) {
  constexpr double kSameSize = 0.1;        // relative
  constexpr double kSmallestTwist = 1e-6;  // over the largest displacement
  return std::abs(twist + fitted) < kSameSize * std::abs(twist) &&
         std::abs(twist) * solver::norms(c.rotation).maxCoeff() >
             kSmallestTwist * solver::norms(c.displacement).maxCoeff();
}

/// The certificate under the loads that the scene imposes, otherwise under the field's own.
solver::Certificate certify_field(const GivenContact& c, const solver::Step& load, const State& state,
                                  const std::optional<double>& moment) {
  const std::array<double, 2> imposed{load.force[0] / c.newtons(), load.force[1] / c.newtons()};
  return solver::certify({c.traction, c.elastic_displacement, state.slip}, c.friction_bound, c.rotation,
                         moment.value_or(c.moment()), load.displacement ? c.force() : imposed);
}

}  // namespace

std::optional<ScenePressure> find_scene_pressure(const GivenContact& contact, const solver::Scene& scene,
                                                 const solver::Model& model) {
  const auto wide = wide_pressure(contact, scene, model);
  return wide ? std::optional(on_field(contact, *wide)) : std::nullopt;
}

double Examination::moment_limit() const { return solver::free_moment_limit(contact.grid, contact.friction_bound); }

Examination examine(const solver::Scene& scene, const std::filesystem::path& file, const CheckOptions& options) {
  require_judgeable(scene);
  const solver::Step& load = scene.steps.front();
  const solver::Model model = solver::make_model(scene);
  const OracleAnswer exact = find_oracle(scene);
  Interpretation read = in_own_conventions(read_foreign_field(file, options.columns), scene, model, exact);
  const GivenContact contact = pose(read.field, model, model.threads);
  ForeignField& field = read.field;  // the contact has its values
  field.pressure = field.traction = field.pressure_rounding = field.traction_rounding = ArrayXd();
  const OracleAnswer pressed = about(exact_normal_contact(scene), field.centre), here = about(exact, field.centre);
  const ReferenceOnGrid reference = find_reference_on_grid(
      contact, scene, model, {pressed.oracle, here.oracle, options.twist.has_value(), options.pressure_given});

  const State fitted = find_state(contact, known_motion(contact, load, std::nullopt));
  std::optional<double> twist = options.twist;
  if (!twist) {
    twist = solver::value_if<solver::Twist>(load.torsion);
  } else if (is_turned_over(contact, *twist, fitted.twist)) {
    twist = -*twist;
    read.conventions.emplace_back("the twist that was given counts the other way round");
  }
  const State state = twist ? find_state(contact, known_motion(contact, load, twist)) : fitted;
  const double limit = solver::free_moment_limit(contact.grid, contact.friction_bound);
  const auto moment = std::holds_alternative<solver::Twist>(load.torsion)
                          ? std::nullopt
                          : known_moment(scene, exact, limit, contact.newton_metres());
  return {
      .scene = scene,
      .read = read,
      .exact = here,
      .contact = contact,
      .reference = reference,
      .constant_cells =
          reference.pressure && reference.pressure->off <= kConstantCells * reference.mesh.deviation.pressure,
      .pressure_given = options.pressure_given,
      .twist_given = twist.has_value(),
      .state = state,
      .fitted = fitted,
      .deviation = find_deviation(contact, reference.right, options.twist ? state : fitted, fitted, reference.regions),
      .moment = moment,
      .certificate = certify_field(contact, load, state, moment),
      .direction = noticeable_direction(contact, fitted, reference.mesh.deviation.tractions)};
}

}  // namespace slipstick::convergence
