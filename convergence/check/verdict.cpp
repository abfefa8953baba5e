#include "convergence/check/verdict.hpp"

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "solver/solution.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;

constexpr double kDegrees = 180.0 / std::numbers::pi;
/// The right answers on a mesh and on one of half its size differ by half of the coarser one's error at
/// least, where errors fall like h or faster: twice the difference bounds what the mesh accounts for.
constexpr double kWholeMeshError = 2.0;
/// A gap goes with the square of the error of tractions.
constexpr double kWholeMeshGap = kWholeMeshError * kWholeMeshError;
/// Friction coefficients are not known to more digits.
constexpr double kFrictionSlack = 1e-3;

/// "5.1 % too low", or "right to 2e-05".
std::string off_text(double error) {
  constexpr double percent = 100.0;
  return fmt::format("{:.2g} % too {}", percent * std::abs(error), error < 0.0 ? "low" : "high");
}

Judged judge_error(const std::string& what, const std::string& key, double error, double allowed) {
  return {key, std::abs(error), allowed, "", fmt::format("{} is {}", what, off_text(error))};
}

/// Normal load and pressure. A contact may end a cell too early or too late, and its limit moment goes with
/// its radius.
void judge_pressure(std::vector<Judged>& judged, const Examination& e, double allowed) {
  const solver::Step& load = e.scene.steps.front();
  const solver::Model& model = e.contact.model;
  if (load.normal) {
    judged.push_back(judge_error("the normal load", "normal_load_error",
                                 relative_error(e.contact.pressure.sum() * e.newtons(), *load.normal),
                                 allowed));
  }
  if (!e.exact.oracle || !std::isfinite(e.exact.oracle->contact_radius)) return;
  const double radius = e.exact.oracle->contact_radius / model.length_unit;
  const double one_cell =
      std::max(model.grid.h1, model.grid.h2) * model.length_unit / e.exact.oracle->shorter_semi_axis();
  judged.push_back(judge_error("the contact radius", "contact_radius_error",
                               relative_error(measure_contact_radius(model, e.contact.pressure), radius),
                               one_cell));
  const double limit = e.exact.oracle->moment_limit / e.newton_metres();
  if (!std::isfinite(limit)) return;
  judged.push_back(judge_error("the limit moment of the pressure (its shape is not the exact one)",
                               "moment_limit_error", relative_error(e.moment_limit, limit), one_cell));
}

/// A ratio of the limit moment may be one of the exact limit, or of that of the field's own pressure.
double moment_error(const Examination& e) {
  const double error = relative_error(e.contact.moment(), *e.moment);
  const auto& ratio = e.scene.steps.front().torsion.moment_ratio;
  if (!ratio) return error;
  const double of_own_limit = relative_error(e.contact.moment(), *ratio * e.moment_limit);
  return std::abs(of_own_limit) < std::abs(error) ? of_own_limit : error;
}

void judge_loads(std::vector<Judged>& judged, const Examination& e, double allowed) {
  if (e.moment && *e.moment != 0.0) {
    const double error = moment_error(e);
    Judged moment = judge_error("the moment", "moment_error", error, allowed);
    moment.right = fmt::format("the moment is right ({:+.1e})", error);
    judged.push_back(moment);
  }
  judged.push_back({"force", e.certificate.force, allowed, "",
                    fmt::format("the tangential force is off by {:.2g} of mu W", e.certificate.force)});
}

/// Relative error of tractions, L1, that mesh and digits account for.
double allowed_error(const Examination& e) {
  const GivenContact& c = e.contact;
  const double rounding = c.traction_rounding.sum() / solver::norms(c.traction).sum();
  return kWholeMeshError * e.yardstick.mesh_error + rounding;
}

/// By how much rounding in the file may change the gap.
double rounding_gap(const Examination& e) {
  const GivenContact& c = e.contact;
  const ArrayXd reach = solver::norms(e.slip) + solver::norms(c.displacement);
  return ((c.traction_rounding + c.bound_rounding) * reach).sum() / c.energy();
}

/// By what part of mu p |q| exceeds it, beyond what the file's digits leave open. In cells that carry next to
/// nothing, of a part of the largest mu p.
double friction_excess(const GivenContact& c) {
  const ArrayXd beyond =
      solver::norms(c.traction) - c.friction_bound - c.traction_rounding - c.bound_rounding;
  return (beyond / c.friction_bound.max(kNextToNothing * c.friction_bound.maxCoeff())).maxCoeff();
}

double allowed_gap(const Examination& e) { return kWholeMeshGap * e.yardstick.gap + rounding_gap(e); }

bool is_torsion(const solver::Scene& scene) {
  const solver::Step& load = scene.steps.front();
  return !load.displacement && load.force == std::array<double, 2>{};
}

/// Of the rigid motion, in the mean over the contact weighted with mu p, relative to the motion or to the
/// displacements, whichever are larger; its sign is that of the change in size. With torsion alone it is the
/// twist's.
double motion_error(const Examination& e) {
  const GivenContact& c = e.contact;
  const auto size = [&](const ArrayXd& motion) { return (c.friction_bound * solver::norms(motion)).sum(); };
  const ArrayXd found = rigid_motion(c, e.displacement, e.twist);
  const ArrayXd right = rigid_motion(c, e.yardstick.displacement, e.yardstick.twist);
  return std::copysign(size(found - right), size(found) - size(right)) /
         std::max(size(right), size(c.displacement));
}

/// A twist that was inferred from a field that breaks Coulomb's law means little: no sentence speaks of it.
void judge_motion(std::vector<Judged>& judged, const Examination& e, double allowed, bool lawful) {
  if (e.yardstick.scaled) return;  // the right motion is that of other loads
  const bool torsion = is_torsion(e.scene);
  const double error = motion_error(e);
  Judged motion = torsion ? judge_error("the twist", "twist", error, allowed)
                          : judge_error("the rigid motion", "motion", error, allowed);
  if (torsion) {
    motion.right = fmt::format("the twist is right ({}{:+.1e})", e.twist_given ? "" : "inferred, ", error);
  }
  if (!e.twist_given && !lawful) motion.wrong.clear();
  judged.push_back(motion);
}

void judge_coulomb(std::vector<Judged>& judged, const Examination& e, double allowed) {
  const double excess = friction_excess(e.contact);
  judged.push_back({"friction_bound", excess, kFrictionSlack, "",
                    fmt::format("|q| exceeds mu p by {:.2g} %", 100.0 * excess)});
  const bool within_friction = judged.back().holds();
  const double degrees = kDegrees * allowed;
  judged.push_back(
      {"slip_direction", e.direction.mean, degrees,
       fmt::format("slip opposes traction to {:.1g} degrees in the mean", e.direction.mean),
       fmt::format("slip is not opposed to traction ({:.2g} degrees off in the mean, of which the "
                   "mesh accounts for {:.1g})",
                   e.direction.mean, degrees)});
  if (!within_friction) return;  // what it sums is not positive then
  judged.push_back({"gap", e.certificate.gap, allowed_gap(e),
                    fmt::format("Coulomb's law holds (gap/energy {:.1e}; the mesh accounts for {:.1e})",
                                e.certificate.gap, allowed_gap(e)),
                    fmt::format("Coulomb's law is broken (gap/energy {:.1e}; the mesh accounts for {:.1e})",
                                e.certificate.gap, allowed_gap(e))});
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

bool has_right_pressure(const std::vector<Judged>& judged) {
  return holds(judged, "normal_load_error") && holds(judged, "moment_limit_error");
}

/// How sure that kernel is: by how much it lowers the gap of the stick area, and the twist that it leads to.
std::string kernel_text(const Hypothesis& kernel, const Hypothesis& right, const Examination& e) {
  std::string text =
      fmt::format("{}: with that the stick area moves as one body (its gap falls from {:.1e} to {:.1e})",
                  kernel.name, right.stick_gap, kernel.stick_gap);
  if (e.yardstick.scaled || !is_torsion(e.scene)) return text;
  return text + fmt::format(" by {:.6g} rad, {}", kernel.twist,
                            off_text(relative_error(kernel.twist, e.yardstick.twist)));
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
    if (std::abs(e.twist / e.inferred_twist / ratio.value - 1.0) <= allowed) return ratio.words;
  }
  return fmt::format("a twist that is not that of these tractions, {:.6g} rad", e.inferred_twist);
}

std::vector<std::string> causes(const Examination& e, const Verdict& verdict, double allowed) {
  std::vector<std::string> causes;
  if (!has_right_pressure(verdict.judged) && e.exact.oracle &&
      !std::isfinite(e.exact.oracle->peak_pressure)) {
    causes.emplace_back(
        "a pressure that is infinite at a place, sampled at cell centres in place of averaged");
  }
  if (!verdict.diagnosis) return causes;
  const Diagnosis& diagnosis = *verdict.diagnosis;
  if (e.twist_given && diagnosis.as_it_should_be.gap <= allowed_gap(e)) {
    causes.push_back(twist_mistake(e, allowed));
  }
  if (diagnosis.friction) {
    causes.push_back(
        fmt::format("{} (gap/energy {:.1e} with that)", diagnosis.friction->name, diagnosis.friction->gap));
    return causes;
  }
  if (diagnosis.kernel) causes.push_back(kernel_text(*diagnosis.kernel, diagnosis.as_it_should_be, e));
  if (diagnosis.stick_area_explained && !holds(verdict.judged, "slip_direction")) {
    causes.emplace_back("slipping cells that keep a direction which does not oppose their slip");
  }
  return causes;
}

/// What is right, what is not, and what that looks like.
std::string sentence(const Examination& e, const Verdict& verdict, double allowed) {
  std::vector<std::string> right;
  std::vector<std::string> wrong;
  for (const Judged& item : verdict.judged) {
    const std::string& text = item.holds() ? item.right : item.wrong;
    if (!text.empty()) (item.holds() ? right : wrong).push_back(text);
  }
  if (wrong.empty()) return listed(right);
  const std::string but = right.empty() ? "" : listed(right) + ", but ";
  const std::vector<std::string> likely = causes(e, verdict, allowed);
  if (!likely.empty())
    return but + listed(wrong) + fmt::format("; it looks like {}", fmt::join(likely, ", and like "));
  const bool unexplained = verdict.diagnosis && has_right_pressure(verdict.judged);
  return but + listed(wrong) +
         (unexplained ? "; none of the usual mistakes explains it, as where an iteration stops too early"
                      : "");
}

}  // namespace

Verdict reach_verdict(const Examination& e) {
  const double allowed = allowed_error(e);
  Verdict verdict{true, "", {}, {}};
  judge_pressure(verdict.judged, e, allowed);
  judge_loads(verdict.judged, e, allowed);
  std::vector<Judged> law;
  judge_coulomb(law, e, allowed);
  const bool lawful = std::ranges::all_of(law, &Judged::holds);
  judge_motion(verdict.judged, e, allowed, lawful);
  verdict.judged.insert(verdict.judged.end(), law.begin(), law.end());
  verdict.good = std::ranges::all_of(verdict.judged, &Judged::holds);
  if (!lawful) {
    verdict.diagnosis = diagnose(e.contact, e.scene.steps.front(), allowed_gap(e));
  }
  verdict.why = sentence(e, verdict, allowed);
  return verdict;
}

}  // namespace slipstick::convergence
