#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "convergence/results/exact_result.hpp"
#include "convergence/results/result.hpp"

namespace slipstick::convergence {
namespace {

/// Two sums over the same cells are equal to this, relative.
constexpr double kEqualSums = 1e-12;

std::string error_text(const Json& result, const std::string& key) {
  const auto found = result.find(key);
  return found != result.end() && found->is_number() ? fmt::format("   (error {:+.1e})", found->get<double>())
                                                     : "";
}

/// NaN where the pair is not known.
double size_of(const Json& pair) {
  return pair.is_array() ? std::hypot(pair[0].get<double>(), pair[1].get<double>()) : std::nan("");
}

/// Forces and translations, where there are any.
std::string translation_text(const Json& r) {
  const auto pair = [](const Json& value) {
    return fmt::format("[{}, {}]", number_text(value[0]), number_text(value[1]));
  };
  constexpr double rounding = 1e-12;  // of a sum over the cells, relative
  const double friction = r["friction_force"].get<double>();
  std::string text;
  if (size_of(r["force"]) > rounding * friction) text += text_line("force", pair(r["force"]) + " N");
  if (size_of(r["displacement"]) > 0.0) {
    text += text_line("displacement", pair(r["displacement"]) + " m" + error_text(r, "displacement_error"));
  }
  return text;
}

/// Without a radius to compare, the ratio, which an exact solution may say alone.
std::string stick_text(const Json& r) {
  const std::string error = error_text(r, "stick_radius_error");
  std::string text = text_line("stick radius", number_text(r["stick_radius"]) + " m" + error);
  if (r["contact_area"].is_object() &&
      r["contact_radius"] == r["contact_radius_counted"]) {  // of an area that is no circle
    const auto area = [](const Json& json) {
      return fmt::format("{} +/- {:.2g} m^2 ({} counted)", number_text(json["corrected"]),
                         json["uncertainty"].get<double>(), number_text(json["counted"]));
    };
    text += text_line("contact area", area(r["contact_area"]));
    text += text_line("stick area", area(r["stick_area"]));
  }
  if (error.empty()) {
    text += text_line("stick ratio", number_text(r["stick_ratio"]) + error_text(r, "stick_ratio_error"));
  }
  return text;
}

/// The steps of a solve that were not plain ones; empty: none.
std::string safeguards_text(const Json& r) {
  if (!r.contains("safeguards")) return "";
  std::string text;
  for (const auto& [key, words] : {std::pair{"second_solves", "second linear solves"},
                                   {"halvings", "halvings of a step"},
                                   {"gradient_steps", "gradient steps"},
                                   {"breakdowns", "breakdowns of conjugate gradients"}}) {
    const int count = r["safeguards"][key].get<int>();
    if (count > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, words);
  }
  if (r["safeguards"].contains("breakdown")) {
    text += fmt::format(" (the first: {})", r["safeguards"]["breakdown"].get<std::string>());
  }
  return text;
}

/// How the solve went. Another program's operator is its own.
std::string status_text(const Json& r) {
  const std::string applications =
      r.contains("program") ? "" : number_text(r["operator_applications"]) + " operator applications, ";
  std::string text = text_line(
      "status", fmt::format("{} ({} iterations, {}{} s)", r["status"].get<std::string>(),
                            r["iterations"].get<int>(), applications, number_text(r["seconds"]["total"])));
  if (r.contains("message")) text += text_line("why", r["message"].get<std::string>());
  if (const std::string taken = safeguards_text(r); !taken.empty()) text += text_line("safeguards", taken);
  return text;
}

/// The contact's state, with its errors where they are known.
std::string state_text(const Json& r) {
  const Json& peak = r["peak_pressure"];
  return text_line("normal load", number_text(r["normal_load"]) + " N") +
         text_line("contact radius",
                   number_text(r["contact_radius"]) + " m" + error_text(r, "contact_radius_error")) +
         text_line("peak pressure", peak.is_number()
                                        ? number_text(peak) + " Pa" + error_text(r, "peak_pressure_error")
                                        : r["peak_pressure_reason"].get<std::string>()) +
         text_line("moment", fmt::format("{} N m = {} of the limit {} N m", number_text(r["moment"]),
                                         number_text(r["moment_ratio"]), number_text(r["moment_limit"])) +
                                 error_text(r, "moment_error")) +
         text_line("twist", number_text(r["twist_angle"]) + " rad" + error_text(r, "twist_error")) +
         (r.contains("load_warning") ? text_line("warning", r["load_warning"].get<std::string>()) : "") +
         translation_text(r) + stick_text(r);
}

/// The parts of the problem that the model skips.
std::string model_text(const Json& r) {
  std::string text;
  for (const Json& omission : r["model"]["left_out"]) {
    text += text_line("left out", fmt::format("{} ({})", omission["what"].get<std::string>(),
                                              omission["why"].get<std::string>()));
  }
  return text;
}

/// A line a step, of long histories the last ones.
std::string steps_text(const Json& r) {
  constexpr std::size_t most = 24;
  const Json& steps = r["steps"];
  std::string text = fmt::format("  {:<16} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11}  {}\n", "step", "W (N)",
                                 "M (N m)", "|F| (N)", "twist (rad)", "|delta| (m)", "lost (J)", "gap");
  const auto size_text = [](const Json& pair) {
    return pair.is_array() ? fmt::format("{:.4g}", size_of(pair)) : "-";
  };
  const std::size_t first = steps.size() > most ? steps.size() - most : 0;
  if (first > 0) text += fmt::format("  ({} steps before)\n", first);
  for (std::size_t i = first; i < steps.size(); ++i) {
    const Json& step = steps[i];
    text += fmt::format("  {:<16} {:>11} {:>11} {:>11} {:>11} {:>11} {:>11}  {}\n",
                        step["name"].get<std::string>(), short_text(step["normal_load"]),
                        short_text(step["moment"]), size_text(step["force"]), short_text(step["twist_angle"]),
                        size_text(step["displacement"]), short_text(step["dissipated"]),
                        short_text(step["certificate"]["gap"]));
  }
  return text + text_line("history", fmt::format("{} steps, {} J lost, gap/energy at most {}, {} operator "
                                                 "applications, {} s",
                                                 steps.size(), number_text(r["history"]["dissipated"]),
                                                 number_text(r["history"]["worst_gap"]),
                                                 number_text(r["history"]["operator_applications"]),
                                                 number_text(r["history"]["seconds"])));
}

/// How far the loads could rise, and how the body would slide then.
std::string limit_text(const Json& r) {
  const Json& limit = r["limit"];
  if (!limit["factor"].is_number()) return "";
  const bool turns = limit.contains("centre");
  const Json& pair = limit[turns ? "centre" : "direction"];
  return text_line("limit", fmt::format("{} times these loads; it would slide {} ({}, {}){}",
                                        number_text(limit["factor"]), turns ? "turning about" : "along",
                                        short_text(pair[0]), short_text(pair[1]), turns ? " m" : ""));
}

/// The errors of the fields, or why they are not known.
std::string exact_answer_text(const Json& r) {
  const Json& error = r["traction_error"];
  if (!error.is_object()) {
    return text_line("exact answer", "none: " + r["traction_error_reason"].get<std::string>());
  }
  if (error["l1"].is_number()) {
    return text_line("traction error", fmt::format("{} in L1, {} in L2 (relative)", number_text(error["l1"]),
                                                   number_text(error["l2"])));
  }
  if (r["exact"]["stick_ratio"].is_number()) return "";
  return text_line("exact answer", r["exact"]["stick_ratio_reason"].get<std::string>()) +
         text_line("pressure error",
                   fmt::format("{} in L1, {} in L2 (relative)", number_text(r["pressure_error"]["l1"]),
                               number_text(r["pressure_error"]["l2"])));
}

/// How pressure and shear were brought together.
std::string coupling_text(const Json& r) {
  if (!r.contains("turns")) return "";
  return text_line("full coupling",
                   fmt::format("{} turns of pressure and shear, complementarity gap {}",
                               r["turns"].get<int>(), number_text(r["pressure_complementarity"])));
}

std::string words_of(const Json& resolved) {
  const std::string number = resolved["number"];
  return number == "twist_angle" ? "twist" : number;
}

std::string unit_of(const Json& resolved) {
  const std::string number = resolved["number"];
  return number == "twist_angle" ? "rad" : number == "displacement" ? "m" : number == "moment" ? "N m" : "N";
}

/// How well the mesh resolves the contact, and how far the answer may be off.
std::string resolution_text(const Json& r) {
  const Json& resolved = r["resolved"];
  const bool open = resolved["absolute"] != 0.0;
  std::string text =
      text_line("resolved",
                fmt::format("stick area {:.3g} cells wide, slip area {:.3g}",
                            resolved["stick_width"].get<double>(), resolved["slip_width"].get<double>())) +
      text_line("uncertain", open ? fmt::format("{} by {} {} ({}): mesh {}, length of steps {}",
                                                words_of(resolved), short_text(resolved["absolute"]),
                                                unit_of(resolved), percent_text(resolved["uncertainty"]),
                                                short_text(resolved["mesh"]), short_text(resolved["path"]))
                                  : "by about " + percent_text(resolved["uncertainty"]));
  if (!resolved.contains("warning")) return text;
  return text + text_line("warning", resolved["warning"].get<std::string>());
}

/// How far rounding let the certificate go, where that is not as far as the tolerance.
std::string energy_text(const Json& r) {
  const Json& gap = r["certificate"]["gap"];
  const Json& energy = r["certificate"]["energy"];
  const Json& held = r["elastic_energy"];
  if (energy.is_number() && held.is_number() && energy > (1.0 + kEqualSums) * held.get<double>()) {
    return text_line("", fmt::format("over {} J, which a state before held: an error is absolute, and these "
                                     "tractions hold {} J",
                                     number_text(energy), number_text(held)));
  }
  if (r["status"] != "converged" || r["method"] == "paper" || !gap.is_number() || gap <= r["tolerance"])
    return "";
  return text_line("", fmt::format("rounding hides the rest of the gap; the energy is within {} of the least",
                                   number_text(r["certificate"]["energy_error"])));
}

}  // namespace

std::string solve_text(const Json& r) {
  std::string by =
      fmt::format("operator {}, method {}", r["operator"].get<std::string>(), r["method"].get<std::string>());
  if (r.contains("program")) by = "program " + r["program"]["name"].get<std::string>();
  std::string text =
      fmt::format("{}: {} x {} cells, pressure {}, {}\n", r["name"].get<std::string>(),
                  r["cells"][0].get<int>(), r["cells"][1].get<int>(), r["pressure"].get<std::string>(), by);
  text += status_text(r) + state_text(r) + limit_text(r) + coupling_text(r);
  text += exact_answer_text(r);
  text += text_line("certificate",
                    fmt::format("gap/energy {}, moment off by {}, |q| above {} by {}",
                                number_text(r["certificate"]["gap"]), number_text(r["certificate"]["moment"]),
                                bound_text(r), number_text(r["certificate"]["friction_bound"])));
  text += energy_text(r);
  const Json& direction = r["slip_direction"];
  text +=
      text_line("slip direction", direction.value("mean_reason", "") == kNoSlip
                                      ? kNoSlip
                                      : fmt::format("{} degrees off in the mean, {} at most ({})",
                                                    number_text(direction["mean"]),
                                                    number_text(direction["max"]), right_direction_text(r)));
  text += resolution_text(r);
  text += model_text(r);
  return r.contains("steps") ? text + steps_text(r) : text;
}

std::string exact_text(const Json& r) {
  return fmt::format("{}: exact solution, profile {}\n", r["name"].get<std::string>(),
                     r["profile"].get<std::string>()) +
         status_text(r) + state_text(r) + model_text(r);
}

}  // namespace slipstick::convergence
