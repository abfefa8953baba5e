#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <tuple>
#include <utility>
#include <vector>

#include "convergence/check/check.hpp"
#include "convergence/oracle/errors.hpp"
#include "solver/input/input_error.hpp"
#include "solver/model/make_model.hpp"

namespace slipstick::convergence {
namespace {

using Eigen::ArrayXd;
using solver::Material;
using solver::Scene;

/// Cells of a field up to which some dozen scenes are solved: a second or two of work.
constexpr double kQuickCells = 128.0 * 128.0;

struct Body {
  Material Scene::*member;
  const char* name;
};
constexpr std::array<Body, 2> kBodies{{{&Scene::lower, "lower"}, {&Scene::upper, "upper"}}};

/// How far a field's pressure is from that of another scene.
double off_from(const Examination& e, const Scene& scene) {
  try {
    const solver::Model model = solver::make_model(scene);
    ForeignField field = e.read.field;
    field.pressure = e.contact.stress_unit * e.contact.pressure;
    field.traction = e.contact.stress_unit * e.contact.traction;
    field.pressure_rounding = field.traction_rounding = 0.0 * field.pressure;
    const GivenContact contact = pose(field, model, model.threads);
    const auto right = find_scene_pressure(contact, scene, model);
    return right ? right->off : std::numeric_limits<double>::infinity();
  } catch (const solver::InputError&) {  // no scene that can be solved
    return std::numeric_limits<double>::infinity();
  }
}

struct MistakenScene {
  Cause cause;
  Scene scene;
};

constexpr const char* kOneCompliance = "only one body's compliance is counted";

std::string compliance_times(double factor) {
  return fmt::format("the compliance of the pair is multiplied by {:.3g}", factor);
}

/// Scenes with one mistake each.
std::vector<MistakenScene> mistaken_scenes(const Scene& scene) {
  std::vector<MistakenScene> mistakes;
  const auto add = [&](const std::string& sentence, const auto& change) {
    change(mistakes.emplace_back(MistakenScene{{sentence}, scene}).scene);
  };
  for (const Body& each : kBodies) {
    const auto member = each.member;
    const Material& body = scene.*member;
    if (!std::isinf(body.young_modulus)) {
      add(kOneCompliance, [&](Scene& s) { s.*member = {std::numeric_limits<double>::infinity(), 0.0}; });
    }
    if (!body.coating) continue;
    add(fmt::format("the layer on the {} body is ignored", each.name), [&](Scene& s) { (s.*member).coating.reset(); });
    add(fmt::format("the constants of the {} body and of its layer are exchanged", each.name), [&](Scene& s) {
      Material& other = s.*member;
      std::swap(other.young_modulus, other.coating->young_modulus);
      std::swap(other.poisson_ratio, other.coating->poisson_ratio);
    });
  }
  if (is_coated(scene))
    add("the layer is on the other body", [](Scene& s) { std::swap(s.upper.coating, s.lower.coating); });
  if (scene.layer.kind != nullptr) add("the layer between the bodies is ignored", [](Scene& s) { s.layer = {}; });
  for (const double factor : {0.5, 2.0}) {
    add(compliance_times(factor), [&](Scene& s) {
      for (const Body& body : kBodies) (s.*body.member).young_modulus /= factor;
    });
    if (scene.surfaces.size() == 1 && scene.surfaces.front().shape == solver::Shape::sphere)
      add(fmt::format("the radius is multiplied by {:.3g}", factor),
          [&](Scene& s) { s.surfaces.front().radius *= factor; });
  }
  return mistakes;
}

/// The factor within 1/kWidest and kWidest under which a changed scene is nearest, by golden sections of its logarithm.
template <typename Off>
std::pair<double, double> nearest_factor(const Off& off) {
  constexpr double kWidest = 8.0;
  constexpr double kGolden = 0.6180339887498949;
  constexpr int kSections = 15;
  double low = -std::log(kWidest);
  double high = std::log(kWidest);
  double best = high - kGolden * (high - low);
  double at_best = off(std::exp(best));
  for (int i = 0; i < kSections; ++i) {
    const double next = low + high - best;  // its image in the interval, which then ends at the worse one
    const double at_next = off(std::exp(next));
    const bool nearer = next < best ? at_next < at_best : at_next <= at_best;
    const double worse = nearer ? best : next;
    (worse < low + high - worse ? low : high) = worse;
    if (nearer) std::tie(best, at_best) = std::pair(next, at_next);
  }
  return {std::exp(best), at_best};
}

std::optional<Cause> fitted_mistake(const Examination& e, double allowed) {
  for (const auto& [member, name] : kBodies) {
    if (!(e.scene.*member).coating) continue;
    const double thickness = (e.scene.*member).coating->thickness;
    const auto [factor, off] = nearest_factor([&, of = member](double times) {
      Scene scene = e.scene;
      (scene.*of).coating->thickness *= times;
      return off_from(e, scene);
    });
    if (off <= allowed) {
      return Cause{fmt::format("the layer on the {} body is {:.3g} m thick instead of {:.4g} m", name,
                               factor * thickness, thickness)};
    }
  }
  const auto [factor, off] = nearest_factor([&](double times) {
    Scene scene = e.scene;
    for (const Body& body : kBodies) {
      Material& material = scene.*body.member;
      material.young_modulus *= times;
      if (material.coating) material.coating->young_modulus *= times;
    }
    return off_from(e, scene);
  });
  if (!(off <= allowed)) return std::nullopt;
  return Cause{fmt::format("the elastic moduli are multiplied by {:.3g}", factor)};
}

/// The mistakes in bodies and layers that explain a field's pressure: the normal contact of the scene with one of them,
/// solved on the field's cells, is the field's up to `allowed`. All that give it are listed; if none does, one with a
/// fitted number (a layer's thickness, the moduli). Larger contacts than kQuickCells are not tried.
std::vector<Cause> mistakes_in_pressure(const Examination& e, double allowed) {
  const bool solved = e.reference.pressure && e.scene.contact.pressure != solver::PressureModel::file;
  if (!solved || static_cast<double>(e.contact.grid.cells()) > kQuickCells) return {};
  std::vector<Cause> causes;
  for (MistakenScene& mistaken : mistaken_scenes(e.scene)) {
    const bool known = std::ranges::find(causes, mistaken.cause.sentence, &Cause::sentence) != causes.end();
    if (known || !(off_from(e, mistaken.scene) <= allowed)) continue;
    mistaken.cause.alternative = !causes.empty();
    causes.push_back(std::move(mistaken.cause));
  }
  if (causes.empty()) {
    if (auto cause = fitted_mistake(e, allowed)) causes.push_back(std::move(*cause));
  }
  return causes;
}

/// Rows that are missing, where the field has the scene's pressure up to `allowed` but for cells without any.
std::optional<Cause> lost_rows(const Examination& e, double allowed) {
  constexpr double kCarriesSomething = 0.05;  // of the largest pressure: no edge of any right field
  if (!e.reference.pressure) return std::nullopt;
  const ArrayXd& right = e.reference.pressure->values;
  const ArrayXd& found = e.contact.pressure;
  const ArrayXd there = (found > 0.0).cast<double>();
  const auto lost = ((found == 0.0) && (right > kCarriesSomething * right.maxCoeff())).count();
  const double off = (there * (found - right).abs()).sum() / (there * right).sum();
  if (lost == 0 || !(off <= allowed)) return std::nullopt;
  return Cause{fmt::format("the file lacks rows: {} cells where the scene has pressure have none", lost)};
}

/// Whether a pressure that is infinite somewhere has the exact values at cell centres, which miss its load.
bool is_sampled_singularity(const Examination& e) {
  constexpr double kSampled = 1e-3;  // relative error in L1 of exact values at cell centres, rounded
  return e.exact.oracle && !std::isfinite(e.exact.oracle->normal.peak_pressure) &&
         pressure_error(e.contact.stress_unit * e.contact.pressure, *e.exact.oracle, e.contact.grid_in_m()).l1 <=
             kSampled;
}

/// The mistake that explains the ratio of the reported twist to the one that fits the tractions.
Cause twist_mistake(const Examination& e, double allowed) {
  struct Ratio {
    double value;
    std::string sentence;
  };
  const auto compliance = [](const solver::Material& m) {  // of a coated body there is no single one
    return m.coating ? std::nan("") : (1.0 + m.poisson_ratio) / m.young_modulus;
  };
  const double lower = compliance(e.scene.lower);
  const double upper = compliance(e.scene.upper);
  const auto& exact = e.exact.oracle;
  const double normalised = exact ? exact->state.twist / exact->twist_angle : std::nan("");
  for (const auto& [ratio, sentence] : {Ratio{lower / (lower + upper), kOneCompliance},
                                        {upper / (lower + upper), kOneCompliance},
                                        {2.0, compliance_times(2.0)},
                                        {180.0 / std::numbers::pi, "the twist is in degrees"},
                                        {1e3, "the twist is in mrad"},
                                        {-1.0, "the twist has the opposite sign"},
                                        {normalised, "the twist is the normalised one, G a^2 phi/(mu W)"}}) {
    if (std::abs(e.state.twist / e.fitted.twist / ratio - 1.0) <= allowed) return {sentence};
  }
  return {fmt::format("the twist does not belong to these tractions, whose own is {:.6g} rad", e.fitted.twist)};
}

/// Tractions that are right under a smaller load than the scene's: of the step before the last of N equal
/// ones, or of any step where the reported twist belongs to the scene's load.
std::optional<Cause> late_step(const Examination& e, const Verdict& verdict) {
  constexpr double kMostSteps = 10.0;  // more steps are too close to distinguish them from other mistakes
  const bool others_hold = std::ranges::all_of(verdict.judged, [](const Judged& item) {
    return item.holds() || item.quantity == "moment_error" || item.quantity == "twist";
  });
  const auto error = moment_error(e);
  if (!others_hold || !error || verdict.holds("moment_error") || !(*error < 0.0)) return std::nullopt;
  const double steps = std::round(-1.0 / *error);
  const double apart = std::abs(1.0 + *error * steps) / steps;
  if (steps <= kMostSteps && apart <= std::min(verdict.allowed.moment, 0.05 / (steps * (steps + 1.0))))
    return Cause{fmt::format(
        "the tractions are one step late: they belong to the step before the last of {:.0f} equal steps", steps)};
  const bool twist_of_scene =
      e.twist_given && e.exact.oracle && !verdict.holds("twist") &&
      std::abs(relative_error(e.state.twist, e.exact.oracle->twist_angle)) <= verdict.allowed.motion;
  if (!twist_of_scene) return std::nullopt;
  return Cause{"the tractions are one step late: only the twist belongs to the scene's load"};
}

/// A wrong kernel, with the twist that follows from it.
Cause kernel_cause(const Hypothesis& kernel, const Examination& e) {
  Cause cause = kernel.cause;
  if (e.reference.right.scaled || !is_torsion(e.scene)) return cause;
  cause.sentence += fmt::format(" (then the twist is {:.6g} rad, {})", kernel.twist,
                                off_text(relative_error(kernel.twist, e.reference.right.twist)));
  return cause;
}

/// Another friction, a wrong kernel, directions that slipping cells keep.
std::vector<Cause> causes_in_tractions(const Examination& e, const Verdict& verdict, const Diagnosis& diagnosis,
                                       const std::optional<OtherFriction>& shown) {
  constexpr double kCollapsed = 0.1;  // gap that a kernel leaves, over the gap that it explains
  const Allowed& allowed = verdict.allowed;
  // A cause lowers the gap to the allowed one, and clearly: the mesh may nearly explain it.
  const double left = e.constant_cells ? allowed.discrete_gap : allowed.gap;
  const double gap = std::min(left, kCollapsed * diagnosis.reference_kernel.gap);
  if (const auto& friction = diagnosis.friction;
      friction && friction->gap <= left && keeps_friction(e.contact, *shown, allowed.tractions))
    return {friction->cause};
  const bool directions = verdict.holds("friction") && verdict.holds("moment_error") &&
                          !verdict.holds("slip_direction") && diagnosis.stick_area_explained;
  std::vector<Cause> causes;
  if (const auto& kernel = diagnosis.kernel) {
    const bool explains = kernel->gap <= gap || (directions && kernel->stick_gap <= kIterationGap);
    if (explains) causes.push_back(kernel_cause(*kernel, e));
    if (!explains || kernel->gap <= gap) return causes;
  } else if (!directions_explain(e.contact, e.reference.right, allowed.tractions)) {
    return causes;
  }
  if (directions) causes.push_back({"slipping cells keep a direction that does not oppose their slip"});
  return causes;
}

}  // namespace

Explanation explain(const Examination& e, const Verdict& verdict) {
  const auto all_hold = [&](std::initializer_list<const char*> quantities) {
    return std::ranges::all_of(quantities, [&](const char* quantity) { return verdict.holds(quantity); });
  };
  Explanation found;
  std::optional<OtherFriction> friction;
  if (!all_hold({"friction", "friction_bound", "slip_direction", "gap", "tractions", "twist", "motion"})) {
    if (!all_hold({"friction", "friction_bound"}))
      friction = friction_shown(e.contact, e.reference.right, e.reference.regions);
    found.diagnosis = diagnose(e.contact, e.scene.steps.front(), verdict.allowed.gap, friction, !is_coated(e.scene));
  }
  const bool right_pressure = all_hold({"normal_load_error", "pressure"});
  if (!right_pressure) {
    if (is_sampled_singularity(e)) {
      found.causes = {{"a pressure with an infinite value is sampled at cell centres instead of averaged over cells"}};
    } else if (const auto lost = lost_rows(e, verdict.allowed.pressure)) {
      found.causes = {*lost};
    } else if (verdict.holds("normal_load_error")) {
      found.causes = mistakes_in_pressure(e, verdict.allowed.pressure);
    }
  }
  if (const auto late = late_step(e, verdict)) found.causes.push_back(*late);
  if (!found.diagnosis || !right_pressure || !found.causes.empty()) return found;
  const bool others_hold =
      std::ranges::all_of(verdict.judged, [](const Judged& item) { return item.holds() || item.quantity == "twist"; });
  found.causes = e.twist_given && !verdict.holds("twist") && others_hold
                     ? std::vector<Cause>{twist_mistake(e, verdict.allowed.motion)}
                     : causes_in_tractions(e, verdict, *found.diagnosis, friction);
  return found;
}

}  // namespace slipstick::convergence
