#include "convergence/results/result_parts.hpp"

#include <fmt/core.h>
#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace slipstick::convergence {
void set_missing(Json& object, const std::string& key, const std::string& reason) {
  object[key] = nullptr;
  object[key + "_reason"] = reason;
}

void set_number(Json& object, const std::string& key, double value, const std::string& reason) {
  if (std::isfinite(value)) {
    object[key] = value;
  } else {
    set_missing(object, key, reason);
  }
}

Json field_error_json(const FieldError& error, const std::string& reason) {
  Json json;
  set_number(json, "l1", error.l1, reason);
  set_number(json, "l2", error.l2, reason);
  set_number(json, "max", error.max, reason);
  return json;
}

Json traction_error_json(const TractionError& error, const std::string& reason) {
  Json json = field_error_json(error.at_centres, reason);
  json["averaged"] = field_error_json(error.averaged, reason);
  json["stick_edge"] = field_error_json(error.stick_edge, reason);
  json["contact_edge"] = field_error_json(error.contact_edge, reason);
  json["inside"] = field_error_json(error.inside, reason);
  json["outside"] = field_error_json(error.outside, reason);
  return json;
}

void add_friction(Json& json, const solver::FrictionLaw& law, double force) {
  using solver::FrictionKind;
  if (law.kind == FrictionKind::tresca) {
    set_missing(json, "friction", "Tresca's law has a shear strength in place of a coefficient");
  } else {
    json["friction"] = law.coefficient;
  }
  if (!law.is_coulomb()) json["friction_law"] = to_string(law.kind);
  if (law.kind == FrictionKind::tresca || law.kind == FrictionKind::capped)
    json["shear_strength"] = law.shear_strength;
  if (law.kind == FrictionKind::power) json["friction_exponent"] = law.exponent;
  if (!law.map.empty()) json["friction_map"] = law.map.string();
  set_number(json, "friction_force", force, "the solve broke down");
}

namespace {

solver::FrictionKind law_of(const Json& result) {
  const std::string word = result.value("friction_law", "coulomb");
  using enum solver::FrictionKind;
  for (const auto kind : {tresca, capped, power}) {
    if (word == to_string(kind)) return kind;
  }
  return coulomb;
}

}  // namespace

std::string bound_text(const Json& result) { return solver::bound_text(law_of(result)); }

std::string right_direction_text(const Json& result) {
  return law_of(result) == solver::FrictionKind::coulomb ? "Coulomb: 0" : "right: 0";
}

Json certificate_json(const solver::Certificate& certificate, const std::string& reason) {
  Json json;
  set_number(json, "gap", certificate.gap, reason);
  set_number(json, "energy_error", certificate.energy_error, reason);
  set_number(json, "rounding", certificate.rounding, reason);
  set_number(json, "moment", certificate.moment, reason);
  set_number(json, "force", certificate.force, reason);
  set_number(json, "friction_bound", certificate.friction_bound, reason);
  return json;
}

namespace {

const char* name_of(double solver::Quantities::*number) {
  constexpr std::array kNames{"twist_angle", "displacement", "moment", "force"};
  return kNames[static_cast<std::size_t>(std::ranges::find(solver::kQuantities, number) -
                                         solver::kQuantities.begin())];
}

/// Why the number is not known well enough to be used, and what to do.
std::string poorly_resolved(const solver::Resolution& resolution) {
  const double mesh = resolution.mesh.*resolution.number;
  const double path = resolution.path.*resolution.number;
  const std::string uncertain = std::isfinite(resolution.uncertainty)
                                    ? "uncertain by " + percent_text(resolution.uncertainty)
                                    : "not determined";
  const double open = resolution.open.*resolution.number;
  if (!(resolution.step <= solver::kPoorlyResolved) || (open > 0.0 && open >= 0.5 * mesh)) {
    return fmt::format(
        "the mesh is too coarse: the stick area is {:.2g} cells wide, so the contact's motion is {}; take "
        "more cells, or a load further from gross slip",
        resolution.stick_width, uncertain);
  }
  if (std::isinf(path)) {
    return "what the length of the steps leaves open is not known, since few cells or more parts of the "
           "steps do not carry these loads; compare with a larger solver.substeps";
  }
  if (path > mesh) {
    return fmt::format(
        "the loads are brought in too few parts, so the contact's motion is {}; set solver.substeps higher{}",
        uncertain, resolution.number == &solver::Quantities::twist ? ", or use --accuracy" : "");
  }
  return fmt::format("little is left beside what the steps before have changed, so it is {}; take more cells",
                     uncertain);
}

}  // namespace

Json resolution_json(const solver::Resolution& resolution) {
  const std::string unknown = std::isfinite(resolution.mesh.*resolution.number)
                                  ? "the steps' parts on few cells, or more of them, do not carry these loads"
                                  : "the stick area lies within a cell";
  Json json;
  json["stick_width"] = resolution.stick_width;
  json["slip_width"] = resolution.slip_width;
  json["number"] = name_of(resolution.number);
  set_number(json, "uncertainty", resolution.uncertainty, unknown);
  set_number(json, "absolute", resolution.absolute, unknown);
  set_number(json, "mesh", resolution.mesh.*resolution.number, unknown);
  set_number(json, "path", resolution.path.*resolution.number, unknown);
  for (const auto number : solver::kQuantities) {
    set_number(json["paths"], name_of(number), resolution.path.*number, unknown);
  }
  if (!(resolution.uncertainty <= solver::kPoorlyResolved)) json["warning"] = poorly_resolved(resolution);
  return json;
}

Json model_json(const std::vector<solver::Omission>& left_out) {
  Json list = Json::array();
  for (const auto& [what, why] : left_out) list.push_back({{"what", what}, {"why", why}});
  return {{"left_out", list}};
}

std::size_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

std::string number_text(const Json& value, std::string_view format) {
  return value.is_number() ? fmt::format(fmt::runtime(format), value.get<double>()) : "-";
}

std::string percent_text(const Json& part) {
  if (!part.is_number()) return "-";
  const double percent = 100.0 * part.get<double>();
  if (!(percent < 1e4)) return "over 10,000 %";
  return percent < 100.0 ? fmt::format("{:.2g} %", percent) : fmt::format("{:.0f} %", percent);
}

std::string short_text(const Json& value) { return number_text(value, "{:.4g}"); }

std::string text_line(const std::string& label, const std::string& value) {
  return fmt::format("  {:<16} {}\n", label, value);
}

}  // namespace slipstick::convergence
