#include "convergence/results/record_text.hpp"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "convergence/results/make_record.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/scene/friction_law.hpp"

namespace slipstick::convergence {
namespace {

using solver::Units;

/// Two sums over the same cells are equal within this, relative.
constexpr double kEqualSums = 1e-12;

std::string error_text(double error) { return std::isnan(error) ? "" : fmt::format("   (error {:+.1e})", error); }

/// A value in SI with the unit in which the scene's file has such numbers.
std::string measured(const Units& units, double value, const std::string& si) {
  return fmt::format("{} {}", number_text(units.of(si, value)), units.word(si));
}

std::string pair_text(const Units& units, const Components& pair, const std::string& si) {
  return fmt::format("[{}, {}] {}", number_text(units.of(si, pair.values[0])),
                     number_text(units.of(si, pair.values[1])), units.word(si));
}

/// Tangential force and translation, where they are not zero.
std::string translation_text(const EndRecord& end, const Units& units) {
  std::string text;
  if (end.loads.force.length() > kEqualSums * end.friction.force) {
    text += text_line("force", pair_text(units, end.loads.force, "N"));
  }
  if (end.loads.displacement.length() > 0.0) {
    text +=
        text_line("displacement", pair_text(units, end.loads.displacement, "m") + error_text(end.errors.displacement));
  }
  return text;
}

std::string area_text(const solver::CountedArea& area, const Units& units) {
  const auto in = [&](double square) { return units.of("m", units.of("m", square)); };
  return fmt::format("{} +/- {:.2g} {}^2 ({} counted)", number_text(in(area.corrected)), in(area.uncertainty),
                     units.word("m"), number_text(in(area.counted)));
}

/// The ratio only where the radius has no error: an exact solution may know the ratio without the radius.
std::string stick_text(const EndRecord& end, const Units& units) {
  const ContactRecord& contact = end.contact;
  const std::string error = error_text(end.errors.stick_radius);
  std::string text = text_line("stick radius", measured(units, contact.stick_radius, "m") + error);
  if (contact.contact_radius == contact.contact_radius_counted) {  // the contact is no circle
    text += text_line("contact area", area_text(contact.contact_area, units));
    text += text_line("stick area", area_text(contact.stick_area, units));
  }
  if (error.empty()) {
    text += text_line("stick ratio", number_text(contact.stick_ratio) + error_text(end.errors.stick_ratio));
  }
  return text;
}

/// Counts of the steps in which Newton's method left its plain way; empty: none.
std::string safeguards_text(const solver::Safeguards& safeguards) {
  std::string text;
  for (const auto& [count, words] : {std::pair{safeguards.second_solves, "second linear solves"},
                                     {safeguards.halvings, "halvings of a step"},
                                     {safeguards.gradient_steps, "gradient steps"},
                                     {safeguards.breakdowns, "breakdowns of conjugate gradients"}}) {
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, words);
  }
  if (!safeguards.breakdown.empty()) text += fmt::format(" (the first: {})", safeguards.breakdown);
  return text;
}

/// Status and work. The operator applications of another program are not known.
std::string status_text(const SolveRecord& record) {
  const WorkRecord& work = record.end.work;
  const std::string applications =
      record.program ? "" : number_text(work.operator_applications) + " operator applications, ";
  std::string text = text_line("status", fmt::format("{} ({} iterations, {}{} s)", to_string(record.status),
                                                     work.iterations, applications, number_text(work.seconds.total)));
  if (!record.message.empty()) text += text_line("why", record.message);
  const std::string safeguards = safeguards_text(record.method.safeguards);
  return safeguards.empty() ? text : text + text_line("safeguards", safeguards);
}

/// State of the contact, with errors where they are known.
std::string state_text(const EndRecord& end, const Units& units) {
  const auto& [contact, friction, loads, energy, certificate, resolution, errors, work] = end;
  const bool has_peak = std::isfinite(contact.peak_pressure.value);
  return text_line("normal load", measured(units, contact.normal_load, "N")) +
         text_line("contact radius", measured(units, contact.contact_radius, "m") + error_text(errors.contact_radius)) +
         text_line("peak pressure",
                   has_peak ? measured(units, contact.peak_pressure, "Pa") + error_text(errors.peak_pressure)
                            : contact.peak_pressure.why_missing) +
         text_line("moment", fmt::format("{} = {} of the limit {}", measured(units, loads.moment, "N m"),
                                         number_text(loads.moment_ratio), measured(units, loads.moment_limit, "N m")) +
                                 error_text(errors.moment)) +
         text_line("twist", measured(units, loads.twist_angle, "rad") + error_text(errors.twist)) +
         translation_text(end, units) + stick_text(end, units);
}

/// The parts of the problem that the model leaves out.
std::string model_text(const ProblemRecord& problem) {
  std::string text;
  for (const auto& [what, why] : problem.left_out) {
    text += text_line("left out", fmt::format("{} ({})", what, why));
  }
  return text;
}

/// One line for each step, of long histories for the last ones.
std::string steps_text(const HistoryRecord& history, const Units& units) {
  constexpr std::size_t kMostLines = 24;
  const std::vector<StepRecord>& steps = history.steps;
  constexpr const char* kRow = "  {:<16} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11}  {}\n";
  const auto head = [&](const char* name, const char* si) { return fmt::format("{} ({})", name, units.word(si)); };
  const auto in = [&](double value, const char* si) { return short_text(units.of(si, value)); };
  std::string text = fmt::format(kRow, "step", head("W", "N"), head("M", "N m"), head("|F|", "N"), head("twist", "rad"),
                                 head("|delta|", "m"), "lost (J)", "gap");
  const std::size_t first = steps.size() > kMostLines ? steps.size() - kMostLines : 0;
  if (first > 0) text += fmt::format("  ({} steps before)\n", first);
  for (std::size_t i = first; i < steps.size(); ++i) {
    const EndRecord& end = steps[i].end;
    text += fmt::format(kRow, steps[i].name, in(end.contact.normal_load, "N"), in(end.loads.moment, "N m"),
                        in(end.loads.force.length(), "N"), in(end.loads.twist_angle, "rad"),
                        in(end.loads.displacement.length(), "m"), short_text(end.energy.dissipated),
                        short_text(end.certificate.gap));
  }
  return text +
         text_line("history", fmt::format("{} steps, {} J lost, gap/energy at most {}, {} operator "
                                          "applications, {} s",
                                          steps.size(), number_text(history.dissipated), number_text(history.worst_gap),
                                          number_text(history.operator_applications), number_text(history.seconds)));
}

/// The factor by which the loads could rise, and how the body would slide then.
std::string limit_text(const LimitRecord& limit, const Units& units) {
  if (!limit.centre && !limit.direction) return "";
  const std::array<double, 2>& pair = limit.centre ? *limit.centre : *limit.direction;
  const auto in = [&](double x) { return short_text(limit.centre ? units.of("m", x) : x); };
  return text_line("limit", fmt::format("{} times these loads; it would slide {} ({}, {}){}", number_text(limit.factor),
                                        limit.centre ? "turning about" : "along", in(pair[0]), in(pair[1]),
                                        limit.centre ? " " + units.word("m") : ""));
}

std::string field_error_text(const std::string& label, const FieldErrorRecord& error) {
  return text_line(label, fmt::format("{} in L1, {} in L2 (relative)", number_text(error.l1), number_text(error.l2)));
}

/// Errors of the fields, or the reason why they are not known.
std::string exact_answer_text(const ErrorsRecord& errors) {
  if (!errors.exact) return text_line("exact answer", "none: " + errors.twist.why_missing);
  if (!std::isnan(errors.traction.at_centres.l1)) {
    return field_error_text("traction error", errors.traction.at_centres);
  }
  if (!std::isnan(errors.exact->stick_ratio)) return "";
  return text_line("exact answer", errors.exact->stick_ratio.why_missing) +
         field_error_text("pressure error", errors.pressure);
}

/// Iterations between pressure and shear.
std::string coupling_text(const SolveRecord& record) {
  if (!record.end.work.turns) return "";
  return text_line("full coupling",
                   fmt::format("{} turns of pressure and shear, complementarity gap {}", *record.end.work.turns,
                               number_text(record.method.pressure_complementarity)));
}

std::string unit_of(const std::string& number) {
  return number == "twist_angle" ? "rad" : number == "displacement" ? "m" : number == "moment" ? "N m" : "N";
}

/// Resolution of the mesh, and the uncertainty of the answer.
std::string resolution_text(const ResolutionRecord& resolved, const Units& units) {
  const bool open = resolved.absolute != 0.0;
  const std::string number = resolved.number == "twist_angle" ? "twist" : resolved.number;
  const std::string percent = percent_text(resolved.uncertainty);
  const std::string si = unit_of(resolved.number);
  const auto in = [&](double value) { return short_text(units.of(si, value)); };
  const std::string text = text_line("resolved", fmt::format("stick area {:.3g} cells wide, slip area {:.3g}",
                                                             resolved.stick_width, resolved.slip_width));
  const std::string uncertain = text_line(
      "uncertain", open ? fmt::format("{} by {} {} ({}): mesh {}, length of steps {}", number, in(resolved.absolute),
                                      units.word(si), percent, in(resolved.mesh), in(resolved.path))
                        : "by about " + percent);
  return text + uncertain + (resolved.warning.empty() ? "" : text_line("warning", resolved.warning));
}

/// A note where the gap is relative to another energy, or does not meet the tolerance for rounding.
std::string energy_text(const SolveRecord& record) {
  const CertificateRecord& certificate = record.end.certificate;
  const double energy = certificate.energy.value_or(Number());
  const double held = record.end.energy.elastic;
  if (energy > (1.0 + kEqualSums) * held) {
    return text_line("", fmt::format("over {} J, which a state before held: an error is absolute, and these "
                                     "tractions hold {} J",
                                     number_text(energy), number_text(held)));
  }
  const bool hidden =
      record.is_converged() && record.problem.method != "paper" && certificate.gap > record.problem.tolerance;
  if (!hidden) return "";
  return text_line("", fmt::format("rounding hides the rest of the gap; the energy is within {} of the least",
                                   number_text(certificate.energy_error)));
}

std::string continuum_text(const CertificateRecord& certificate, const Units& units) {
  if (!certificate.continuum) return "";
  const ContinuumRecord& continuum = *certificate.continuum;
  if (std::isnan(continuum.gap)) return text_line("continuum", "no gap: " + continuum.gap.why_missing);
  std::string text =
      text_line("continuum", fmt::format("gap/energy {} +- {} in all of the contact, not only at the cells' centres",
                                         number_text(continuum.gap), number_text(continuum.quadrature_error)));
  if (!std::isnan(continuum.low + continuum.high)) {
    const std::string si = unit_of(continuum.number);
    text += text_line("", fmt::format("{} between {} and {} {}, under this friction bound",
                                      continuum.number == "twist_angle" ? "twist" : continuum.number,
                                      number_text(units.of(si, continuum.low)),
                                      number_text(units.of(si, continuum.high)), units.word(si)));
  }
  if (!std::isnan(continuum.pressure_gap)) {
    text += text_line("", fmt::format("pressure: gap/energy {} +- {}", number_text(continuum.pressure_gap),
                                      number_text(continuum.pressure_quadrature_error)));
  }
  if (!std::isnan(continuum.friction_bound_error)) {
    text += text_line("", fmt::format("its error may lower the least energy of the tractions by {}",
                                      percent_text(continuum.friction_bound_error)));
  }
  return text;
}

/// The law of a result's key friction_law; empty: Coulomb's.
solver::FrictionKind friction_law_of(const std::string& word) {
  using enum solver::FrictionKind;
  for (const auto kind : {tresca, capped, power}) {
    if (word == to_string(kind)) return kind;
  }
  return coulomb;
}

std::string certificate_text(const SolveRecord& record, const Units& units) {
  const CertificateRecord& certificate = record.end.certificate;
  const solver::FrictionKind law = friction_law_of(record.end.friction.law);
  const SlipDirectionRecord& direction = record.method.slip_direction;
  const std::string angles = fmt::format("{} degrees off in the mean, {} at most ({})", number_text(direction.mean),
                                         number_text(direction.max), right_direction_text(law));
  return text_line("certificate", fmt::format("gap/energy {}, moment off by {}, |q| above {} by {}",
                                              number_text(certificate.gap), number_text(certificate.moment),
                                              solver::bound_text(law), number_text(certificate.friction_bound))) +
         energy_text(record) + continuum_text(certificate, units) +
         text_line("slip direction", direction.mean.why_missing == kNoSlip ? kNoSlip : angles);
}

std::string title_of(const SolveRecord& record) {
  const ProblemRecord& problem = record.problem;
  if (record.is_exact()) return fmt::format("{}: exact solution, profile {}\n", record.name, problem.profile);
  const std::string by = record.program ? "program " + record.program->name
                                        : fmt::format("operator {}, method {}", problem.op, problem.method);
  return fmt::format("{}: {} x {} cells, pressure {}, {}\n", record.name, problem.cells[0], problem.cells[1],
                     problem.pressure, by);
}

}  // namespace

std::string right_direction_text(solver::FrictionKind law) {
  return law == solver::FrictionKind::coulomb ? "Coulomb: 0" : "right: 0";
}

std::string solve_text(const SolveRecord& record, const Units& units) {
  const std::string state = title_of(record) + status_text(record) + state_text(record.end, units);
  if (record.is_exact()) return state + model_text(record.problem);
  return state + limit_text(record.end.loads.limit, units) + coupling_text(record) +
         exact_answer_text(record.end.errors) + certificate_text(record, units) +
         resolution_text(record.end.resolution, units) + model_text(record.problem) +
         (record.history ? steps_text(*record.history, units) : "");
}

}  // namespace slipstick::convergence
