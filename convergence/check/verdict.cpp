#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "convergence/check/check.hpp"
#include "convergence/oracle/errors.hpp"
#include "solver/contact/fitted_motion.hpp"
#include "solver/step/describe_step.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;

/// Error that a mesh may cause over the error of the reference fields: these know the truth to a third of the
/// mesh error, and other discretisations have errors of the same size.
constexpr double kWholeMesh = 2.0;
/// Effect of rounding or noise over its effect in the random draw on which it was measured.
constexpr double kOtherDraws = 2.0;
/// Relative error of loads, times the number of contact cells n. A sum over cells of a field that ends like a
/// square root misses up to 4/pi^2 h^2/a^2 at the contact's edge (Poisson's summation, nearest images), about
/// 1/n with the stick area's edge; two such sums are compared.
constexpr double kQuadrature = 2.0;
/// The same of a bound that ends in a step, times n^(3/4): twice the spread of a sum over the cells whose centres lie
/// in a circle, 0.7 of the root of the radius in cells for 1 (Kendall 1948), and 3/2 of that for r.
constexpr double kEndsInStep = 1.5;
/// Degrees between slip and traction that change no result noticeably.
constexpr double kUnseenAngle = 0.1;
/// Gap over energy that the mesh may cause where the field's cells are constant, where only the iteration
/// leaves a gap: tractions are then good to a few hundredths.
constexpr double kUnfinishedGap = 1e-3;
/// Relative: friction coefficients are not known to more digits.
constexpr double kFrictionDigits = 1e-3;
/// Standard deviations by which no cell of a contact is off by chance.
constexpr double kLargestDraw = 6.0;
/// Relative error of the pressure that a normal solver's tolerance of 1e-3 leaves in the mean.
constexpr double kNormalTolerance = 2e-3;
/// Error of pressure or traction in a single cell, over the largest value.
constexpr double kCellTolerance = 5e-3;

/// For each cell, a number made from the values of its neighbours, which `take` gets in ascending order.
template <typename Take>
ArrayXd of_neighbours(const solver::Grid& grid, const ArrayXd& values, const Take& take) {
  ArrayXd result(grid.cells());
  std::vector<double> around;
  for (Index cell = 0; cell < grid.cells(); ++cell) {
    around.clear();
    for (Index i = cell / grid.n2 - 1; i <= cell / grid.n2 + 1; ++i) {
      for (Index j = cell % grid.n2 - 1; j <= cell % grid.n2 + 1; ++j) {
        const Index other = i * grid.n2 + j;
        if (i >= 0 && i < grid.n1 && j >= 0 && j < grid.n2 && other != cell) around.push_back(values[other]);
      }
    }
    std::ranges::sort(around);
    result[cell] = take(around);
  }
  return result;
}

/// The error that each cell may have. The mesh error that right fields show may stand one cell further on;
/// and a cell may be off where half of its neighbours are, since the mean judges those.
ArrayXd allowed_in_cells(const solver::Grid& grid, double scale, const ArrayXd& deviation, const ArrayXd& mesh,
                         const ArrayXd& chance) {
  const auto largest = [](const std::vector<double>& around) { return around.back(); };
  const auto median = [](const std::vector<double>& around) { return around[around.size() / 2]; };
  return kCellTolerance * scale + chance +
         kWholeMesh * (mesh.max(of_neighbours(grid, mesh, largest)) + of_neighbours(grid, deviation, median));
}

/// Relative error of sums over the contact by rounding and noise.
double error_of_sums(const Examination& e) {
  const GivenContact& c = e.contact;
  return c.traction_rounding.sum() / solver::norms(c.traction).sum() + c.bound_rounding.sum() / c.friction_bound.sum() +
         kLargestDraw * std::sqrt(e.reference.noise_size.square().sum()) / c.friction_bound.sum();
}

/// The gap over energy that a relative error of the tractions may cause.
double gap_of_tolerance(const Examination& e, double tolerance) {
  const GivenContact& c = e.contact;
  const ArrayXd reach = solver::norms(e.state.slip) + solver::norms(c.displacement);
  return tolerance * (c.friction_bound * reach).sum() / c.energy();
}

/// Distance of the field's tractions from the right ones, cell by cell.
ArrayXd traction_deviation(const Examination& e) {
  return solver::norms(e.contact.traction - e.reference.right.traction);
}

/// The maxima that do not depend on a tolerance.
Allowed allowed_anyway(const Examination& e) {
  const GivenContact& c = e.contact;
  const ReferenceOnGrid& y = e.reference;
  Allowed allowed{};
  allowed.discrete_gap = kIterationGap + kOtherDraws * y.rounding.gap;
  allowed.traction_cells =
      allowed_in_cells(c.grid, c.friction_bound.maxCoeff(), traction_deviation(e), y.mesh.tractions,
                       kLargestDraw * y.noise_size + kOtherDraws * (c.traction_rounding + c.bound_rounding));
  // A part of a cell may carry anything up to a bound that does not vanish at the edge.
  if (e.scene.contact.friction.kind == solver::FrictionKind::tresca)
    allowed.traction_cells += c.friction_bound * (1.0 - y.regions.inner);
  if (y.pressure) {
    allowed.pressure_cells =
        allowed_in_cells(c.grid, y.pressure->values.maxCoeff(), y.pressure->deviation, y.mesh.pressures,
                         (kLargestDraw * y.noise_size + kOtherDraws * c.bound_rounding) / c.mean_friction());
  }
  return allowed;
}

/// Whether |q| <= mu p, up to the file's digits and a solver's tolerance. Otherwise Coulomb's gap is undefined.
bool keeps_friction_bound(const GivenContact& c) {
  const ArrayXd beyond =
      solver::norms(c.traction) - (1.0 + solver::kOnCircle) * c.friction_bound - c.traction_rounding - c.bound_rounding;
  return beyond.maxCoeff() <= kNextToNothing * solver::kOnCircle * c.friction_bound.maxCoeff();
}

Allowed find_allowed(const Examination& e, std::optional<double> tolerance) {
  const ReferenceOnGrid& y = e.reference;
  constexpr double kDegreesInARadian = 180.0 / std::numbers::pi;
  Allowed allowed = allowed_anyway(e);
  if (tolerance) {
    allowed.normal = allowed.moment = allowed.force = allowed.pressure = allowed.motion = allowed.tractions =
        allowed.inside = allowed.friction = *tolerance;
    allowed.friction_bound = std::max(kFrictionDigits, *tolerance - kFrictionDigits);
    allowed.direction = kDegreesInARadian * *tolerance;
    allowed.gap = allowed.discrete_gap + gap_of_tolerance(e, *tolerance);
    return allowed;
  }
  const auto by_chance = [&](double Deviation::*part) { return kOtherDraws * (y.noise.*part + y.rounding.*part); };
  const auto cells = static_cast<double>((e.contact.pressure > 0.0).count());
  const bool step = e.scene.contact.friction.kind == solver::FrictionKind::tresca;
  const double quadrature = kQuadrature / cells;
  const double of_moment = step ? kEndsInStep * std::pow(cells, -0.75) : quadrature;
  const double sums = error_of_sums(e);
  // A program that solves this grid's problem knows its own sums and its own twist.
  const bool discrete = e.constant_cells && keeps_friction_bound(e.contact) && e.deviation.gap <= allowed.discrete_gap;
  // Constant cells leave the motion open only as far as the iteration leaves the tractions open.
  const double off = e.deviation.tractions / y.mesh.deviation.tractions;
  const double unfinished = discrete ? 0.0 : e.constant_cells ? std::min(1.0, off) : 1.0;
  const auto load = [&](double measured, double of_sum) {
    return std::max(discrete ? 0.0 : kWholeMesh * measured, of_sum) + sums;
  };
  allowed.normal = load(y.mesh.loads.normal, quadrature);
  allowed.moment = solver::value_if<solver::Twist>(e.scene.steps.front().torsion)
                       ? std::max(kWholeMesh * y.mesh.deviation.moment, of_moment) + sums
                       : load(y.mesh.loads.moment, of_moment);
  allowed.force = load(y.mesh.loads.force, quadrature);
  allowed.pressure =
      kNormalTolerance + kWholeMesh * y.mesh.deviation.pressure +
      kOtherDraws * (e.contact.bound_rounding.sum() + y.noise_size.sum()) / e.contact.friction_bound.sum();
  allowed.motion = unfinished * kWholeMesh * y.mesh.deviation.motion + quadrature + by_chance(&Deviation::motion);
  allowed.tractions = kWholeMesh * y.mesh.deviation.tractions + by_chance(&Deviation::tractions);
  allowed.inside = kWholeMesh * y.mesh.deviation.inside + by_chance(&Deviation::inside);
  allowed.friction = kFrictionDigits + kWholeMesh * y.mesh.deviation.friction + by_chance(&Deviation::friction);
  allowed.friction_bound = kFrictionDigits;
  allowed.direction =
      kUnseenAngle + kWholeMesh * y.mesh.direction + kDegreesInARadian * by_chance(&Deviation::tractions);
  allowed.gap = allowed.discrete_gap +
                std::min(kWholeMesh * y.mesh.deviation.gap, e.constant_cells ? kUnfinishedGap : INFINITY) +
                kOtherDraws * y.noise.gap;
  return allowed;
}

/// The part of mu p by which |q| exceeds it in the worst cell, beyond digits and noise; a cell that carries
/// less than kNextToNothing is judged by a part of the largest mu p.
double friction_excess(const Examination& e) {
  const GivenContact& c = e.contact;
  const ArrayXd beyond = solver::norms(c.traction) - c.friction_bound - c.traction_rounding - c.bound_rounding -
                         kLargestDraw * e.reference.noise_size;
  return (beyond / c.friction_bound.max(kNextToNothing * c.friction_bound.maxCoeff())).maxCoeff();
}

std::string percent(double part) {
  const double size = 100.0 * std::abs(part);
  if (size < 1e-3) return "less than 0.001 %";
  return size < 10.0 ? fmt::format("{:.2g} %", size) : fmt::format("{:.0f} %", size);
}

std::string allowed_text(double allowed) { return fmt::format(" (allowed: {})", percent(allowed)); }

Judged judge_error(const std::string& what, const std::string& key, double error, double allowed) {
  return {
      key,        std::abs(error), allowed, "", fmt::format("{} is {}{}", what, off_text(error), allowed_text(allowed)),
      error < 0.0};
}

/// A cell's centre in the scene's coordinates, in m.
std::string place_text(const GivenContact& c, Index cell) {
  const double x1 = (solver::cell_x1(c.grid)[cell] + c.centre[0]) * c.length_unit;
  const double x2 = (solver::cell_x2(c.grid)[cell] + c.centre[1]) * c.length_unit;
  return fmt::format("x1 = {:.3g}, x2 = {:.3g} m", x1, x2);
}

std::string most_text(const GivenContact& c, const ArrayXd& deviation) {
  Index cell = 0;
  deviation.maxCoeff(&cell);
  return ", most at " + place_text(c, cell);
}

/// The cell that is furthest beyond its allowed error.
Judged judge_cells(const std::string& what, const std::string& key, const GivenContact& c, double scale,
                   const ArrayXd& deviation, const ArrayXd& allowed) {
  Index cell = 0;
  (deviation / allowed).maxCoeff(&cell);
  return {key, deviation[cell] / scale, allowed[cell] / scale, "",
          fmt::format("{} of one cell, at {}, is {} of the largest off{}", what, place_text(c, cell),
                      percent(deviation[cell] / scale), allowed_text(allowed[cell] / scale))};
}

/// Judges a field in the mean and in parts; only the first wrong one of these is put in words.
void judge_field(std::vector<Judged>& judged, const Judged& mean, std::vector<Judged> parts) {
  bool right = mean.holds();
  judged.push_back(mean);
  for (Judged& part : parts) {
    if (!right) part.wrong.clear();
    right = right && part.holds();
    judged.push_back(std::move(part));
  }
}

/// Judges normal load and pressure. A contact may end a cell too early or too late.
void judge_pressure(std::vector<Judged>& judged, const Examination& e, const Allowed& allowed) {
  const solver::Step& load = e.scene.steps.front();
  const GivenContact& c = e.contact;
  if (load.normal) {
    judged.push_back(judge_error("the normal load", "normal_load_error",
                                 relative_error(c.pressure.sum() * c.newtons(), *load.normal), allowed.normal));
  }
  if (e.pressure_given) return;
  if (e.exact.oracle && std::isfinite(e.exact.oracle->contact_radius)) {
    const double radius = e.exact.oracle->contact_radius / c.length_unit;
    const double one_cell = std::max(c.grid.h1, c.grid.h2) * c.length_unit / e.exact.oracle->shorter_semi_axis();
    judged.push_back(judge_error("the contact radius", "contact_radius_error",
                                 relative_error(measure_contact_radius(c, c.pressure), radius), one_cell));
  }
  if (!e.reference.pressure) return;
  const ScenePressure& right = *e.reference.pressure;
  judge_field(judged,
              {"pressure", right.off, allowed.pressure, "",
               fmt::format("the contact has another shape: its pressure is {} off in the mean{}{}", percent(right.off),
                           most_text(c, right.deviation), allowed_text(allowed.pressure))},
              {judge_cells("the pressure", "pressure_cell", c, right.values.maxCoeff(), right.deviation,
                           allowed.pressure_cells)});
}

void judge_loads(std::vector<Judged>& judged, const Examination& e, const Allowed& allowed) {
  if (const auto error = moment_error(e)) {
    Judged moment = judge_error("the moment", "moment_error", *error, allowed.moment);
    moment.right = "the moment is right";
    if (!(stick_cells(e.contact) > 0.0).any())
      moment.wrong += ": all of the contact slips, and friction carries no more";
    judged.push_back(moment);
  }
  judged.push_back({"force", e.certificate.force, allowed.force, "",
                    fmt::format("the tangential force is off by {} of mu W{}", percent(e.certificate.force),
                                allowed_text(allowed.force))});
}

/// Judges motion and tractions. Where the law of friction is broken, or nothing sticks, a motion that is
/// inferred means little, and is not judged.
void judge_motion(std::vector<Judged>& judged, const Examination& e, const Allowed& allowed, bool lawful) {
  if (e.reference.right.scaled) return;  // the right motion and tractions belong to other loads
  const bool torsion = is_torsion(e.scene);
  const double error = e.deviation.motion;
  Judged motion = torsion ? judge_error("the twist", "twist", error, allowed.motion)
                          : judge_error("the rigid motion", "motion", error, allowed.motion);
  if (torsion && e.twist_given) motion.right = "the twist is right";
  const bool determined = e.twist_given || (lawful && (stick_cells(e.contact) > 0.0).any());
  if (determined) judged.push_back(motion);
  const GivenContact& c = e.contact;
  const ArrayXd deviation = traction_deviation(e);
  judge_field(judged,
              {"tractions", e.deviation.tractions, allowed.tractions, "",
               fmt::format("the tractions are {} off in the mean{}{}", percent(e.deviation.tractions),
                           most_text(c, deviation), allowed_text(allowed.tractions))},
              {{"tractions_inside", e.deviation.inside, allowed.inside, "",
                fmt::format("the tractions away from the contact's edge are {} off in the mean{}",
                            percent(e.deviation.inside), allowed_text(allowed.inside))},
               judge_cells("the traction", "traction_cell", c, c.friction_bound.maxCoeff(), deviation,
                           allowed.traction_cells)});
}

void judge_friction(std::vector<Judged>& judged, const Examination& e, const Allowed& allowed) {
  const solver::FrictionKind kind = e.scene.contact.friction.kind;
  const std::string law = solver::law_text(kind);
  judged.push_back(judge_error(
      e.scene.contact.friction.is_coulomb() ? "|q|/p in the slip ring" : "|q| over its bound in the slip ring",
      "friction", e.deviation.friction, allowed.friction));
  const double excess = friction_excess(e);
  judged.push_back({"friction_bound", excess, allowed.friction_bound, "",
                    fmt::format("|q| exceeds {} by {}{}", solver::bound_text(kind), percent(excess),
                                allowed_text(allowed.friction_bound))});
  const bool within_friction = judged.back().holds();
  judged.push_back({"slip_direction", e.direction.mean, allowed.direction, "",
                    fmt::format("slip is not opposed to traction: {:.2g} degrees off in the mean (allowed: "
                                "{:.2g})",
                                e.direction.mean, allowed.direction)});
  if (!within_friction) return;  // the gap is a sum of positive parts only within friction
  judged.push_back({"gap", e.deviation.gap, allowed.gap, law + " holds",
                    fmt::format("{} is broken: the gap is {} of the energy{}", law, percent(e.deviation.gap),
                                allowed_text(allowed.gap))});
}

/// Judges whether the field solves the problem of its own grid, with constant tractions in each cell.
Judged judge_discrete(const Examination& e, const Allowed& allowed) {
  return {"discrete", keeps_friction_bound(e.contact) ? e.certificate.gap : NAN, allowed.discrete_gap,
          "it solves its own grid's problem", "it does not solve its own grid's problem"};
}

/// Whether a field of constant cells that does not solve its own grid's problem solves it with a wrong
/// kernel: an iteration that stopped too early leaves a gap with any.
bool is_solved_with_other_kernel(const Examination& e, const Allowed& allowed) {
  if (!e.constant_cells || is_coated(e.scene) || e.deviation.gap <= allowed.discrete_gap) return false;
  const Diagnosis found = diagnose(e.contact, e.scene.steps.front(), allowed.gap);
  return found.kernel && found.kernel->gap <= allowed.discrete_gap;
}

}  // namespace

std::string off_text(double error) { return fmt::format("{} too {}", percent(error), error < 0.0 ? "low" : "high"); }

std::string listed(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += i + 1 == parts.size() ? " and " : ", ";
    text += parts[i];
  }
  return text;
}

std::optional<double> moment_error(const Examination& e) {
  const solver::TorsionLoad& torsion = e.scene.steps.front().torsion;
  if (std::holds_alternative<solver::Twist>(torsion)) return e.deviation.moment;
  if (!e.moment || *e.moment == 0.0) return std::nullopt;
  const double error = relative_error(e.contact.moment(), *e.moment);
  const auto ratio = solver::value_if<solver::MomentRatio>(torsion);
  if (!ratio) return error;
  const double of_own_limit = relative_error(e.contact.moment(), *ratio * e.moment_limit());
  const double of_finer_limit = relative_error(e.contact.moment(), *ratio * e.reference.mesh.moment_limit);
  const bool exact = e.exact.oracle && std::isfinite(e.exact.oracle->moment);
  return std::min({error, of_own_limit, exact ? error : of_finer_limit},
                  [](double a, double b) { return std::abs(a) < std::abs(b); });
}

bool is_torsion(const solver::Scene& scene) { return !solver::brings_translation(scene.steps.front()); }

bool Verdict::within_mesh() const { return std::ranges::all_of(judged, &Judged::holds); }

bool Verdict::holds(const std::string& quantity) const {
  return std::ranges::all_of(judged, [&](const Judged& item) { return item.quantity != quantity || item.holds(); });
}

Verdict reach_verdict(const Examination& e, std::optional<double> tolerance) {
  Allowed allowed = find_allowed(e, tolerance);
  if (!tolerance && is_solved_with_other_kernel(e, allowed)) allowed.gap = allowed.discrete_gap;
  std::vector<Judged> judged;
  judge_pressure(judged, e, allowed);
  judge_loads(judged, e, allowed);
  std::vector<Judged> law;
  judge_friction(law, e, allowed);
  // Friction comes first, then motion and tractions, which follow from it; slip direction and gap come last.
  const auto follows = law.begin() + 2;
  judged.insert(judged.end(), law.begin(), follows);
  judge_motion(judged, e, allowed, std::ranges::all_of(law, &Judged::holds));
  judged.insert(judged.end(), follows, law.end());
  return {judged, judge_discrete(e, allowed), allowed};
}

std::string right_text(const Examination& e, const Verdict& verdict) {
  std::string text = "right within its mesh";
  if (!e.reference.pressure) {
    text += e.pressure_given ? ", with the pressure taken as given"
                             : ", with the pressure taken as it is (the scene's is solved on other cells)";
  }
  if (e.reference.right.scaled) return text;
  return text + fmt::format(": the tractions are {} off in the mean{}", percent(e.deviation.tractions),
                            allowed_text(verdict.allowed.tractions));
}

}  // namespace slipstick::convergence
