#include "convergence/check/check.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "convergence/check/examination.hpp"
#include "convergence/check/verdict.hpp"
#include "convergence/oracle/errors.hpp"
#include "convergence/results/make_record.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/results/record_text.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/contact/stick_front.hpp"
#include "solver/step/describe_step.hpp"

namespace slipstick::convergence {
namespace {

const std::string kNoNumber = "the exact value is zero or not known";
const std::string kBroken = "not a number";

Json judged_json(const std::vector<Judged>& judged) {
  Json list = Json::array();
  for (const Judged& item : judged) {
    Json& json = list.emplace_back(Json{{"quantity", item.quantity}});
    set_number(json, "value", item.value, kBroken);
    set_number(json, "allowed", item.allowed, kBroken);
    json["holds"] = item.holds();
  }
  return list;
}

Json hypothesis_json(const Hypothesis& hypothesis) {
  Json json{{"name", hypothesis.name}};
  set_number(json, "gap", hypothesis.gap, kBroken);
  set_number(json, "stick_gap", hypothesis.stick_gap, kBroken);
  set_number(json, "twist_angle", hypothesis.twist, kBroken);
  return json;
}

Json diagnosis_json(const Diagnosis& diagnosis) {
  Json json;
  json["as_it_should_be"] = hypothesis_json(diagnosis.reference_kernel);
  for (const Hypothesis& hypothesis : diagnosis.tried) json["tried"].push_back(hypothesis_json(hypothesis));
  const auto set_found = [&](const char* key, const std::optional<Hypothesis>& found) {
    if (found) {
      json[key] = found->name;
    } else {
      set_missing(json, key, "none that was tried explains the gap");
    }
  };
  set_found("kernel", diagnosis.kernel);
  set_found("friction", diagnosis.friction);
  json["stick_area_explained"] = diagnosis.stick_area_explained;
  return json;
}

void add_field(Json& json, const Examination& e) {
  const solver::Grid& grid = e.read.field.grid;
  json["cells"] = {grid.n1, grid.n2};
  json["cell_size"] = {grid.h1, grid.h2};
  json["centre"] = e.read.field.centre;
  json["contact_cells"] = (e.contact.pressure > 0.0).count();
  json["stick_cells"] = (e.stick > 0.0).count();
  json["conventions"] = e.read.conventions;
  json["mistakes"] = e.read.mistakes;
}

/// The stick front in m.
solver::StickFront stick_front_of(const Examination& e) {
  const GivenContact& c = e.contact;
  solver::StickFront front = find_stick_front(c.grid, c.friction_bound, e.state.slip, e.stick);
  front.radius *= c.length_unit;
  front.counted_radius *= c.length_unit;
  return front;
}

void add_state(Json& json, const Examination& e, const solver::StickFront& stick) {
  const GivenContact& c = e.contact;
  json["normal_load"] = c.pressure.sum() * c.newtons();
  json["contact_radius"] = measure_contact_radius(c, c.pressure) * c.length_unit;
  set_number(json, "stick_radius", stick.radius, kBroken);
  if (!stick.why_counted.empty()) json["stick_radius_note"] = stick.why_counted;
  json["stick_radius_counted"] = stick.counted_radius;
  json["moment"] = c.moment() * c.newton_metres();
  json["moment_limit"] = e.moment_limit * c.newton_metres();
  const auto [f1, f2] = c.force();
  json["force"] = {f1 * c.newtons(), f2 * c.newtons()};
  set_number(json, "twist_angle", e.state.twist, kBroken);
  json["twist_inferred"] = !e.twist_given;
  set_number(json, "twist_that_fits", e.fitted.twist, kBroken);
  json["displacement"] = {e.state.displacement[0] * c.length_unit, e.state.displacement[1] * c.length_unit};
}

void add_errors(Json& json, const Examination& e, const solver::StickFront& stick) {
  if (!e.exact.oracle) {
    for (const char* key : {"twist_error", "moment_error", "stick_radius_error", "contact_radius_error",
                            "pressure_error", "traction_error"}) {
      set_missing(json, key, e.exact.reason);
    }
    return;
  }
  const GivenContact& c = e.contact;
  const Oracle& oracle = *e.exact.oracle;
  const std::string& unknown = oracle.only_normal.empty() ? kNoNumber : oracle.only_normal;
  const auto set_error = [&](const char* key, double value, double exact) {
    set_number(json, key, relative_error(value, exact), std::isnan(exact) ? unknown : kNoNumber);
  };
  set_error("twist_error", e.state.twist, oracle.twist_angle);
  set_error("moment_error", c.moment() * c.newton_metres(), oracle.moment);
  set_error("stick_radius_error", stick.radius, oracle.stick_radius);
  set_error("stick_radius_counted_error", stick.counted_radius, oracle.stick_radius);
  set_error("contact_radius_error", json["contact_radius"], oracle.contact_radius);
  const solver::Grid grid = c.grid_in_m();
  json["pressure_error"] =
      to_json(make_field_error(pressure_error(c.stress_unit * c.pressure, oracle, grid), kNoNumber));
  json["traction_error"] =
      to_json(make_traction_error(traction_error(c.stress_unit * c.traction, oracle, grid), unknown));
}

/// The numbers of the right answer on this mesh.
Json reference_json(const Examination& e) {
  const ReferenceOnGrid& reference = e.reference;
  Json json;
  json["mesh_error"] = reference.mesh.deviation.tractions;
  json["gap"] = reference.mesh.deviation.gap;
  json["slip_direction"] = reference.mesh.direction;
  json["twist_angle"] = reference.right.twist;
  json["constant_cells"] = e.constant_cells;
  json["loads_scaled_down"] = reference.right.scaled;
  json["distance"] = e.deviation.tractions;
  json["noise"] = reference.noise_size.maxCoeff() / e.contact.friction_bound.maxCoeff();
  if (e.exact.oracle && e.exact.oracle->shear) {
    json["traction_error"] =
        to_json(make_traction_error(traction_error(e.contact.stress_unit * reference.right.traction,
                                                   *e.exact.oracle, e.contact.grid_in_m()),
                                    kNoNumber));
  }
  return json;
}

/// A note without its reason.
std::string short_note(const std::string& note) { return note.substr(0, note.find(':')); }

/// The verdict's headline; before it mistakes, refused conventions and an unsolved grid's problem, where they
/// alone make the field bad.
std::string headline(const Examination& e, const Verdict& verdict, const CheckOptions& options) {
  if (!verdict.within_mesh()) return verdict.headline;
  std::vector<std::string> wrong;
  for (const std::string& mistake : e.read.mistakes) wrong.push_back(short_note(mistake));
  if (options.strict) {
    for (const std::string& convention : e.read.conventions) wrong.push_back(short_note(convention));
  }
  if (options.discrete && !verdict.discrete.holds()) wrong.push_back(verdict.discrete.wrong);
  if (wrong.empty()) return verdict.headline;
  return fmt::format("{}; without that {}", fmt::join(wrong, ", and "), verdict.headline);
}

std::string field_text(const Json& r) {
  std::string text = text_line("field", r["field"].get<std::string>());
  text += text_line("grid", fmt::format("{} x {} cells of {} x {} m, {} in contact, {} stick",
                                        r["cells"][0].get<int>(), r["cells"][1].get<int>(),
                                        number_text(r["cell_size"][0]), number_text(r["cell_size"][1]),
                                        r["contact_cells"].get<int>(), r["stick_cells"].get<int>()));
  for (const char* key : {"mistakes", "conventions"}) {
    for (const Json& note : r[key]) text += text_line("note", note.get<std::string>());
  }
  return text;
}

std::string state_and_errors_text(const Json& r) {
  const auto error = [&](const char* key) {
    constexpr double kNone = 1e-6;
    if (!r[key].is_number()) return std::string();
    const double value = r[key];
    return std::abs(value) < kNone ? "   (no error)" : fmt::format("   (error {:+.1e})", value);
  };
  const std::string inferred = r["twist_inferred"].get<bool>() ? ", which fits the tractions" : "";
  return text_line("normal load", number_text(r["normal_load"]) + " N") +
         text_line("contact radius",
                   number_text(r["contact_radius"]) + " m" + error("contact_radius_error")) +
         text_line("moment", fmt::format("{} N m, at most {}{}", number_text(r["moment"]),
                                         number_text(r["moment_limit"]), error("moment_error"))) +
         text_line("twist", number_text(r["twist_angle"]) + " rad" + inferred + error("twist_error")) +
         text_line("stick radius", number_text(r["stick_radius"]) + " m" + error("stick_radius_error"));
}

std::string traction_text(const Json& r) {
  const Json& traction = r["traction_error"];
  if (!traction.is_object()) {
    return text_line("exact answer", "none: " + r["traction_error_reason"].get<std::string>());
  }
  if (!traction["l1"].is_number()) return text_line("exact answer", traction["l1_reason"].get<std::string>());
  const Json& right = r["yardstick"]["traction_error"];
  return text_line("traction error", fmt::format("{} in L1, {} in L2; the right answer on this grid: {}, {}",
                                                 number_text(traction["l1"]), number_text(traction["l2"]),
                                                 number_text(right["l1"]), number_text(right["l2"])));
}

std::string certificate_text(const Json& r) {
  const Json& certificate = r["certificate"];
  const Json& direction = r["slip_direction"];
  const solver::FrictionKind law = friction_law_of(r.value("friction_law", ""));
  return text_line("certificate",
                   fmt::format("moment off by {}, |q| above {} by {}", number_text(certificate["moment"]),
                               solver::bound_text(law), number_text(certificate["friction_bound"]))) +
         text_line("slip direction",
                   fmt::format("{} degrees off in the mean, {} at most ({})", number_text(direction["mean"]),
                               number_text(direction["max"]), right_direction_text(law)));
}

}  // namespace

Json check_field(const solver::Scene& scene, const std::filesystem::path& file, const CheckOptions& options) {
  const Examination e = examine(scene, file, options.twist, options.pressure_given, options.columns);
  const Verdict verdict = reach_verdict(e, options.tolerance);
  const solver::StickFront stick = stick_front_of(e);
  const bool fits = e.read.mistakes.empty() && !(options.strict && !e.read.conventions.empty());
  const bool good = verdict.within_mesh() && fits && (!options.discrete || verdict.discrete.holds());
  Json json;
  json["name"] = scene.name;
  json["field"] = file.string();
  if (!scene.friction.is_coulomb()) json["friction_law"] = to_string(scene.friction.kind);
  json["verdict"] = good ? "good" : "bad";
  json["headline"] = headline(e, verdict, options);
  json["details"] = verdict.details;
  json["why"] = json["headline"].get<std::string>() + (verdict.details.empty() ? "" : "; " + verdict.details);
  json["pressure_given"] = options.pressure_given;
  json["within_mesh"] = verdict.within_mesh();
  json["discrete"]["holds"] = verdict.discrete.holds();
  set_number(json["discrete"], "gap", verdict.discrete.value, "|q| exceeds its bound: there is no gap");
  set_number(json["discrete"], "allowed", verdict.discrete.allowed, kBroken);
  add_field(json, e);
  add_state(json, e, stick);
  add_errors(json, e, stick);
  json["certificate"] = to_json(make_certificate(e.certificate, kBroken));
  set_number(json["slip_direction"], "mean", e.direction.mean, kBroken);
  set_number(json["slip_direction"], "max", e.direction.max, kBroken);
  json["yardstick"] = reference_json(e);
  json["judged"] = judged_json(verdict.judged);
  if (verdict.diagnosis) json["diagnosis"] = diagnosis_json(*verdict.diagnosis);
  json["provenance"] = provenance(std::max(1, scene.threads));
  return json;
}

std::string check_text(const Json& r) {
  std::vector<std::string> taken;
  for (const Json& note : r["conventions"]) taken.push_back(short_note(note));
  std::string text = r["verdict"];
  if (!taken.empty()) text += fmt::format(" ({})", fmt::join(taken, "; "));
  text += fmt::format(": {}\n", r["headline"].get<std::string>());
  if (r["details"] != "") text += fmt::format("  {}\n", r["details"].get<std::string>());
  text += field_text(r) + state_and_errors_text(r) + traction_text(r) + certificate_text(r);
  for (const Json& item : r["judged"]) {
    text +=
        text_line(item["holds"].get<bool>() ? "holds" : "FAILS",
                  fmt::format("{:<20} {:>8}   allowed on this grid {}", item["quantity"].get<std::string>(),
                              number_text(item["value"], "{:.1e}"), number_text(item["allowed"], "{:.1e}")));
  }
  return text;
}

}  // namespace slipstick::convergence
