#include "convergence/results/solve_record.hpp"

#include <fmt/core.h>

#include "convergence/results/record_fields.hpp"

namespace slipstick::convergence {

// ---------------------------------------------------------------- parts

void list_fields(auto& fields, Is<solver::CountedArea> auto& area) {
  fields("counted", area.counted);
  fields("corrected", area.corrected);
  fields("uncertainty", area.uncertainty);
}

void list_fields(auto& fields, Is<solver::Omission> auto& omission) {
  fields("what", omission.what);
  fields("why", omission.why);
}

void list_fields(auto& fields, Is<solver::SpectrumRing> auto& ring) {
  fields("wavelength", ring.wavelength);
  fields("power", ring.power);
}

void list_fields(auto& fields, Is<solver::RoughnessSpectrum> auto& spectrum) {
  fields("rms_height", spectrum.rms_height);
  fields("rms_slope", spectrum.rms_slope);
  fields("hurst", spectrum.hurst);
  fields("spectrum", spectrum.rings);
}

void list_fields(auto& fields, Is<solver::Safeguards> auto& safeguards) {
  fields("second_solves", safeguards.second_solves);
  fields("halvings", safeguards.halvings);
  fields("gradient_steps", safeguards.gradient_steps);
  fields("breakdowns", safeguards.breakdowns);
  fields.unless_empty("breakdown", safeguards.breakdown);
}

void list_fields(auto& fields, Is<Provenance> auto& made) {
  fields("version", made.version);
  fields("commit", made.commit);
  fields("compiler", made.compiler);
  fields("flags", made.flags);
  fields("libraries", made.libraries);
  fields("cpu", made.cpu);
  fields("threads", made.threads);
}

void list_fields(auto& fields, Is<LimitRecord> auto& limit) {
  fields("factor", limit.factor);
  fields("centre", limit.centre);
  fields("direction", limit.direction);
}

void list_fields(auto& fields, Is<ContinuumRecord> auto& continuum) {
  fields("gap", continuum.gap);
  fields("energy", continuum.energy);
  fields("quadrature_error", continuum.quadrature_error);
  fields.unless_empty("number", continuum.number);
  fields("low", continuum.low);
  fields("high", continuum.high);
  fields("pressure_gap", continuum.pressure_gap);
  fields("pressure_energy", continuum.pressure_energy);
  fields("pressure_quadrature_error", continuum.pressure_quadrature_error);
  fields("friction_bound_error", continuum.friction_bound_error);
}

void list_fields(auto& fields, Is<CertificateRecord> auto& certificate) {
  fields("gap", certificate.gap);
  fields("energy_error", certificate.energy_error);
  fields("rounding", certificate.rounding);
  fields("moment", certificate.moment);
  fields("force", certificate.force);
  fields("friction_bound", certificate.friction_bound);
  fields("energy", certificate.energy);
  fields("continuum", certificate.continuum);
}

void list_fields(auto& fields, Is<PathsRecord> auto& paths) {
  fields("twist_angle", paths.twist_angle);
  fields("displacement", paths.displacement);
  fields("moment", paths.moment);
  fields("force", paths.force);
}

void list_fields(auto& fields, Is<ResolutionRecord> auto& resolution) {
  fields("stick_width", resolution.stick_width);
  fields("slip_width", resolution.slip_width);
  fields("number", resolution.number);
  fields("uncertainty", resolution.uncertainty);
  fields("absolute", resolution.absolute);
  fields("mesh", resolution.mesh);
  fields("path", resolution.path);
  fields("paths", resolution.paths);
  fields.unless_empty("warning", resolution.warning);
}

void list_fields(auto& fields, Is<FieldErrorRecord> auto& error) {
  fields("l1", error.l1);
  fields("l2", error.l2);
  fields("max", error.max);
  fields.unless_empty("kept", error.kept);
}

void list_fields(auto& fields, Is<TractionErrorRecord> auto& error) {
  list_fields(fields, error.at_centres);
  fields("averaged", error.averaged);
  fields("stick_edge", error.stick_edge);
  fields("contact_edge", error.contact_edge);
  fields("inside", error.inside);
  fields("outside", error.outside);
  fields("sharpened", error.sharpened);
}

void list_fields(auto& fields, Is<ExactRecord> auto& exact) {
  fields("twist_angle", exact.twist_angle);
  fields("twist", exact.twist);
  fields("moment", exact.moment);
  fields("moment_limit", exact.moment_limit);
  fields("force", exact.force);
  fields("displacement", exact.displacement);
  fields("stick_radius", exact.stick_radius);
  fields("stick_ratio", exact.stick_ratio);
  fields("contact_radius", exact.contact_radius);
  fields("semi_axes", exact.semi_axes);
  fields("peak_pressure", exact.peak_pressure);
  fields("approach", exact.approach);
  fields("dissipated", exact.dissipated);
  fields("relative_uncertainty", exact.relative_uncertainty);
}

void list_fields(auto& fields, Is<solver::Seconds> auto& seconds) {
  fields("setup", seconds.setup);
  fields("pressure", seconds.pressure);
  fields("traction", seconds.traction);
  fields("total", seconds.total);
}

void list_fields(auto& fields, Is<GridRecord> auto& grid) {
  fields("cells", grid.cells);
  fields("applications", grid.applications);
  fields("iterations", grid.iterations);
  fields("stopped_at", grid.stopped_at);
}

void list_fields(auto& fields, Is<SlipDirectionRecord> auto& direction) {
  fields("mean", direction.mean);
  fields("max", direction.max);
}

void list_fields(auto& fields, Is<RanksRecord> auto& ranks) {
  fields("number", ranks.number);
  fields("peak_bytes", ranks.peak_bytes);
  fields("sent_bytes", ranks.sent_bytes);
  fields("sent_messages", ranks.sent_messages);
}

void list_fields(auto& fields, Is<OwnNumbers> auto& own) {
  fields("twist_angle", own.twist_angle);
  fields("twist", own.twist);
  fields("iterations", own.iterations);
  fields("seconds", own.seconds);
  fields("converged", own.converged);
  fields.unless_empty("message", own.message);
}

void list_fields(auto& fields, Is<ProgramRecord> auto& program) {
  fields("name", program.name);
  fields("file", program.file);
  fields("version", program.version);
  fields("fields", program.fields);
  fields("wall_seconds", program.wall_seconds);
  fields("cpu_seconds", program.cpu_seconds);
  fields("own", program.own);
}

void list_fields(auto& fields, Is<ProfilePoint> auto& point) {
  fields("radius", point.radius);
  fields("value", point.value);
  fields("exact", point.exact);
  fields("error", point.error);
}

// ---------------------------------------------------------------- parts whose keys stand in the result itself

void list_friction(auto& fields, Is<FrictionRecord> auto& friction) {
  fields("friction", friction.coefficient);
  fields.unless_empty("friction_law", friction.law);
  fields("shear_strength", friction.shear_strength);
  fields("friction_exponent", friction.exponent);
  fields.unless_empty("friction_map", friction.map);
  fields("friction_force", friction.force);
}

void list_state(auto& fields, Is<EndRecord> auto& end) {
  auto& contact = end.contact;
  fields("contact_cells", contact.contact_cells);
  fields("stick_cells", contact.stick_cells);
  fields("contact_area", contact.contact_area);
  fields("stick_area", contact.stick_area);
  fields("contact_radius", contact.contact_radius);
  fields("contact_radius_counted", contact.contact_radius_counted);
  fields("stick_radius", contact.stick_radius);
  fields.unless_empty("stick_radius_note", contact.stick_radius_note);
  fields("stick_radius_counted", contact.stick_radius_counted);
  fields("stick_ratio", contact.stick_ratio);
  list_friction(fields, end.friction);
  fields("normal_load", contact.normal_load);
  fields("peak_pressure", contact.peak_pressure);
  fields("approach", contact.approach);
  auto& loads = end.loads;
  fields("twist_angle", loads.twist_angle);
  fields("moment", loads.moment);
  fields("moment_limit", loads.moment_limit);
  fields("moment_ratio", loads.moment_ratio);
  fields("twist", loads.twist);
  fields.unless_empty("load_warning", loads.warning);
  fields("force", loads.force);
  fields("displacement", loads.displacement);
  fields("limit", loads.limit);
  fields("elastic_energy", end.energy.elastic);
  fields("dissipated", end.energy.dissipated);
  fields("work", end.energy.work);
}

void list_counts(auto& fields, Is<WorkRecord> auto& work) {
  fields("iterations", work.iterations);
  fields("operator_applications", work.operator_applications);
  fields("pressure_applications", work.pressure_applications);
  fields("turns", work.turns);
}

void list_no_errors(auto& fields, Is<ErrorsRecord> auto& errors) {
  fields("twist_error", errors.twist);
  fields("moment_error", errors.moment);
  fields("stick_radius_error", errors.stick_radius);
  fields.missing({"traction_error"}, errors.twist.why_missing);
}

void list_errors(auto& fields, Is<ErrorsRecord> auto& errors) {
  fields.ahead("exact", errors.exact);
  if (!errors.exact) return list_no_errors(fields, errors);
  fields("twist_error", errors.twist);
  fields("moment_error", errors.moment);
  fields("moment_limit_error", errors.moment_limit);
  fields("displacement_error", errors.displacement);
  fields("stick_radius_error", errors.stick_radius);
  fields("stick_ratio_error", errors.stick_ratio);
  fields("stick_radius_counted_error", errors.stick_radius_counted);
  fields("contact_radius_error", errors.contact_radius);
  fields("peak_pressure_error", errors.peak_pressure);
  fields("dissipated_error", errors.dissipated);
  fields("traction_error", errors.traction);
  fields("pressure_error", errors.pressure);
  fields("exact", errors.exact);
}

// ---------------------------------------------------------------- whole results

void list_fields(auto& fields, Is<StepRecord> auto& step) {
  fields("name", step.name);
  fields("cycle", step.cycle);
  fields("status", step.status);
  fields.unless_empty("message", step.message);
  list_state(fields, step.end);
  list_counts(fields, step.end.work);
  fields("certificate", step.end.certificate);
  fields("resolved", step.end.resolution);
  list_errors(fields, step.end.errors);
  fields("seconds", step.end.work.seconds);
  fields("dissipated_total", step.end.energy.dissipated_total);
}

void list_model(auto& fields, Is<ProblemRecord> auto& problem) {
  fields.within("model", [&](auto& model) { model("left_out", problem.left_out); });
}

void list_history(auto& fields, Is<HistoryRecord> auto& history) {
  fields.within("history", [&](auto& sums) {
    std::size_t steps = history.steps.size();
    sums("steps", steps);
    sums("dissipated", history.dissipated);
    sums("worst_gap", history.worst_gap);
    sums("operator_applications", history.operator_applications);
    sums("seconds", history.seconds);
  });
}

void list_on_grid(auto& fields, Is<SolveRecord> auto& record) {
  auto& problem = record.problem;
  auto& end = record.end;
  fields("operator", problem.op);
  fields("cell_traction", problem.cell_traction);
  fields("pressure", problem.pressure);
  list_model(fields, problem);
  fields("cells", problem.cells);
  fields("cell_size", problem.cell_size);
  fields.unless_empty("roughness", problem.roughness);
  list_state(fields, end);
  list_counts(fields, end.work);
  fields("grids", record.method.grids);
  fields("safeguards", record.method.safeguards);
  fields("pressure_iterations", record.method.pressure_iterations);
  fields("pressure_complementarity", record.method.pressure_complementarity);
  fields("tolerance", problem.tolerance);
  fields("change", record.method.change);
  fields("certificate", end.certificate);
  fields("resolved", end.resolution);
  fields("slip_direction", record.method.slip_direction);
  list_errors(fields, end.errors);
  fields.ahead("history", record.history);
  if (!record.history) fields("dissipated_total", end.energy.dissipated_total);
  fields("seconds", end.work.seconds);
  fields("solver_bytes", record.memory.solver_bytes);
  fields("predicted_bytes", record.memory.predicted_bytes);
  fields("peak_bytes", record.memory.peak_bytes);
  fields("provenance", record.provenance);
  fields("ranks", record.memory.ranks);
  if (record.history) {
    list_history(fields, *record.history);
    fields("dissipated_total", end.energy.dissipated_total);
    fields("steps", record.history->steps);
  }
  fields("program", record.program);
  fields("profile", record.profile);
  fields("stress_error", record.stress_error);
}

void list_exact(auto& fields, Is<SolveRecord> auto& record) {
  auto& [contact, friction, loads, energy, certificate, resolution, errors, work] = record.end;
  fields("profile", record.problem.profile);
  list_model(fields, record.problem);
  fields.missing({"operator", "cells", "cell_size", "contact_cells", "stick_cells", "contact_area", "stick_area"},
                 "the exact solution needs no grid");
  fields("contact_radius", contact.contact_radius);
  fields("stick_radius", contact.stick_radius);
  fields.missing({"contact_radius_counted", "stick_radius_counted"}, "there are no cells to count");
  fields("stick_ratio", contact.stick_ratio);
  list_friction(fields, friction);
  fields("normal_load", contact.normal_load);
  fields("peak_pressure", contact.peak_pressure);
  fields("approach", contact.approach);
  fields("twist_angle", loads.twist_angle);
  fields("moment", loads.moment);
  fields("moment_limit", loads.moment_limit);
  fields("moment_ratio", loads.moment_ratio);
  fields("twist", loads.twist);
  fields("force", loads.force);
  fields("displacement", loads.displacement);
  fields("dissipated", energy.dissipated);
  int none = 0;
  fields("iterations", none);
  fields("operator_applications", none);
  fields.missing({"certificate", "slip_direction"},
                 "nothing to certify: the exact solution meets Coulomb's law everywhere");
  list_errors(fields, errors);
  fields.within("seconds", [&](auto& seconds) { seconds("total", record.end.work.seconds.total); });
  fields("peak_bytes", record.memory.peak_bytes);
  fields("provenance", record.provenance);
}

void list_fields(auto& fields, Is<SolveRecord> auto& record) {
  fields.ahead("status", record.status);
  if (record.is_failed()) {
    fields("status", record.status);
    fields("message", record.message);
    fields("run", record.run);
    fields.if_true("out_of_memory", record.out_of_memory);
    return;
  }
  fields("name", record.name);
  fields("status", record.status);
  fields.unless_empty("message", record.message);
  fields.unless_empty("warnings", record.warnings);
  fields.unless_empty("method", record.problem.method);
  if (record.is_exact()) return list_exact(fields, record);
  if (!record.problem.method.empty()) return list_on_grid(fields, record);
  fields.ahead("history", record.history);
  list_history(fields, *record.history);
  fields("steps", record.history->steps);
}

namespace {

template <typename Record>
Record record_of(const Json& json) {
  try {
    Record record;
    FieldReader fields(json);
    list_fields(fields, record);
    return record;
  } catch (const Json::exception& error) {
    throw solver::InputError("a result", fmt::format("lacks what results have: {}", error.what()));
  }
}

}  // namespace

std::string to_string(RunStatus status) { return kStatusWords[static_cast<std::size_t>(status)]; }

double SolveRecord::seconds() const {
  if (is_failed()) return Number().value;
  return history ? history->seconds : end.work.seconds.total;
}

Json to_json(const SolveRecord& record) { return FieldWriter::json_of(record); }
std::vector<Json> to_json(const std::vector<SolveRecord>& records) {
  std::vector<Json> all;
  for (const SolveRecord& record : records) all.push_back(to_json(record));
  return all;
}
SolveRecord from_json(const Json& json) { return record_of<SolveRecord>(json); }
Json to_json(const StepRecord& step) { return FieldWriter::json_of(step); }
StepRecord step_from_json(const Json& json) { return record_of<StepRecord>(json); }
Json to_json(const CertificateRecord& certificate) { return FieldWriter::json_of(certificate); }
Json to_json(const solver::Safeguards& safeguards) { return FieldWriter::json_of(safeguards); }
Json to_json(const FieldErrorRecord& error) { return FieldWriter::json_of(error); }
Json to_json(const TractionErrorRecord& error) { return FieldWriter::json_of(error); }
void to_json(Json& json, const Provenance& provenance) { json = FieldWriter::json_of(provenance); }

}  // namespace slipstick::convergence
