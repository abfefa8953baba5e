#include "convergence/result.hpp"

#include <fmt/core.h>

#include <cmath>

#include "convergence/errors.hpp"
#include "convergence/provenance.hpp"
#include "convergence/result_parts.hpp"
#include "solver/field_file.hpp"

namespace slipstick::convergence {
namespace {

using solver::Solution;

/// The work on each grid, coarsest first.
Json grids_json(const std::vector<solver::GridWork>& grids) {
  Json rows = Json::array();
  for (const auto& [n1, n2, applications, iterations, gap] : grids) {
    rows.push_back({{"cells", {n1, n2}}, {"applications", applications}, {"iterations", iterations}});
    set_number(rows.back(), "stopped_at", gap, "the solve broke down");
  }
  return rows;
}

Json field_error_json(const FieldError& error, const std::string& reason) {
  Json json;
  set_number(json, "l1", error.l1, reason);
  set_number(json, "l2", error.l2, reason);
  set_number(json, "max", error.max, reason);
  return json;
}

const std::string kNoPeak = "the exact pressure has no finite peak";

Json exact_json(const Oracle& oracle) {
  Json json{{"twist_angle", oracle.twist_angle},
            {"twist", oracle.state.twist},
            {"moment", oracle.moment},
            {"moment_limit", oracle.moment_limit},
            {"stick_radius", oracle.stick_radius},
            {"stick_ratio", oracle.state.stick_ratio},
            {"contact_radius", oracle.contact_radius}};
  set_number(json, "peak_pressure", oracle.peak_pressure, kNoPeak);
  json["approach"] = oracle.approach;
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
  set_number(json, "stick_radius_counted_error", errors.stick_radius_counted, reason);
  set_number(json, "contact_radius_error", errors.contact_radius, reason);
  set_number(json, "peak_pressure_error", errors.peak_pressure,
             std::isfinite(oracle.peak_pressure) ? reason : kNoPeak);
  json["traction_error"] = field_error_json(errors.traction, reason);
  json["pressure_error"] = field_error_json(errors.pressure, reason);
  json["exact"] = exact_json(oracle);
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
  json["method"] = to_string(scene.method);
  json["operator"] = to_string(scene.op);
  json["precision"] = to_string(scene.precision);
  json["pressure"] = to_string(scene.pressure);
  json["model"] = model_json(model.left_out);
  json["cells"] = {model.grid.n1, model.grid.n2};
  json["cell_size"] = {model.grid.h1 * model.length_unit, model.grid.h2 * model.length_unit};
  json["contact_cells"] = solution.contact_cells;
  json["stick_cells"] = solution.stick_cells;
  json["contact_radius"] = a;
  json["contact_radius_counted"] = solution.contact_radius_counted;
  set_number(json, "stick_radius", solution.stick_radius, "the solve broke down");
  if (!solution.stick_radius_note.empty()) json["stick_radius_note"] = solution.stick_radius_note;
  json["stick_radius_counted"] = solution.stick_radius_counted;
  set_number(json, "stick_ratio", solution.stick_radius / a, "no contact");
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
  json["pressure_applications"] = solution.pressure_applications;
  json["grids"] = grids_json(solution.torsion.grids);
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
  json["solver_bytes"] = solution.bytes;
  json["predicted_bytes"] = solver::predicted_memory(scene, model).total();
  json["peak_bytes"] = peak_bytes();
  json["provenance"] = provenance(scene.threads);
  return json;
}

std::string solve_text(const Json& r) {
  std::string text =
      fmt::format("{}: {} x {} cells, pressure {}, operator {}, method {}\n", r["name"].get<std::string>(),
                  r["cells"][0].get<int>(), r["cells"][1].get<int>(), r["pressure"].get<std::string>(),
                  r["operator"].get<std::string>(), r["method"].get<std::string>());
  text += status_text(r) + state_text(r);
  if (r["traction_error"].is_object()) {
    text += text_line("traction error",
                      fmt::format("{} in L1, {} in L2 (relative)", number_text(r["traction_error"]["l1"]),
                                  number_text(r["traction_error"]["l2"])));
  } else {
    text += text_line("exact answer", "none: " + r["traction_error_reason"].get<std::string>());
  }
  text += text_line("certificate",
                    fmt::format("gap/energy {}, moment off by {}, |q| above mu p by {}",
                                number_text(r["certificate"]["gap"]), number_text(r["certificate"]["moment"]),
                                number_text(r["certificate"]["friction_bound"])));
  text += text_line("slip direction", fmt::format("{} degrees off in the mean, {} at most (Coulomb: 0)",
                                                  number_text(r["slip_direction"]["mean"]),
                                                  number_text(r["slip_direction"]["max"])));
  return text + model_text(r);
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
