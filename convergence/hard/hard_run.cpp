#include "convergence/hard/hard_run.hpp"

#include <fmt/ranges.h>

#include <cmath>
#include <optional>
#include <set>

#include "convergence/exchange/solver_program.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/runs/failed_runs.hpp"
#include "convergence/runs/run_batch.hpp"
#include "solver/input/input_error.hpp"
#include "solver/scene/scene_keys.hpp"

namespace slipstick::convergence {
namespace {

/// A case with its result and what was solved beside it.
struct Trial {
  const HardCase* hard = nullptr;
  std::optional<solver::Scene> scene;  ///< missing where it cannot be read
  Json result;
  JudgedCase judged;
  Json variants = Json::object();
  Json methods = Json::object();
  std::filesystem::path fields = {};
};

Json verdict_json(const std::string& verdict, const std::string& reason, const Json& numbers) {
  Json json{{"verdict", verdict}};
  if (!reason.empty()) json["reason"] = reason;
  if (!numbers.empty()) json.update(numbers);
  return json;
}

/// The grid of a result, written out, or one with `finer` times as many cells along each axis.
std::vector<std::string> grid_of(const Json& result, int finer = 1) {
  const auto cells = result["cells"].get<std::array<int, 2>>();
  const auto size = result["cell_size"].get<std::array<double, 2>>();
  return {fmt::format("grid.extent=[{:.17g},{:.17g}]", size[0] * cells[0], size[1] * cells[1]),
          fmt::format("grid.cells=[{},{}]", finer * cells[0], finer * cells[1])};
}

RunSpec seen(const Trial& trial, Variant variant) {
  RunSpec spec = trial.hard->run;
  spec.fields.clear();
  spec.variant = variant;
  if (has_given_grid(*trial.scene)) return spec;
  return changed(std::move(spec), grid_of(trial.result));
}

/// The worse of two verdicts stands, with its reason.
void judge_too(Trial& trial, HardVerdict verdict, std::string reason) {
  if (trial.judged.verdict >= verdict) return;
  trial.judged.verdict = verdict;
  trial.judged.reason = std::move(reason);
}

void judge_variant(Trial& trial, Variant variant, const Json& result) {
  const std::string name = to_string(variant);
  const std::string status = result["status"];
  const double difference =
      status == "converged" ? variant_difference(trial.result, result, variant) : std::nan("");
  set_number(trial.variants, name, difference, status);
  if (status != "converged") {
    const HardVerdict verdict = status == "not_converged" ? HardVerdict::not_converged : HardVerdict::wrong;
    judge_too(trial, verdict, fmt::format("{} it is {}: {}", name, status, result.value("message", "")));
  } else if (!(difference <= same_answer(trial.result))) {
    judge_too(trial, HardVerdict::wrong, fmt::format("{} it differs by {:.3g}", name, difference));
  }
}

void judge_variants(std::vector<Trial>& trials, const ProcessPool& pool) {
  RunBatch batch;
  for (Trial& trial : trials) {
    if (trial.judged.verdict != HardVerdict::certified) continue;
    for (const Variant variant : kVariants) {
      if (const std::string reason = why_not(*trial.scene, variant); !reason.empty()) {
        set_missing(trial.variants, to_string(variant), reason);
      } else {
        batch.add_or_refuse(seen(trial, variant),
                            [&trial, variant](const Json& result) { judge_variant(trial, variant, result); });
      }
    }
  }
  batch.run(pool);
}

/// Whether only finer meshes can say how far an answer is off.
bool needs_finer_meshes(const Trial& trial) {
  const Json& numbers = trial.judged.numbers;
  return trial.judged.verdict == HardVerdict::certified && numbers["error"].is_null() &&
         numbers["uncertainty"].is_number() && !has_given_grid(*trial.scene) &&
         std::isfinite(main_value(trial.result));
}

/// Whether a finer mesh may refuse what this one carries: a load so near the limit that the mesh decides.
bool is_at_limit(const Json& result) {
  constexpr double kMeshOfLimit = 1e-3;  ///< the limit differs by this from mesh to mesh, relative
  return result.contains("limit") && result["limit"]["factor"].is_number() &&
         result["limit"]["factor"] < 1.0 + kMeshOfLimit;
}

/// Answers without an exact one are held to those on twice and four times the cells.
void judge_by_finer_meshes(std::vector<Trial>& trials, const ProcessPool& pool) {
  std::map<Trial*, std::vector<double>> found;
  std::set<Trial*> refused;
  RunBatch batch;
  for (Trial& trial : trials) {
    if (!needs_finer_meshes(trial)) continue;
    for (const int finer : {2, 4}) {
      RunSpec spec = changed(trial.hard->run, grid_of(trial.result, finer));
      spec.overrides.push_back(fmt::format("solver.substeps={}", finer * trial.scene->substeps));
      batch.add_or_refuse(spec, [&trial, &refused, &found](const Json& result) {
        if (result["status"] == "refused" && is_at_limit(trial.result)) refused.insert(&trial);
        found[&trial].push_back(is_converged(result) ? main_value(result) : std::nan(""));
      });
    }
  }
  batch.run(pool);
  for (const auto& [trial, finer] : found) {
    Json& numbers = trial->judged.numbers;
    const MeshReference reference =
        judge_by_finer(main_value(trial->result), trial->result["resolved"]["absolute"], finer[0], finer[1]);
    const char* none = refused.contains(trial) ? "a finer mesh carries a little less than this load"
                                               : "a finer mesh has no answer";
    set_number(numbers, "finer_meshes.error", reference.error, none);
    set_number(numbers, "finer_meshes.change", reference.change, none);
    if (!reference.holds && !refused.contains(trial)) {
      judge_too(*trial, HardVerdict::wrong,
                fmt::format("it is {:.3g} from the answer on a finer mesh, and says {:.3g}", reference.error,
                            numbers["uncertainty"].get<double>()));
    }
  }
}

void compare_methods(std::vector<Trial>& trials, const std::vector<BesideMethod>& methods,
                     const ProcessPool& pool) {
  for (const auto& [method, override, is_program] : methods) {
    RunBatch batch;
    for (Trial& trial : trials) {
      const RunSpec spec = changed(trial.hard->run, {override});
      batch.add_or_refuse(spec, [&trial, method = method, is_program = is_program](const Json& result) {
        const bool failed = is_program && result["status"] == "failed";  // and says so
        const ComparedAnswer compared =
            failed ? ComparedAnswer{MethodVerdict::not_converged, result["message"], Json::object()}
                   : compare_answer(trial.result, result);
        trial.methods[method] = verdict_json(to_string(compared.verdict), compared.reason, compared.numbers);
      });
    }
    batch.run(pool);
  }
}

Json row(const Trial& trial) {
  Json row{{"family", trial.hard->family},
           {"case", trial.hard->name},
           {"set", trial.hard->run.overrides},
           {"scene", trial.hard->run.scene.string()}};
  row.update(verdict_json(to_string(trial.judged.verdict), trial.judged.reason, trial.judged.numbers));
  if (!trial.fields.empty() && trial.result.value("status", "") == "converged") {
    Json& written = row["written"] = {{"fields", trial.fields.string()}};
    for (const char* key :
         {"cells", "cell_size", "normal_load", "moment", "moment_limit", "force", "tolerance"}) {
      written[key] = trial.result[key];
    }
    written["certificate.rounding"] = trial.result["certificate"]["rounding"];
    if (trial.result.contains("steps") && trial.result["steps"].size() > 1) {
      written["before"] = step_before_file(trial.fields).string();
    }
  }
  if (!trial.variants.empty()) row["variants"] = trial.variants;
  if (!trial.methods.empty()) row["methods"] = trial.methods;
  return row;
}

Json counts(const std::vector<Trial>& trials, const std::string& family) {
  Json counts{{"certified", 0}, {"refused", 0}, {"not_converged", 0}, {"wrong", 0}};
  for (const Trial& trial : trials) {
    if (family.empty() || trial.hard->family == family) {
      Json& count = counts[to_string(trial.judged.verdict)];
      count = count.get<int>() + 1;
    }
  }
  return counts;
}

Json method_counts(const std::vector<Trial>& trials, const std::string& method) {
  Json counts{
      {"agrees", 0}, {"refused", 0}, {"not_converged", 0}, {"other_direction", 0}, {"other_answer", 0}};
  for (const Trial& trial : trials) {
    Json& count = counts[trial.methods[method]["verdict"].get<std::string>()];
    count = count.get<int>() + 1;
  }
  return counts;
}

std::string methods_text(const Json& methods) {
  std::string text = fmt::format("\n  {:20} {:>8} {:>8} {:>13} {:>15} {:>12}\n", "other methods", "agrees",
                                 "refused", "not converged", "other direction", "other answer");
  for (const auto& [name, counts] : methods.items()) {
    text += fmt::format("  {:20} {:>8} {:>8} {:>13} {:>15} {:>12}\n", name, counts["agrees"].get<int>(),
                        counts["refused"].get<int>(), counts["not_converged"].get<int>(),
                        counts["other_direction"].get<int>(), counts["other_answer"].get<int>());
  }
  return text;
}

}  // namespace

BesideMethod read_beside_method(const std::string& word) {
  if (word.ends_with(".toml")) return {read_solver_program(word).name, program_override(word), true};
  std::vector<std::string> allowed;
  for (const auto& [name, method] : solver::kMethods) {
    if (name == word) return {name, fmt::format("solver.method=\"{}\"", name), false};
    allowed.push_back(name);
  }
  throw solver::InputError("--beside " + word, fmt::format("is no method; allowed: {}, or a program's file "
                                                           "(.toml)",
                                                           fmt::join(allowed, ", ")));
}

Json run_hard_cases(const std::vector<HardCase>& cases, const HardOptions& options, const ProcessPool& pool) {
  std::vector<Trial> trials(cases.size());
  RunBatch first;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    Trial& trial = trials[i];
    trial.hard = &cases[i];
    RunSpec spec = cases[i].run;
    if (!options.fields.empty()) trial.fields = options.fields / fmt::format("{:05}.csv", i);
    spec.fields = trial.fields;
    spec.step_before = !spec.fields.empty();
    first.add_or_refuse(spec, [&trial](const Json& result) {
      trial.result = result;
      trial.judged = judge_alone(result);
      if (trial.judged.verdict != HardVerdict::certified) return;
      trial.scene = solver::read_scene(trial.hard->run.scene, trial.hard->run.overrides);
    });
  }
  first.run(pool);
  if (options.variants) judge_variants(trials, pool);
  if (options.finer_meshes) judge_by_finer_meshes(trials, pool);
  compare_methods(trials, options.methods, pool);

  Json json{{"counts", counts(trials, "")}, {"families", Json::object()}, {"rows", Json::array()}};
  for (const BesideMethod& method : options.methods) {
    json["methods"][method.name] = method_counts(trials, method.name);
  }
  for (const Trial& trial : trials) {
    const std::string& family = trial.hard->family;
    if (!json["families"].contains(family)) {
      json["families"][family] = {{"why", trial.hard->why}, {"counts", counts(trials, family)}};
    }
    json["rows"].push_back(row(trial));
  }
  json["provenance"] = provenance(1);
  return json;
}

std::string hard_text(const Json& result) {
  std::string text = fmt::format("  {:28} {:>9} {:>8} {:>13} {:>6}\n", "family", "certified", "refused",
                                 "not converged", "wrong");
  const auto line = [&](const std::string& name, const Json& counts) {
    text += fmt::format("  {:28} {:>9} {:>8} {:>13} {:>6}\n", name, counts["certified"].get<int>(),
                        counts["refused"].get<int>(), counts["not_converged"].get<int>(),
                        counts["wrong"].get<int>());
  };
  for (const auto& [name, family] : result["families"].items()) line(name, family["counts"]);
  line("all", result["counts"]);
  if (result.contains("methods")) text += methods_text(result["methods"]);
  for (const Json& row : result["rows"]) {
    if (row["verdict"] != "wrong" && row["verdict"] != "not_converged") continue;
    text += fmt::format("\n{}: {} {}\n  {}\n  again: slipstick solve {}", row["verdict"].get<std::string>(),
                        row["family"].get<std::string>(), row["case"].get<std::string>(),
                        row.value("reason", ""), row["scene"].get<std::string>());
    for (const Json& assignment : row["set"])
      text += fmt::format(" --set '{}'", assignment.get<std::string>());
    text += "\n";
  }
  return text;
}

}  // namespace slipstick::convergence
