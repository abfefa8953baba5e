#include "convergence/check/verdict.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "convergence/check/mistaken_scene.hpp"
#include "convergence/oracle/errors.hpp"
#include "solver/step/describe_step.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Index;

std::string percent(double part) {
  const double size = 100.0 * std::abs(part);
  if (size < 1e-3) return "less than 0.001 %";
  return size < 10.0 ? fmt::format("{:.2g} %", size) : fmt::format("{:.0f} %", size);
}

std::string allowed_text(double allowed) { return fmt::format(" (allowed: {})", percent(allowed)); }

/// "5.1 % too low".
std::string off_text(double error) {
  return fmt::format("{} too {}", percent(error), error < 0.0 ? "low" : "high");
}

Judged judge_error(const std::string& what, const std::string& key, double error, double allowed) {
  return {key, std::abs(error), allowed, "",
          fmt::format("{} is {}{}", what, off_text(error), allowed_text(allowed))};
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

/// Judges a field in the mean, and in parts of it, of which only the first wrong one is put in words.
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
                                 relative_error(c.pressure.sum() * c.newtons(), *load.normal),
                                 allowed.normal));
  }
  if (e.pressure_given) return;
  if (e.exact.oracle && std::isfinite(e.exact.oracle->contact_radius)) {
    const double radius = e.exact.oracle->contact_radius / c.length_unit;
    const double one_cell =
        std::max(c.grid.h1, c.grid.h2) * c.length_unit / e.exact.oracle->shorter_semi_axis();
    judged.push_back(judge_error("the contact radius", "contact_radius_error",
                                 relative_error(measure_contact_radius(c, c.pressure), radius), one_cell));
  }
  if (!e.reference.pressure) return;
  const ScenePressure& right = *e.reference.pressure;
  judge_field(
      judged,
      {"pressure", right.off, allowed.pressure, "",
       fmt::format("the contact has another shape: its pressure is {} off in the mean{}{}",
                   percent(right.off), most_text(c, right.deviation), allowed_text(allowed.pressure))},
      {judge_cells("the pressure", "pressure_cell", c, right.values.maxCoeff(), right.deviation,
                   allowed.pressure_cells)});
}

/// The relative error of the moment, which the scene asks for or the imposed twist causes. A scene's ratio
/// may refer to the exact limit moment, to the limit of the field's own pressure or, where the exact one is
/// not known, to that of the right pressure on a finer mesh. None: the moment is not known.
std::optional<double> moment_error(const Examination& e) {
  const solver::TorsionLoad& torsion = e.scene.steps.front().torsion;
  if (std::holds_alternative<solver::Twist>(torsion)) return e.deviation.moment;
  if (!e.moment || *e.moment == 0.0) return std::nullopt;
  const double error = relative_error(e.contact.moment(), *e.moment);
  const auto ratio = solver::value_if<solver::MomentRatio>(torsion);
  if (!ratio) return error;
  const double of_own_limit = relative_error(e.contact.moment(), *ratio * e.moment_limit);
  const double of_finer_limit = relative_error(e.contact.moment(), *ratio * e.reference.mesh.moment_limit);
  const bool exact = e.exact.oracle && std::isfinite(e.exact.oracle->moment);
  return std::min({error, of_own_limit, exact ? error : of_finer_limit},
                  [](double a, double b) { return std::abs(a) < std::abs(b); });
}

void judge_loads(std::vector<Judged>& judged, const Examination& e, const Allowed& allowed) {
  if (const auto error = moment_error(e)) {
    Judged moment = judge_error("the moment", "moment_error", *error, allowed.moment);
    moment.right = "the moment is right";
    if (!(e.stick > 0.0).any()) moment.wrong += ": all of the contact slips, and friction carries no more";
    judged.push_back(moment);
  }
  judged.push_back({"force", e.certificate.force, allowed.force, "",
                    fmt::format("the tangential force is off by {} of mu W{}", percent(e.certificate.force),
                                allowed_text(allowed.force))});
}

/// Whether the scene has no tangential force and imposes no displacement.
bool is_torsion(const solver::Scene& scene) { return !solver::brings_translation(scene.steps.front()); }

/// Judges motion and tractions. Where the law of friction is broken, an inferred twist means little: no
/// sentence mentions it.
void judge_motion(std::vector<Judged>& judged, const Examination& e, const Allowed& allowed, bool lawful) {
  if (e.reference.right.scaled) return;  // the right motion and tractions are those of other loads
  const bool torsion = is_torsion(e.scene);
  const double error = e.deviation.motion;
  Judged motion = torsion ? judge_error("the twist", "twist", error, allowed.motion)
                          : judge_error("the rigid motion", "motion", error, allowed.motion);
  if (torsion && e.twist_given) motion.right = "the twist is right";
  if (!e.twist_given && !lawful) motion.wrong.clear();
  judged.push_back(motion);
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
  const solver::FrictionKind kind = e.scene.friction.kind;
  const std::string law = solver::law_text(kind);
  judged.push_back(judge_error(
      e.scene.friction.is_coulomb() ? "|q|/p in the slip ring" : "|q| over its bound in the slip ring",
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
  return holds(judged, "normal_load_error") && holds(judged, "pressure");
}

/// The kernel's name, with the twist that follows from it.
std::string kernel_text(const Hypothesis& kernel, const Examination& e) {
  if (e.reference.right.scaled || !is_torsion(e.scene)) return kernel.name;
  return kernel.name + fmt::format(" (the twist is {:.6g} rad with that, {})", kernel.twist,
                                   off_text(relative_error(kernel.twist, e.reference.right.twist)));
}

/// The mistake that explains the ratio of the reported twist to the one that fits the tractions.
std::string twist_mistake(const Examination& e, double allowed) {
  struct Ratio {
    double value;
    const char* words;
  };
  const auto compliance = [](const solver::Material& m) {  // of a coated body there is no single one
    return m.coating ? std::nan("") : (1.0 + m.poisson_ratio) / m.young_modulus;
  };
  const double lower = compliance(e.scene.lower);
  const double upper = compliance(e.scene.upper);
  const auto& exact = e.exact.oracle;
  const double normalised = exact ? exact->state.twist / exact->twist_angle : std::nan("");
  const std::array<Ratio, 7> ratios{{{lower / (lower + upper), "the compliance of one body only"},
                                     {upper / (lower + upper), "the compliance of one body only"},
                                     {2.0, "twice the compliance of the pair"},
                                     {180.0 / std::numbers::pi, "a twist in degrees"},
                                     {1e3, "a twist in mrad"},
                                     {-1.0, "a twist of the other sense"},
                                     {normalised, "the normalised twist of a result, G a^2 phi/(mu W)"}}};
  for (const Ratio& ratio : ratios) {
    if (std::abs(e.state.twist / e.fitted.twist / ratio.value - 1.0) <= allowed) return ratio.words;
  }
  return fmt::format("a twist that is not that of these tractions, {:.6g} rad", e.fitted.twist);
}

/// Tractions of a smaller load than the scene's, which are right under their own: those of the step before
/// the last of N equal ones, or of some other where the reported twist is that of the scene's load.
std::optional<std::string> step_before(const Examination& e, const std::vector<Judged>& judged,
                                       const Allowed& allowed) {
  constexpr double kMostSteps = 10.0;  // more steps stand too close to be told from other mistakes
  const bool others_hold = std::ranges::all_of(judged, [](const Judged& item) {
    return item.holds() || item.quantity == "moment_error" || item.quantity == "twist";
  });
  const auto error = moment_error(e);
  if (!others_hold || !error || holds(judged, "moment_error") || !(*error < 0.0)) return std::nullopt;
  const double steps = std::round(-1.0 / *error);
  const double apart = std::abs(1.0 + *error * steps) / steps;
  if (steps <= kMostSteps && apart <= std::min(allowed.moment, 0.05 / (steps * (steps + 1.0)))) {
    return fmt::format("tractions one step late: those of the step before the last of {}", steps);
  }
  const bool twist_of_scene =
      e.twist_given && e.exact.oracle && !holds(judged, "twist") &&
      std::abs(relative_error(e.state.twist, e.exact.oracle->twist_angle)) <= allowed.motion;
  if (twist_of_scene) return "tractions one step late: the twist is that of the scene's load";
  return std::nullopt;
}

/// Names only mistakes whose correction would leave a good field.
std::vector<std::string> causes(const Examination& e, const std::vector<Judged>& judged,
                                const std::optional<Diagnosis>& diagnosis,
                                const std::optional<OtherFriction>& shown, const Allowed& allowed) {
  std::vector<std::string> causes;
  constexpr double kSampled = 1e-3;   // relative error in L1 of exact values at cell centres, rounded
  constexpr double kCollapsed = 0.1;  // gap that a kernel leaves, over the gap that it explains
  if (!has_right_pressure(judged) && e.exact.oracle && !std::isfinite(e.exact.oracle->peak_pressure) &&
      pressure_error(e.contact.stress_unit * e.contact.pressure, *e.exact.oracle, e.contact.grid_in_m()).l1 <=
          kSampled) {
    causes.emplace_back(
        "a pressure that is infinite at a place, sampled at cell centres in place of averaged");
  }
  if (!has_right_pressure(judged) && causes.empty()) {
    auto mistake = lost_rows(e, allowed.pressure);
    if (!mistake && holds(judged, "normal_load_error")) mistake = mistaken_scene(e, allowed.pressure);
    if (mistake) causes.push_back(std::move(*mistake));
  }
  if (const auto late = step_before(e, judged, allowed)) causes.push_back(*late);
  if (!diagnosis || !has_right_pressure(judged) || !causes.empty()) return causes;
  const bool others_hold = std::ranges::all_of(
      judged, [](const Judged& item) { return item.holds() || item.quantity == "twist"; });
  if (e.twist_given && !holds(judged, "twist") && others_hold) {
    causes.push_back(twist_mistake(e, allowed.motion));
    return causes;
  }
  // A cause has to lower the gap to what is allowed, and clearly: the mesh alone may nearly explain it.
  const double left = e.constant_cells ? allowed.discrete_gap : allowed.gap;
  const double gap = std::min(left, kCollapsed * diagnosis->reference_kernel.gap);
  if (const auto& friction = diagnosis->friction;
      friction && friction->gap <= left && keeps_friction(e.contact, *shown, allowed.tractions)) {
    causes.push_back(friction->name);
    return causes;
  }
  const bool directions = holds(judged, "friction") && holds(judged, "moment_error") &&
                          !holds(judged, "slip_direction") && diagnosis->stick_area_explained;
  if (const auto& kernel = diagnosis->kernel) {
    const bool explains = kernel->gap <= gap || (directions && kernel->stick_gap <= kIterationGap);
    if (explains) causes.push_back(kernel_text(*kernel, e));
    if (!explains || kernel->gap <= gap) return causes;
  } else if (!directions_explain(e.contact, e.reference.right, allowed.tractions)) {
    return causes;
  }
  if (directions)
    causes.emplace_back("slipping cells that keep a direction which does not oppose their slip");
  return causes;
}

/// The likely causes, what else is wrong, and what is right.
std::string details_of(const std::vector<Judged>& judged, const Judged& discrete,
                       const std::vector<std::string>& causes) {
  std::vector<std::string> right;
  std::vector<std::string> wrong;
  const bool lawful = holds(judged, "slip_direction") && holds(judged, "gap") && holds(judged, "tractions") &&
                      holds(judged, "friction");
  for (const Judged& item : judged) {
    if (item.holds() && item.quantity == "gap" && !lawful) continue;  // that the law holds would mislead
    const std::string& text = item.holds() ? item.right : item.wrong;
    if (!text.empty()) (item.holds() ? right : wrong).push_back(text);
  }
  const bool good = all_hold(judged);
  std::vector<std::string> parts;
  if (!causes.empty()) parts.push_back(fmt::format("it looks like {}", fmt::join(causes, ", and like ")));
  if (wrong.size() > 1) parts.push_back("besides, " + listed({wrong.begin() + 1, wrong.end()}));
  if (!right.empty()) parts.push_back(listed(right));
  if (good || discrete.holds()) parts.push_back(discrete.holds() ? discrete.right : discrete.wrong);
  return fmt::format("{}", fmt::join(parts, "; "));
}

/// The first quantity that is wrong, in the order in which one follows from another.
std::string headline_of(const Examination& e, const std::vector<Judged>& judged, const Allowed& allowed) {
  for (const Judged& item : judged) {
    if (!item.holds() && !item.wrong.empty()) return item.wrong;
  }
  std::string text = "right within its mesh";
  if (!e.reference.pressure) {
    text += e.pressure_given ? ", with the pressure taken as given"
                             : ", with the pressure taken as it is (the scene's is solved on other cells)";
  }
  if (e.reference.right.scaled) return text;
  return text + fmt::format(": the tractions are {} off in the mean{}", percent(e.deviation.tractions),
                            allowed_text(allowed.tractions));
}

/// Whether a field of constant cells that does not solve its own grid's problem solves it with a wrong
/// kernel: an iteration that stopped too early leaves a gap with any.
bool is_solved_with_other_kernel(const Examination& e, const Allowed& allowed) {
  if (!e.constant_cells || is_coated(e.scene) || e.deviation.gap <= allowed.discrete_gap) return false;
  const Diagnosis found = diagnose(e.contact, e.scene.steps.front(), allowed.gap);
  return found.kernel && found.kernel->gap <= allowed.discrete_gap;
}

}  // namespace

bool Verdict::within_mesh() const { return all_hold(judged); }

Verdict reach_verdict(const Examination& e, std::optional<double> tolerance) {
  Allowed allowed = find_allowed(e, tolerance);
  if (!tolerance && is_solved_with_other_kernel(e, allowed)) allowed.gap = allowed.discrete_gap;
  std::vector<Judged> judged;
  judge_pressure(judged, e, allowed);
  judge_loads(judged, e, allowed);
  std::vector<Judged> law;
  judge_friction(law, e, allowed);
  const bool lawful = all_hold(law);
  // Friction comes first, then motion and tractions, which follow from it; slip direction and gap come last.
  const auto follows = law.begin() + 2;
  judged.insert(judged.end(), law.begin(), follows);
  judge_motion(judged, e, allowed, lawful);
  judged.insert(judged.end(), follows, law.end());
  std::optional<OtherFriction> friction;
  std::optional<Diagnosis> diagnosis;
  if (!lawful || !holds(judged, "tractions") || !holds(judged, "twist") || !holds(judged, "motion")) {
    if (!holds(judged, "friction") || !holds(judged, "friction_bound"))
      friction = friction_shown(e.contact, e.reference.right, e.reference.regions);
    diagnosis = diagnose(e.contact, e.scene.steps.front(), allowed.gap, friction, !is_coated(e.scene));
  }
  const Judged discrete = judge_discrete(e, allowed);
  return {judged, discrete, diagnosis, headline_of(e, judged, allowed),
          details_of(judged, discrete, causes(e, judged, diagnosis, friction, allowed))};
}

}  // namespace slipstick::convergence
