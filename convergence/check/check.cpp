#include "convergence/check/check.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "convergence/oracle/errors.hpp"
#include "convergence/results/make_record.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/results/record_text.hpp"
#include "solver/contact/stick_front.hpp"
#include "solver/step/describe_step.hpp"

namespace slipstick::convergence {
namespace {

const std::string kNoNumber = "the exact value is zero or not known";
const std::string kBroken = "not a number";

/// Numbers of a field, in SI units.
struct FieldState {
  explicit FieldState(const Examination& e)
      : stick(find_stick_front(e.contact.grid, e.contact.friction_bound, e.state.slip, stick_cells(e.contact))) {
    const GivenContact& c = e.contact;
    const double length = c.length_unit;
    stick.radius *= length;
    stick.counted_radius *= length;
    normal_load = c.pressure.sum() * c.newtons();
    contact_radius = measure_contact_radius(c, c.pressure) * length;
    moment = c.moment() * c.newton_metres();
    moment_limit = e.moment_limit() * c.newton_metres();
    const auto [f1, f2] = c.force();
    force = {f1 * c.newtons(), f2 * c.newtons()};
    displacement = {e.state.displacement[0] * length, e.state.displacement[1] * length};
  }

  solver::StickFront stick;
  double normal_load, contact_radius, moment, moment_limit;
  std::array<double, 2> force, displacement;
};

TractionError traction_error_of(const Examination& e, const Eigen::ArrayXd& traction) {
  return traction_error(e.contact.stress_unit * traction, *e.exact.oracle, e.contact.grid_in_m());
}

/// Reason for errors that are missing although there is an exact answer.
const std::string& unknown_text(const Oracle& exact) {
  return exact.only_normal.empty() ? kNoNumber : exact.only_normal;
}

Json numbers(std::initializer_list<std::pair<const char*, double>> all, const std::string& reason) {
  Json json = Json::object();
  for (const auto& [key, value] : all) set_number(json, key, value, reason);
  return json;
}

Json judged_json(const std::vector<Judged>& judged) {
  Json list = Json::array();
  for (const Judged& item : judged) {
    Json& json = list.emplace_back(Json{{"quantity", item.quantity}});
    json.update(numbers({{"value", item.value}, {"allowed", item.allowed}}, kBroken));
    json.update({{"holds", item.holds()}});
  }
  return list;
}

Json hypothesis_json(const Hypothesis& hypothesis) {
  Json json{{"name", hypothesis.cause.sentence}};
  json.update(numbers({{"gap", hypothesis.gap}, {"stick_gap", hypothesis.stick_gap}, {"twist_angle", hypothesis.twist}},
                      kBroken));
  return json;
}

Json diagnosis_json(const Diagnosis& diagnosis) {
  Json tried = Json::array();
  for (const Hypothesis& hypothesis : diagnosis.tried) tried.push_back(hypothesis_json(hypothesis));
  Json json{{"as_it_should_be", hypothesis_json(diagnosis.reference_kernel)}};
  if (!tried.empty()) json.update({{"tried", tried}});
  const auto set_found = [&](const char* key, const std::optional<Hypothesis>& found) {
    if (found) {
      json.update({{key, found->cause.sentence}});
    } else {
      set_missing(json, key, "none that was tried explains the gap");
    }
  };
  set_found("kernel", diagnosis.kernel);
  set_found("friction", diagnosis.friction);
  json.update({{"stick_area_explained", diagnosis.stick_area_explained}});
  return json;
}

Json errors_json(const FieldState& state, const Examination& e) {
  Json json = Json::object();
  if (!e.exact.oracle) {
    for (const char* key : {"twist_error", "moment_error", "stick_radius_error", "contact_radius_error",
                            "pressure_error", "traction_error"})
      set_missing(json, key, e.exact.reason);
    return json;
  }
  const Oracle& exact = *e.exact.oracle;
  const std::string& unknown = unknown_text(exact);
  const auto set = [&](const char* key, double value, double right) {
    set_number(json, key, relative_error(value, right), std::isnan(right) ? unknown : kNoNumber);
  };
  set("twist_error", e.state.twist, exact.twist_angle);
  set("moment_error", state.moment, exact.moment);
  set("stick_radius_error", state.stick.radius, exact.stick_radius);
  set("stick_radius_counted_error", state.stick.counted_radius, exact.stick_radius);
  set("contact_radius_error", state.contact_radius, exact.contact_radius);
  const GivenContact& c = e.contact;
  json.update({{"pressure_error",
                to_json(make_field_error(pressure_error(c.stress_unit * c.pressure, exact, c.grid_in_m()), kNoNumber))},
               {"traction_error", to_json(make_traction_error(traction_error_of(e, c.traction), unknown))}});
  return json;
}

/// The numbers of the right answer on this mesh.
Json reference_json(const Examination& e) {
  const ReferenceOnGrid& reference = e.reference;
  Json json{{"mesh_error", reference.mesh.deviation.tractions},
            {"gap", reference.mesh.deviation.gap},
            {"slip_direction", reference.mesh.direction},
            {"twist_angle", reference.right.twist},
            {"constant_cells", e.constant_cells},
            {"loads_scaled_down", reference.right.scaled},
            {"distance", e.deviation.tractions},
            {"noise", reference.noise_size.maxCoeff() / e.contact.friction_bound.maxCoeff()}};
  if (e.exact.oracle && e.exact.oracle->shear) {
    json.update(
        {{"traction_error", to_json(make_traction_error(traction_error_of(e, reference.right.traction), kNoNumber))}});
  }
  return json;
}

/// A note without its reason.
std::string short_note(const std::string& note) { return note.substr(0, note.find(':')); }

/// Notes of mistakes, and with --strict of conventions; and the grid's problem if it is unsolved and
/// --discrete is given: each makes a field bad that is right within its mesh.
std::vector<std::string> faults_within_mesh(const FieldCheck& check) {
  const Interpretation& read = check.examination.read;
  std::vector<std::string> faults;
  for (const std::string& mistake : read.mistakes) faults.push_back(short_note(mistake));
  if (check.options.strict) {
    for (const std::string& convention : read.conventions) faults.push_back(short_note(convention));
  }
  const Judged& discrete = check.verdict.discrete;
  if (check.options.discrete && !discrete.holds()) faults.push_back(discrete.wrong);
  return faults;
}

std::string field_text(const FieldCheck& check) {
  const Examination& e = check.examination;
  const solver::Grid& grid = e.read.field.grid;
  std::string text = text_line("field", check.file.string());
  text += text_line("grid", fmt::format("{} x {} cells of {} x {} m, {} in contact, {} stick", grid.n1, grid.n2,
                                        number_text(grid.h1), number_text(grid.h2), (e.contact.pressure > 0.0).count(),
                                        (stick_cells(e.contact) > 0.0).count()));
  for (const auto& notes : {e.read.mistakes, e.read.conventions}) {
    for (const std::string& note : notes) text += text_line("note", note);
  }
  return text;
}

std::string state_text(const Examination& e) {
  const FieldState state(e);
  const auto error = [&](double found, double Oracle::*right) {
    constexpr double kNone = 1e-6;
    const double value = e.exact.oracle ? relative_error(found, (*e.exact.oracle).*right) : NAN;
    if (!std::isfinite(value)) return std::string();
    return std::abs(value) < kNone ? "   (no error)" : fmt::format("   (error {:+.1e})", value);
  };
  return text_line("normal load", number_text(state.normal_load) + " N") +
         text_line("contact radius",
                   number_text(state.contact_radius) + " m" + error(state.contact_radius, &Oracle::contact_radius)) +
         text_line("moment", fmt::format("{} N m, at most {}{}", number_text(state.moment),
                                         number_text(state.moment_limit), error(state.moment, &Oracle::moment))) +
         text_line("twist", number_text(e.state.twist) + " rad" + (e.twist_given ? "" : ", which fits the tractions") +
                                error(e.state.twist, &Oracle::twist_angle)) +
         text_line("stick radius",
                   number_text(state.stick.radius) + " m" + error(state.stick.radius, &Oracle::stick_radius));
}

std::string traction_text(const Examination& e) {
  if (!e.exact.oracle) return text_line("exact answer", "none: " + e.exact.reason);
  const FieldError found = traction_error_of(e, e.contact.traction).at_centres;
  if (!std::isfinite(found.l1)) return text_line("exact answer", unknown_text(*e.exact.oracle));
  const FieldError right = traction_error_of(e, e.reference.right.traction).at_centres;
  return text_line("traction error",
                   fmt::format("{} in L1, {} in L2; the right answer on this grid: {}, {}", number_text(found.l1),
                               number_text(found.l2), number_text(right.l1), number_text(right.l2)));
}

std::string certificate_text(const Examination& e) {
  return text_line("certificate", fmt::format("moment off by {}, |q| above {} by {}", number_text(e.certificate.moment),
                                              solver::bound_text(e.scene.contact.friction.kind),
                                              number_text(e.certificate.friction_bound))) +
         text_line("slip direction",
                   fmt::format("{} degrees off in the mean, {} at most ({})", number_text(e.direction.mean),
                               number_text(e.direction.max), right_direction_text(e.scene.contact.friction.kind)));
}

}  // namespace

bool FieldCheck::good() const { return verdict.within_mesh() && faults_within_mesh(*this).empty(); }

std::string FieldCheck::headline() const {
  for (const Judged& item : verdict.judged) {
    if (!item.holds() && !item.wrong.empty()) return item.wrong;
  }
  const std::string right = right_text(examination, verdict);
  const std::vector<std::string> faults =
      verdict.within_mesh() ? faults_within_mesh(*this) : std::vector<std::string>{};
  if (faults.empty()) return right;
  return fmt::format("{}; otherwise {}", fmt::join(faults, ", and "), right);
}

std::string FieldCheck::details() const {
  std::vector<std::string> right;
  std::vector<std::string> wrong;
  const bool lawful = verdict.holds("slip_direction") && verdict.holds("gap") && verdict.holds("tractions") &&
                      verdict.holds("friction");
  for (const Judged& item : verdict.judged) {
    if (item.holds() && item.quantity == "gap" && !lawful) continue;  // that the law holds would mislead
    const std::string& text = item.holds() ? item.right : item.wrong;
    if (!text.empty()) (item.holds() ? right : wrong).push_back(text);
  }
  std::string causes;
  for (const Cause& cause : explanation.causes) {
    causes += causes.empty() ? "likely cause: " : cause.alternative ? ", or " : ", and ";
    causes += cause.sentence;
  }
  const Judged& discrete = verdict.discrete;
  std::vector<std::string> parts;
  if (!causes.empty()) parts.push_back(causes);
  if (wrong.size() > 1) parts.push_back("also wrong: " + listed({wrong.begin() + 1, wrong.end()}));
  if (!right.empty()) parts.push_back(listed(right));
  if (verdict.within_mesh() || discrete.holds()) parts.push_back(discrete.holds() ? discrete.right : discrete.wrong);
  return fmt::format("{}", fmt::join(parts, "; "));
}

FieldCheck check_field(const solver::Scene& scene, const std::filesystem::path& file, const CheckOptions& options) {
  Examination examination = examine(scene, file, options);
  Verdict verdict = reach_verdict(examination, options.tolerance);
  Explanation explanation = explain(examination, verdict);
  return {file, options, std::move(examination), std::move(verdict), std::move(explanation)};
}

Json to_json(const FieldCheck& check) {
  const Examination& e = check.examination;
  const solver::Grid& grid = e.read.field.grid;
  const FieldState state(e);
  const Judged& discrete = check.verdict.discrete;
  const std::string headline = check.headline();
  const std::string details = check.details();
  Json json{{"name", e.scene.name}, {"field", check.file.string()}};
  if (!e.scene.contact.friction.is_coulomb()) json.update({{"friction_law", to_string(e.scene.contact.friction.kind)}});
  Json own_grid{{"holds", discrete.holds()}};
  set_number(own_grid, "gap", discrete.value, "|q| exceeds its bound: there is no gap");
  set_number(own_grid, "allowed", discrete.allowed, kBroken);
  json.update({{"verdict", check.good() ? "good" : "bad"},
               {"headline", headline},
               {"details", details},
               {"why", headline + (details.empty() ? "" : "; " + details)},
               {"pressure_given", e.pressure_given},
               {"within_mesh", check.verdict.within_mesh()},
               {"discrete", own_grid},
               {"cells", {grid.n1, grid.n2}},
               {"cell_size", {grid.h1, grid.h2}},
               {"centre", e.read.field.centre},
               {"contact_cells", (e.contact.pressure > 0.0).count()},
               {"stick_cells", (stick_cells(e.contact) > 0.0).count()},
               {"conventions", e.read.conventions},
               {"mistakes", e.read.mistakes},
               {"normal_load", state.normal_load},
               {"contact_radius", state.contact_radius}});
  set_number(json, "stick_radius", state.stick.radius, kBroken);
  if (!state.stick.why_counted.empty()) json.update({{"stick_radius_note", state.stick.why_counted}});
  json.update({{"stick_radius_counted", state.stick.counted_radius},
               {"moment", state.moment},
               {"moment_limit", state.moment_limit},
               {"force", state.force}});
  set_number(json, "twist_angle", e.state.twist, kBroken);
  json.update({{"twist_inferred", !e.twist_given}});
  set_number(json, "twist_that_fits", e.fitted.twist, kBroken);
  json.update({{"displacement", state.displacement}});
  json.update(errors_json(state, e));
  json.update({{"certificate", to_json(make_certificate(e.certificate, kBroken))},
               {"slip_direction", numbers({{"mean", e.direction.mean}, {"max", e.direction.max}}, kBroken)},
               {"yardstick", reference_json(e)},
               {"judged", judged_json(check.verdict.judged)}});
  if (check.explanation.diagnosis) json.update({{"diagnosis", diagnosis_json(*check.explanation.diagnosis)}});
  json.update({{"provenance", provenance(std::max(1, e.scene.solver.threads))}});
  return json;
}

std::string check_text(const FieldCheck& check) {
  std::vector<std::string> taken;
  for (const std::string& note : check.examination.read.conventions) taken.push_back(short_note(note));
  std::string text = check.good() ? "good" : "bad";
  if (!taken.empty()) text += fmt::format(" ({})", fmt::join(taken, "; "));
  text += fmt::format(": {}\n", check.headline());
  if (const std::string details = check.details(); !details.empty()) text += fmt::format("  {}\n", details);
  const Examination& e = check.examination;
  text += field_text(check) + state_text(e) + traction_text(e) + certificate_text(e);
  for (const Judged& item : check.verdict.judged) {
    text += text_line(item.holds() ? "holds" : "FAILS",
                      fmt::format("{:<20} {:>8}   allowed on this grid {}", item.quantity,
                                  number_text(item.value, "{:.1e}"), number_text(item.allowed, "{:.1e}")));
  }
  return text;
}

}  // namespace slipstick::convergence
