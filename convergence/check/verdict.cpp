#include "convergence/check/verdict.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "solver/model_solution.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;

constexpr double kDegrees = 180.0 / std::numbers::pi;
/// The reference fields know the truth to a third of the mesh error, and other discretisations than its own
/// have errors of the same size: twice what it measures is what a mesh accounts for.
constexpr double kWholeMesh = 2.0;
/// Errors drawn at random change what they disturb by as much as another draw does, within this factor.
constexpr double kOtherDraws = 2.0;
/// A sum over n cells of what ends at an edge like a square root: by Poisson's summation midpoints miss up
/// to 4/pi^2 h^2/a^2 of it with the nearest images, and about 1/n with those of the stick area's edge; of two
/// such sums twice that.
constexpr double kQuadrature = 2.0;
/// Degrees between slip and traction that matter to no result.
constexpr double kUnseenAngle = 0.1;
/// Where the pressure shows that the program's cells are constant, what is left of a gap is its iteration's,
/// not the mesh's. So much of it stands for tractions good to a few hundredths.
constexpr double kUnfinishedGap = 1e-3;
/// Friction coefficients are not known to more digits.
constexpr double kFrictionSlack = 1e-3;
/// Of so many standard deviations no cell of a contact is off by chance.
constexpr double kLargestDraw = 6.0;

/// "5.1 % too low", or "right to 2e-05".
std::string off_text(double error) {
  constexpr double percent = 100.0;
  return fmt::format("{:.2g} % too {}", percent * std::abs(error), error < 0.0 ? "low" : "high");
}

Judged judge_error(const std::string& what, const std::string& key, double error, double allowed) {
  return {key, std::abs(error), allowed, "", fmt::format("{} is {}", what, off_text(error))};
}

/// By how much rounding and noise may change sums over the contact, relative.
double error_of_sums(const Examination& e) {
  const GivenContact& c = e.contact;
  return c.traction_rounding.sum() / solver::norms(c.traction).sum() +
         c.bound_rounding.sum() / c.friction_bound.sum() +
         kLargestDraw * std::sqrt(e.reference.noise_size.square().sum()) / c.friction_bound.sum();
}

/// By how much tractions that are wrong by a part may change the gap, over the energy.
double gap_of_tolerance(const Examination& e, double tolerance) {
  const GivenContact& c = e.contact;
  const ArrayXd reach = solver::norms(e.state.slip) + solver::norms(c.displacement);
  return tolerance * (c.friction_bound * reach).sum() / c.energy();
}

/// |q| <= mu p up to a file's digits and a solver's tolerance: else there is no gap.
bool is_bounded(const GivenContact& c) {
  const ArrayXd beyond = solver::norms(c.traction) - (1.0 + kOnCircle) * c.friction_bound -
                         c.traction_rounding - c.bound_rounding;
  return beyond.maxCoeff() <= kNextToNothing * kOnCircle * c.friction_bound.maxCoeff();
}

/// What is allowed of each quantity.
struct Allowed {
  double normal, moment, force;
  double motion;
  double tractions;
  double friction;
  double direction;  ///< degrees
  double gap;
  double discrete_gap;
};

Allowed find_allowed(const Examination& e, std::optional<double> tolerance) {
  const ReferenceOnGrid& y = e.reference;
  const double discrete_gap = kIterationGap + kOtherDraws * y.rounding.gap;
  if (tolerance) {
    const double t = *tolerance;
    return {t, t, t, t, t, t, kDegrees * t, discrete_gap + gap_of_tolerance(e, t), discrete_gap};
  }
  const auto by_chance = [&](double Deviation::*part) {
    return kOtherDraws * (y.noise.*part + y.rounding.*part);
  };
  const double quadrature = kQuadrature / static_cast<double>((e.contact.pressure > 0.0).count());
  const double sums = error_of_sums(e);
  // A program that solves this grid's problem knows its own sums and its own twist.
  const bool discrete = is_bounded(e.contact) && e.deviation.gap <= discrete_gap;
  const auto load = [&](double measured) {
    return std::max(discrete ? 0.0 : kWholeMesh * measured, quadrature) + sums;
  };
  const double tractions = kWholeMesh * y.mesh.deviation.tractions + by_chance(&Deviation::tractions);
  return {
      .normal = load(y.mesh.loads.normal),
      .moment = solver::value_if<solver::Twist>(e.scene.steps.front().torsion)
                    ? std::max(kWholeMesh * y.mesh.deviation.moment, quadrature) + sums
                    : load(y.mesh.loads.moment),
      .force = load(y.mesh.loads.force),
      .motion = (discrete ? 0.0 : kWholeMesh * y.mesh.deviation.motion) + quadrature +
                by_chance(&Deviation::motion),
      .tractions = tractions,
      .friction = kFrictionSlack + kWholeMesh * y.mesh.deviation.friction + by_chance(&Deviation::friction),
      .direction = kUnseenAngle + kWholeMesh * y.mesh.direction + kDegrees * by_chance(&Deviation::tractions),
      .gap = discrete_gap +
             std::min(kWholeMesh * y.mesh.deviation.gap, e.constant_cells ? kUnfinishedGap : INFINITY) +
             kOtherDraws * y.noise.gap,
      .discrete_gap = discrete_gap};
}

/// Normal load and pressure. A contact may end a cell too early or too late, and its limit moment goes with
/// its radius.
void judge_pressure(std::vector<Judged>& judged, const Examination& e, const Allowed& allowed) {
  const solver::Step& load = e.scene.steps.front();
  const GivenContact& c = e.contact;
  if (load.normal) {
    judged.push_back(judge_error("the normal load", "normal_load_error",
                                 relative_error(c.pressure.sum() * c.newtons(), *load.normal),
                                 allowed.normal));
  }
  if (!e.exact.oracle || !std::isfinite(e.exact.oracle->contact_radius)) return;
  const double radius = e.exact.oracle->contact_radius / c.length_unit;
  const double one_cell =
      std::max(c.grid.h1, c.grid.h2) * c.length_unit / e.exact.oracle->shorter_semi_axis();
  judged.push_back(judge_error("the contact radius", "contact_radius_error",
                               relative_error(measure_contact_radius(c, c.pressure), radius), one_cell));
  const double limit = e.exact.oracle->moment_limit / c.newton_metres();
  if (!std::isfinite(limit)) return;
  judged.push_back(judge_error("the limit moment of the pressure (its shape is not the exact one)",
                               "moment_limit_error", relative_error(e.moment_limit, limit), one_cell));
}

/// Against the moment asked for; a ratio of the limit moment may be one of the exact limit, or of that of the
/// field's own pressure. Under an imposed twist against the one that it causes. None: none is known.
std::optional<double> moment_error(const Examination& e) {
  const solver::TorsionLoad& torsion = e.scene.steps.front().torsion;
  if (std::holds_alternative<solver::Twist>(torsion)) return e.deviation.moment;
  if (!e.moment || *e.moment == 0.0) return std::nullopt;
  const double error = relative_error(e.contact.moment(), *e.moment);
  const auto ratio = solver::value_if<solver::MomentRatio>(torsion);
  if (!ratio) return error;
  const double of_own_limit = relative_error(e.contact.moment(), *ratio * e.moment_limit);
  return std::abs(of_own_limit) < std::abs(error) ? of_own_limit : error;
}

void judge_loads(std::vector<Judged>& judged, const Examination& e, const Allowed& allowed) {
  if (const auto error = moment_error(e)) {
    Judged moment = judge_error("the moment", "moment_error", *error, allowed.moment);
    moment.right = fmt::format("the moment is right ({:+.1e}, allowed {:.0e})", *error, allowed.moment);
    judged.push_back(moment);
  }
  judged.push_back({"force", e.certificate.force, allowed.force, "",
                    fmt::format("the tangential force is off by {:.2g} of mu W", e.certificate.force)});
}

/// By what part of mu p |q| exceeds it, beyond what the file's digits and noise leave open. In cells that
/// carry next to nothing, of a part of the largest mu p.
double friction_excess(const Examination& e) {
  const GivenContact& c = e.contact;
  const ArrayXd beyond = solver::norms(c.traction) - c.friction_bound - c.traction_rounding -
                         c.bound_rounding - kLargestDraw * e.reference.noise_size;
  return (beyond / c.friction_bound.max(kNextToNothing * c.friction_bound.maxCoeff())).maxCoeff();
}

bool is_torsion(const solver::Scene& scene) {
  const solver::Step& load = scene.steps.front();
  return !load.displacement && load.force == std::array<double, 2>{};
}

/// A twist that was inferred from a field that breaks Coulomb's law means little: no sentence speaks of it.
void judge_motion(std::vector<Judged>& judged, const Examination& e, const Allowed& allowed, bool lawful) {
  if (e.reference.right.scaled) return;  // the right motion and tractions are those of other loads
  const bool torsion = is_torsion(e.scene);
  const double error = e.deviation.motion;
  Judged motion = torsion ? judge_error("the twist", "twist", error, allowed.motion)
                          : judge_error("the rigid motion", "motion", error, allowed.motion);
  if (torsion) {
    motion.right = fmt::format("the twist is right ({}{:+.1e})", e.twist_given ? "" : "inferred, ", error);
  }
  if (!e.twist_given && !lawful) motion.wrong.clear();
  judged.push_back(motion);
  judged.push_back({"tractions", e.deviation.tractions, allowed.tractions, "",
                    fmt::format("the tractions are {:.2g} % off in the mean (allowed: {:.1g})",
                                100.0 * e.deviation.tractions, 100.0 * allowed.tractions)});
}

void judge_coulomb(std::vector<Judged>& judged, const Examination& e, const Allowed& allowed) {
  judged.push_back(judge_error("|q|/p in the slip ring", "friction", e.deviation.friction, allowed.friction));
  const double excess = friction_excess(e);
  judged.push_back({"friction_bound", excess, std::max(kFrictionSlack, allowed.friction - kFrictionSlack), "",
                    fmt::format("|q| exceeds mu p by {:.2g} %", 100.0 * excess)});
  const bool within_friction = judged.back().holds();
  judged.push_back(
      {"slip_direction", e.direction.mean, allowed.direction,
       fmt::format("slip opposes traction to {:.1g} degrees in the mean", e.direction.mean),
       fmt::format("slip is not opposed to traction ({:.2g} degrees off in the mean, of which the "
                   "mesh accounts for {:.1g})",
                   e.direction.mean, allowed.direction)});
  if (!within_friction) return;  // what it sums is not positive then
  judged.push_back({"gap", e.deviation.gap, allowed.gap,
                    fmt::format("Coulomb's law holds (gap/energy {:.1e}; the mesh accounts for {:.1e})",
                                e.deviation.gap, allowed.gap),
                    fmt::format("Coulomb's law is broken (gap/energy {:.1e}; the mesh accounts for {:.1e})",
                                e.deviation.gap, allowed.gap)});
}

/// Whether cell-constant tractions solve the problem of this very grid.
Judged judge_discrete(const Examination& e, const Allowed& allowed) {
  const bool bounded = is_bounded(e.contact);
  return {"discrete", bounded ? e.certificate.gap : NAN, allowed.discrete_gap,
          fmt::format("it solves its own grid's problem (gap/energy {:.1e}, allowed {:.1e})",
                      e.certificate.gap, allowed.discrete_gap),
          bounded
              ? fmt::format("it does not solve its own grid's problem (gap/energy {:.1e}, allowed {:.1e})",
                            e.certificate.gap, allowed.discrete_gap)
              : "it does not solve its own grid's problem (|q| exceeds mu p)"};
}

/// "a, b and c".
std::string listed(const std::vector<std::string>& parts) {
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    if (i > 0) text += i + 1 == parts.size() ? " and " : ", ";
    text += parts[i];
  }
  return text;
}

bool holds(const std::vector<Judged>& judged, const std::string& quantity) {
  return std::ranges::all_of(judged,
                             [&](const Judged& item) { return item.quantity != quantity || item.holds(); });
}

bool all_hold(const std::vector<Judged>& judged) { return std::ranges::all_of(judged, &Judged::holds); }

bool has_right_pressure(const std::vector<Judged>& judged) {
  return holds(judged, "normal_load_error") && holds(judged, "moment_limit_error");
}

/// How sure that kernel is: by how much it lowers the gap of the stick area, and the twist that it leads to.
std::string kernel_text(const Hypothesis& kernel, const Hypothesis& right, const Examination& e) {
  std::string text =
      fmt::format("{}: with that the stick area moves as one body (its gap falls from {:.1e} to {:.1e})",
                  kernel.name, right.stick_gap, kernel.stick_gap);
  if (e.reference.right.scaled || !is_torsion(e.scene)) return text;
  return text + fmt::format(" by {:.6g} rad, {}", kernel.twist,
                            off_text(relative_error(kernel.twist, e.reference.right.twist)));
}

/// What it may be that makes a twist wrong, by the ratio to the one that fits the tractions.
std::string twist_mistake(const Examination& e, double allowed) {
  struct Ratio {
    double value;
    const char* words;
  };
  const auto compliance = [](const solver::Material& m) { return (1.0 + m.poisson_ratio) / m.young_modulus; };
  const double lower = compliance(e.scene.lower);
  const double upper = compliance(e.scene.upper);
  const std::array<Ratio, 5> ratios{{{lower / (lower + upper), "the compliance of one body only"},
                                     {upper / (lower + upper), "the compliance of one body only"},
                                     {2.0, "twice the compliance of the pair"},
                                     {kDegrees, "a twist in degrees"},
                                     {-1.0, "a twist of the other sense"}}};
  for (const Ratio& ratio : ratios) {
    if (std::abs(e.state.twist / e.fitted.twist / ratio.value - 1.0) <= allowed) return ratio.words;
  }
  return fmt::format("a twist that is not that of these tractions, {:.6g} rad", e.fitted.twist);
}

std::vector<std::string> causes(const Examination& e, const std::vector<Judged>& judged,
                                const std::optional<Diagnosis>& diagnosis, const Allowed& allowed) {
  std::vector<std::string> causes;
  if (!has_right_pressure(judged) && e.exact.oracle && !std::isfinite(e.exact.oracle->peak_pressure)) {
    causes.emplace_back(
        "a pressure that is infinite at a place, sampled at cell centres in place of averaged");
  }
  if (!diagnosis) return causes;
  if (e.twist_given && !holds(judged, "twist") && diagnosis->reference_kernel.gap <= allowed.gap) {
    causes.push_back(twist_mistake(e, allowed.motion));
  }
  if (const auto& friction = diagnosis->friction) {
    causes.push_back(fmt::format("{} (gap/energy {:.1e} with that)", friction->name, friction->gap));
  }
  if (diagnosis->kernel) causes.push_back(kernel_text(*diagnosis->kernel, diagnosis->reference_kernel, e));
  if (!diagnosis->friction && diagnosis->stick_area_explained && !holds(judged, "slip_direction")) {
    causes.emplace_back("slipping cells that keep a direction which does not oppose their slip");
  }
  return causes;
}

/// What is right, what is not, and what that looks like.
std::string sentence(const Examination& e, const std::vector<Judged>& judged, const Judged& discrete,
                     const std::optional<Diagnosis>& diagnosis, const Allowed& allowed) {
  std::vector<std::string> right;
  std::vector<std::string> wrong;
  const bool lawful = holds(judged, "slip_direction") && holds(judged, "gap") && holds(judged, "tractions") &&
                      holds(judged, "friction");
  for (const Judged& item : judged) {
    const bool of_law = item.quantity == "slip_direction" || item.quantity == "gap";
    if (item.holds() && of_law && !lawful) continue;  // it would say that the law holds, and that it does not
    const std::string& text = item.text();
    if (!text.empty()) (item.holds() ? right : wrong).push_back(text);
  }
  if (all_hold(judged)) {
    return fmt::format("{}; {} {}", listed(right), discrete.holds() ? "and" : "but", discrete.text());
  }
  const std::vector<std::string> likely = causes(e, judged, diagnosis, allowed);
  std::string text = (right.empty() ? "" : listed(right) + ", but ") + listed(wrong);
  if (!likely.empty()) {
    text += fmt::format("; it looks like {}", fmt::join(likely, ", and like "));
  } else if (diagnosis && has_right_pressure(judged)) {
    text += "; none of the usual mistakes explains it, as where an iteration stops too early";
  }
  return discrete.holds() ? text + "; " + discrete.right : text;
}

}  // namespace

bool Verdict::within_mesh() const { return all_hold(judged); }

Verdict reach_verdict(const Examination& e, std::optional<double> tolerance) {
  const Allowed allowed = find_allowed(e, tolerance);
  std::vector<Judged> judged;
  judge_pressure(judged, e, allowed);
  judge_loads(judged, e, allowed);
  std::vector<Judged> law;
  judge_coulomb(law, e, allowed);
  const bool lawful = all_hold(law);
  judge_motion(judged, e, allowed, lawful);
  judged.insert(judged.end(), law.begin(), law.end());
  std::optional<Diagnosis> diagnosis;
  if (!lawful || !holds(judged, "tractions") || !holds(judged, "twist") || !holds(judged, "motion")) {
    std::optional<double> friction;
    if (!holds(judged, "friction")) friction = plateau_of_friction(e.contact, e.reference.right);
    diagnosis = diagnose(e.contact, e.scene.steps.front(), allowed.gap, friction);
  }
  const Judged discrete = judge_discrete(e, allowed);
  return {judged, discrete, diagnosis, sentence(e, judged, discrete, diagnosis, allowed)};
}

}  // namespace slipstick::convergence
