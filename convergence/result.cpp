#include "convergence/result.hpp"

#include <fmt/core.h>
#include <sys/resource.h>

#include <cmath>

#include "convergence/errors.hpp"
#include "convergence/provenance.hpp"
#include "solver/field_file.hpp"

namespace slipstick::convergence {
namespace {

using solver::Solution;

/// JSON has no NaN: such a number is null and its reason stands beside it.
void set_number(Json& object, const std::string& key, double value, const std::string& reason) {
  if (std::isfinite(value)) {
    object[key] = value;
  } else {
    object[key] = nullptr;
    object[key + "_reason"] = reason;
  }
}

std::size_t peak_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::size_t>(usage.ru_maxrss) * 1024;
}

Json model_json(const solver::Model& model) {
  Json left_out = Json::array();
  for (const auto& [what, why] : model.left_out) left_out.push_back({{"what", what}, {"why", why}});
  return {{"left_out", left_out}};
}

Json field_error_json(const FieldError& error, const std::string& reason) {
  Json json;
  set_number(json, "l1", error.l1, reason);
  set_number(json, "l2", error.l2, reason);
  set_number(json, "max", error.max, reason);
  return json;
}

void add_errors(Json& json, const Solution& solution, const OracleAnswer& exact) {
  if (!exact.oracle) {
    for (const char* key : {"twist_error", "moment_error", "stick_radius_error", "traction_error"}) {
      set_number(json, key, NAN, exact.reason);
    }
    return;
  }
  const Oracle& oracle = *exact.oracle;
  const Errors errors = compare(solution, oracle);
  const std::string reason = "the exact value is zero, or the result is not a number";
  set_number(json, "twist_error", errors.twist, reason);
  set_number(json, "moment_error", errors.moment, reason);
  set_number(json, "moment_limit_error", errors.moment_limit, reason);
  set_number(json, "stick_radius_error", errors.stick_radius, reason);
  set_number(json, "contact_radius_error", errors.contact_radius, reason);
  set_number(json, "peak_pressure_error", errors.peak_pressure, reason);
  json["traction_error"] = field_error_json(errors.traction, reason);
  json["pressure_error"] = field_error_json(errors.pressure, reason);
  json["exact"] = {{"twist_angle", oracle.twist_angle},
                   {"twist", oracle.state.twist},
                   {"moment", oracle.moment},
                   {"moment_limit", oracle.moment_limit},
                   {"stick_radius", oracle.stick_radius},
                   {"stick_ratio", oracle.state.stick_ratio},
                   {"contact_radius", oracle.contact_radius},
                   {"peak_pressure", oracle.peak_pressure},
                   {"approach", oracle.approach}};
}

}  // namespace

Json solve_result(const solver::Scene& scene, const Solution& solution, const OracleAnswer& exact) {
  const solver::Model& model = solution.model;
  const double shear_modulus = model.stress_unit;
  const double a = solution.contact_radius;
  Json json;
  json["name"] = scene.name;
  json["status"] = solution.status == solver::Status::converged ? "converged" : "not_converged";
  if (!solution.message.empty()) json["message"] = solution.message;
  json["method"] = "paper";
  json["operator"] = to_string(scene.op);
  json["pressure"] = to_string(scene.pressure);
  json["model"] = model_json(model);
  json["cells"] = {model.grid.n1, model.grid.n2};
  json["cell_size"] = {model.grid.h1 * model.length_unit, model.grid.h2 * model.length_unit};
  json["contact_cells"] = solution.contact_cells;
  json["stick_cells"] = solution.stick_cells;
  json["contact_radius"] = a;
  json["contact_radius_counted"] = solution.contact_radius_counted;
  json["stick_radius"] = solution.stick_radius_counted;
  json["stick_radius_counted"] = solution.stick_radius_counted;
  set_number(json, "stick_ratio", solution.stick_radius_counted / a, "no contact");
  json["friction"] = scene.friction;
  json["normal_load"] = solution.normal_load;
  json["peak_pressure"] = solution.peak_pressure;
  if (scene.pressure == solver::PressureModel::solved) {
    json["approach"] = solution.approach;
  } else {
    set_number(json, "approach", NAN, "the normal contact was not solved");
  }
  set_number(json, "twist_angle", solution.twist_angle, "the solve broke down");
  set_number(json, "moment", solution.moment, "the solve broke down");
  json["moment_limit"] = solution.moment_limit;
  set_number(json, "moment_ratio", solution.moment / solution.moment_limit, "the limit moment is zero");
  set_number(json, "twist",
             shear_modulus * a * a * solution.twist_angle / (scene.friction * solution.normal_load),
             "without friction the normalised twist has no scale");
  json["displacement"] = {0.0, 0.0};
  json["iterations"] = solution.torsion.iterations;
  json["operator_applications"] = solution.operator_applications;
  json["pressure_iterations"] = solution.normal.iterations;
  json["pressure_complementarity"] = solution.normal.complementarity;
  json["tolerance"] = scene.tolerance;
  set_number(json, "change", solution.torsion.change, "the solve broke down");
  const std::string broken = "the solve broke down, or there is no friction";
  set_number(json["certificate"], "gap", solution.certificate.gap, broken);
  set_number(json["certificate"], "moment", solution.certificate.moment, broken);
  set_number(json["certificate"], "force", solution.certificate.force, broken);
  set_number(json["certificate"], "friction_bound", solution.certificate.friction_bound, broken);
  set_number(json["slip_direction"], "mean", solution.slip_direction.mean, broken);
  set_number(json["slip_direction"], "max", solution.slip_direction.max, broken);
  add_errors(json, solution, exact);
  json["seconds"] = {{"setup", solution.seconds.setup},
                     {"pressure", solution.seconds.pressure},
                     {"traction", solution.seconds.traction},
                     {"total", solution.seconds.total}};
  json["operator_bytes"] = solution.operator_bytes;
  json["peak_bytes"] = peak_bytes();
  json["provenance"] = provenance(scene.threads);
  return json;
}

std::string solve_text(const Json& r) {
  const auto number = [](const Json& value) {
    return value.is_number() ? fmt::format("{:.6g}", value.get<double>()) : "-";
  };
  const auto error_of = [](const Json& json, const char* key) {
    const auto found = json.find(key);
    return found != json.end() && found->is_number() ? fmt::format("   (error {:+.1e})", found->get<double>())
                                                     : "";
  };
  std::string text =
      fmt::format("{}: {} x {} cells, pressure {}, operator {}, method {}\n", r["name"].get<std::string>(),
                  r["cells"][0].get<int>(), r["cells"][1].get<int>(), r["pressure"].get<std::string>(),
                  r["operator"].get<std::string>(), r["method"].get<std::string>());
  const auto line = [&](const char* label, const std::string& value) {
    text += fmt::format("  {:<16} {}\n", label, value);
  };
  line("status", fmt::format("{} ({} iterations, {} operator applications, {} s)",
                             r["status"].get<std::string>(), r["iterations"].get<int>(),
                             r["operator_applications"].get<long>(), number(r["seconds"]["total"])));
  if (r.contains("message")) line("why", r["message"].get<std::string>());
  line("normal load", number(r["normal_load"]) + " N");
  line("contact radius", number(r["contact_radius"]) + " m" + error_of(r, "contact_radius_error"));
  line("peak pressure", number(r["peak_pressure"]) + " Pa" + error_of(r, "peak_pressure_error"));
  line("moment", fmt::format("{} N m = {} of the limit {} N m", number(r["moment"]),
                             number(r["moment_ratio"]), number(r["moment_limit"])) +
                     error_of(r, "moment_error"));
  line("twist", number(r["twist_angle"]) + " rad" + error_of(r, "twist_error"));
  line("stick radius", number(r["stick_radius"]) + " m" + error_of(r, "stick_radius_error"));
  if (r["traction_error"].is_object()) {
    line("traction error", fmt::format("{} in L1, {} in L2 (relative)", number(r["traction_error"]["l1"]),
                                       number(r["traction_error"]["l2"])));
  } else {
    line("exact answer", fmt::format("none: {}", r["traction_error_reason"].get<std::string>()));
  }
  line("certificate",
       fmt::format("gap/energy {}, moment off by {}, |q| above mu p by {}", number(r["certificate"]["gap"]),
                   number(r["certificate"]["moment"]), number(r["certificate"]["friction_bound"])));
  line("slip direction",
       fmt::format("{} degrees off in the mean, {} at most (Coulomb: 0)", number(r["slip_direction"]["mean"]),
                   number(r["slip_direction"]["max"])));
  for (const Json& omission : r["model"]["left_out"]) {
    line("left out",
         fmt::format("{} ({})", omission["what"].get<std::string>(), omission["why"].get<std::string>()));
  }
  return text;
}

void write_solution_fields(const std::filesystem::path& file, const Solution& solution,
                           const OracleAnswer& exact) {
  const solver::Model& model = solution.model;
  const solver::Index cells = model.grid.cells();
  const double metre = model.length_unit;
  const double pascal = model.stress_unit;
  std::vector<solver::Column> columns{
      {"x1", solver::cell_x1(model.grid) * metre},
      {"x2", solver::cell_x2(model.grid) * metre},
      {"pressure", solution.normal.pressure * pascal},
      {"q1", solution.torsion.traction.head(cells) * pascal},
      {"q2", solution.torsion.traction.tail(cells) * pascal},
      {"slip1", solution.torsion.slip.head(cells) * metre},
      {"slip2", solution.torsion.slip.tail(cells) * metre},
      {"stick", solution.torsion.stick},
  };
  if (exact.oracle) {
    const ExactFields fields = exact_fields(*exact.oracle, model);
    columns.push_back({"q1_exact", fields.traction.head(cells) * pascal});
    columns.push_back({"q2_exact", fields.traction.tail(cells) * pascal});
  }
  solver::Grid grid = model.grid;
  grid.h1 *= metre;
  grid.h2 *= metre;
  solver::write_fields(file, grid, columns, solution.normal.pressure);
}

}  // namespace slipstick::convergence
