#include "convergence/results/record_text.hpp"

#include <fmt/core.h>

#include <cmath>
#include <utility>

#include "convergence/results/make_record.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/scene/friction_law.hpp"

namespace slipstick::convergence {
namespace {

/// Two sums over the same cells are equal within this, relative.
constexpr double kEqualSums = 1e-12;

std::string error_text(double error) {
  return std::isnan(error) ? "" : fmt::format("   (error {:+.1e})", error);
}

std::string pair_text(const Components& pair) {
  return fmt::format("[{}, {}]", number_text(pair.values[0]), number_text(pair.values[1]));
}

/// Tangential force and translation, where they are not zero.
std::string translation_text(const EndRecord& end) {
  std::string text;
  if (end.loads.force.length() > kEqualSums * end.friction.force) {
    text += text_line("force", pair_text(end.loads.force) + " N");
  }
  if (end.loads.displacement.length() > 0.0) {
    text += text_line("displacement",
                      pair_text(end.loads.displacement) + " m" + error_text(end.errors.displacement));
  }
  return text;
}

std::string area_text(const solver::CountedArea& area) {
  return fmt::format("{} +/- {:.2g} m^2 ({} counted)", number_text(area.corrected), area.uncertainty,
                     number_text(area.counted));
}

/// The ratio only where the radius has no error: an exact solution may know the ratio without the radius.
std::string stick_text(const EndRecord& end) {
  const ContactRecord& contact = end.contact;
  const std::string error = error_text(end.errors.stick_radius);
  std::string text = text_line("stick radius", number_text(contact.stick_radius) + " m" + error);
  if (contact.contact_radius == contact.contact_radius_counted) {  // the contact is no circle
    text += text_line("contact area", area_text(contact.contact_area));
    text += text_line("stick area", area_text(contact.stick_area));
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
  std::string text =
      text_line("status", fmt::format("{} ({} iterations, {}{} s)", to_string(record.status), work.iterations,
                                      applications, number_text(work.seconds.total)));
  if (!record.message.empty()) text += text_line("why", record.message);
  const std::string safeguards = safeguards_text(record.method.safeguards);
  return safeguards.empty() ? text : text + text_line("safeguards", safeguards);
}

/// State of the contact, with errors where they are known.
std::string state_text(const EndRecord& end) {
  const auto& [contact, friction, loads, energy, certificate, resolution, errors, work] = end;
  const bool has_peak = std::isfinite(contact.peak_pressure.value);
  return text_line("normal load", number_text(contact.normal_load) + " N") +
         text_line("contact radius",
                   number_text(contact.contact_radius) + " m" + error_text(errors.contact_radius)) +
         text_line("peak pressure",
                   has_peak ? number_text(contact.peak_pressure) + " Pa" + error_text(errors.peak_pressure)
                            : contact.peak_pressure.why_missing) +
         text_line("moment", fmt::format("{} N m = {} of the limit {} N m", number_text(loads.moment),
                                         number_text(loads.moment_ratio), number_text(loads.moment_limit)) +
                                 error_text(errors.moment)) +
         text_line("twist", number_text(loads.twist_angle) + " rad" + error_text(errors.twist)) +
         (loads.warning.empty() ? "" : text_line("warning", loads.warning)) + translation_text(end) +
         stick_text(end);
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
std::string steps_text(const HistoryRecord& history) {
  constexpr std::size_t kMostLines = 24;
  const std::vector<StepRecord>& steps = history.steps;
  constexpr const char* kRow = "  {:<16} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11}  {}\n";
  std::string text = fmt::format(kRow, "step", "W (N)", "M (N m)", "|F| (N)", "twist (rad)", "|delta| (m)",
                                 "lost (J)", "gap");
  const std::size_t first = steps.size() > kMostLines ? steps.size() - kMostLines : 0;
  if (first > 0) text += fmt::format("  ({} steps before)\n", first);
  for (std::size_t i = first; i < steps.size(); ++i) {
    const EndRecord& end = steps[i].end;
    text += fmt::format(kRow, steps[i].name, short_text(end.contact.normal_load),
                        short_text(end.loads.moment), short_text(end.loads.force.length()),
                        short_text(end.loads.twist_angle), short_text(end.loads.displacement.length()),
                        short_text(end.energy.dissipated), short_text(end.certificate.gap));
  }
  return text +
         text_line("history",
                   fmt::format("{} steps, {} J lost, gap/energy at most {}, {} operator "
                               "applications, {} s",
                               steps.size(), number_text(history.dissipated), number_text(history.worst_gap),
                               number_text(history.operator_applications), number_text(history.seconds)));
}

/// The factor by which the loads could rise, and how the body would slide then.
std::string limit_text(const LimitRecord& limit) {
  if (!limit.centre && !limit.direction) return "";
  const std::array<double, 2>& pair = limit.centre ? *limit.centre : *limit.direction;
  return text_line("limit", fmt::format("{} times these loads; it would slide {} ({}, {}){}",
                                        number_text(limit.factor), limit.centre ? "turning about" : "along",
                                        short_text(pair[0]), short_text(pair[1]), limit.centre ? " m" : ""));
}

std::string field_error_text(const std::string& label, const FieldErrorRecord& error) {
  return text_line(
      label, fmt::format("{} in L1, {} in L2 (relative)", number_text(error.l1), number_text(error.l2)));
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
                   fmt::format("{} turns of pressure and shear, complementarity gap {}",
                               *record.end.work.turns, number_text(record.method.pressure_complementarity)));
}

std::string unit_of(const std::string& number) {
  return number == "twist_angle" ? "rad" : number == "displacement" ? "m" : number == "moment" ? "N m" : "N";
}

/// Resolution of the mesh, and the uncertainty of the answer.
std::string resolution_text(const ResolutionRecord& resolved) {
  const bool open = resolved.absolute != 0.0;
  const std::string number = resolved.number == "twist_angle" ? "twist" : resolved.number;
  const std::string percent = percent_text(resolved.uncertainty);
  const std::string text = text_line("resolved", fmt::format("stick area {:.3g} cells wide, slip area {:.3g}",
                                                             resolved.stick_width, resolved.slip_width));
  const std::string uncertain =
      text_line("uncertain", open ? fmt::format("{} by {} {} ({}): mesh {}, length of steps {}", number,
                                                short_text(resolved.absolute), unit_of(resolved.number),
                                                percent, short_text(resolved.mesh), short_text(resolved.path))
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

std::string certificate_text(const SolveRecord& record) {
  const CertificateRecord& certificate = record.end.certificate;
  const solver::FrictionKind law = friction_law_of(record.end.friction.law);
  const SlipDirectionRecord& direction = record.method.slip_direction;
  const std::string angles =
      fmt::format("{} degrees off in the mean, {} at most ({})", number_text(direction.mean),
                  number_text(direction.max), right_direction_text(law));
  return text_line("certificate",
                   fmt::format("gap/energy {}, moment off by {}, |q| above {} by {}",
                               number_text(certificate.gap), number_text(certificate.moment),
                               solver::bound_text(law), number_text(certificate.friction_bound))) +
         energy_text(record) +
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

solver::FrictionKind friction_law_of(const std::string& word) {
  using enum solver::FrictionKind;
  for (const auto kind : {tresca, capped, power}) {
    if (word == to_string(kind)) return kind;
  }
  return coulomb;
}

std::string right_direction_text(solver::FrictionKind law) {
  return law == solver::FrictionKind::coulomb ? "Coulomb: 0" : "right: 0";
}

std::string solve_text(const SolveRecord& record) {
  const std::string state = title_of(record) + status_text(record) + state_text(record.end);
  if (record.is_exact()) return state + model_text(record.problem);
  return state + limit_text(record.end.loads.limit) + coupling_text(record) +
         exact_answer_text(record.end.errors) + certificate_text(record) +
         resolution_text(record.end.resolution) + model_text(record.problem) +
         (record.history ? steps_text(*record.history) : "");
}

}  // namespace slipstick::convergence
