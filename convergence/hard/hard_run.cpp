#include "convergence/hard/hard_run.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "convergence/results/provenance.hpp"
#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {
namespace {

using enum HardVerdict;

/// Names of stages.
constexpr const char* kScenes = "scenes";
constexpr const char* kEquivalent = "equivalent scenes";
constexpr const char* kFiner = "finer meshes";

/// The grid of a record as overrides, with `finer` times as many cells along each axis.
std::vector<std::string> grid_of(const SolveRecord& record, int finer = 1) {
  const auto& [n1, n2] = record.problem.cells;
  const auto& [h1, h2] = record.problem.cell_size;
  return {fmt::format("grid.extent=[{:.17g},{:.17g}]", h1 * static_cast<double>(n1), h2 * static_cast<double>(n2)),
          fmt::format("grid.cells=[{},{}]", finer * n1, finer * n2)};
}

/// Whether a row has a scene from which other ones can be made.
bool is_certified(const HardRow& row) { return row.judged.verdict == certified && row.scene; }

/// The worse of two verdicts stands, with its reason.
void judge_too(JudgedCase& judged, HardVerdict verdict, std::string reason) {
  if (judged.verdict >= verdict) return;
  judged.verdict = verdict;
  judged.reason = std::move(reason);
}

// ---------------------------------------------------------------- the scenes themselves

std::vector<HardRow> solve_cases(const std::vector<HardCase>& cases, const std::filesystem::path& fields,
                                 const ProcessPool& pool) {
  std::vector<HardRow> rows(cases.size());
  std::vector<RunSpec> runs;
  for (std::size_t i = 0; i < cases.size(); ++i) {
    rows[i].hard = cases[i];
    if (!fields.empty()) rows[i].fields = fields / fmt::format("{:05}.csv", i);
    RunSpec& run = runs.emplace_back(cases[i].run);
    run.fields = rows[i].fields;
    run.step_before = !fields.empty();
  }
  std::vector<SolveRecord> records = pool.run_or_refuse(runs);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    HardRow& row = rows[i];
    row.record = std::move(records[i]);
    row.judged = judge_alone(row.record);
    if (row.judged.verdict == certified) row.scene = solver::read_scene(row.hard.run.scene, row.hard.run.overrides);
  }
  return rows;
}

// ---------------------------------------------------------------- equivalent scenes

RunSpec transformed_run(const HardRow& row, Variant variant) {
  RunSpec run = row.hard.run;
  run.fields.clear();
  run.variant = variant;
  return has_given_grid(*row.scene) ? run : changed(std::move(run), grid_of(row.record));
}

void judge_variant(HardRow& row, Variant variant, Number& difference, const SolveRecord& seen) {
  const std::string name = to_string(variant);
  const std::string status = to_string(seen.status);
  difference = {.why_missing = status};
  if (!seen.is_converged()) {
    const HardVerdict verdict = seen.status == RunStatus::not_converged ? not_converged : wrong;
    return judge_too(row.judged, verdict, fmt::format("{} it is {}: {}", name, status, seen.message));
  }
  difference = number_or(variant_difference(row.record, seen, variant), status);
  if (!(difference <= same_answer(row.record))) {
    judge_too(row.judged, wrong, fmt::format("{} it differs by {:.3g}", name, difference.value));
  }
}

void judge_variants(std::vector<HardRow>& rows, const ProcessPool& pool) {
  std::vector<std::pair<HardRow*, std::size_t>> solves;  // the row, and the place in its variants
  std::vector<RunSpec> runs;
  for (HardRow& row : rows) {
    if (!is_certified(row)) continue;
    for (const Variant variant : kVariants) {
      const std::string reason = why_not(*row.scene, variant);
      if (reason.empty()) {
        solves.emplace_back(&row, row.variants.size());
        runs.push_back(transformed_run(row, variant));
      }
      row.variants.push_back({to_string(variant), {.why_missing = reason}});
    }
  }
  const std::vector<SolveRecord> records = pool.run_or_refuse(runs);
  for (std::size_t i = 0; i < solves.size(); ++i) {
    const auto& [row, place] = solves[i];
    judge_variant(*row, runs[i].variant, row->variants[place].second, records[i]);
  }
}

// ---------------------------------------------------------------- finer meshes

/// Whether the error of an answer can be known from finer meshes only.
bool needs_finer_meshes(const HardRow& row) {
  return is_certified(row) && std::isnan(*row.judged.numbers->error) && !std::isnan(*row.judged.numbers->uncertainty) &&
         !has_given_grid(*row.scene) && std::isfinite(main_value(row.record));
}

/// Whether a finer mesh may refuse the load that this one carries, since the mesh decides near the limit.
bool is_at_limit(const SolveRecord& record) {
  constexpr double kMeshOfLimit = 1e-3;  // relative difference of the limit between meshes
  return record.end.loads.limit.factor < 1.0 + kMeshOfLimit;
}

/// twice, four_times: records on as many times the cells.
void judge_by_finer_records(HardRow& row, const SolveRecord& twice, const SolveRecord& four_times) {
  const auto value_of = [](const SolveRecord& record) {
    return record.is_converged() ? main_value(record) : std::nan("");
  };
  const bool any_refused = twice.status == RunStatus::refused || four_times.status == RunStatus::refused;
  const bool is_refused = any_refused && is_at_limit(row.record);
  const MeshReference reference =
      judge_by_finer(main_value(row.record), row.record.end.resolution.absolute, value_of(twice), value_of(four_times));
  const char* const none =
      is_refused ? "a finer mesh carries a little less than this load" : "a finer mesh has no answer";
  JudgedNumbers& numbers = *row.judged.numbers;
  numbers.finer_error = number_or(reference.error, none);
  numbers.finer_change = number_or(reference.change, none);
  if (reference.holds || is_refused) return;
  judge_too(row.judged, wrong,
            fmt::format("it is {:.3g} from the answer on a finer mesh, and says {:.3g}", reference.error,
                        numbers.uncertainty->value));
}

/// Compares answers without an exact one with those on twice and four times the cells.
void judge_by_finer_meshes(std::vector<HardRow>& rows, const ProcessPool& pool) {
  std::vector<HardRow*> judged;
  std::vector<RunSpec> runs;
  for (HardRow& row : rows) {
    if (!needs_finer_meshes(row)) continue;
    judged.push_back(&row);
    for (const int finer : {2, 4}) {
      RunSpec& run = runs.emplace_back(changed(row.hard.run, grid_of(row.record, finer)));
      run.overrides.push_back(fmt::format("solver.substeps={}", finer * row.scene->solver.substeps));
    }
  }
  const std::vector<SolveRecord> records = pool.run_or_refuse(runs);
  for (std::size_t i = 0; i < judged.size(); ++i) {
    judge_by_finer_records(*judged[i], records[2 * i], records[2 * i + 1]);
  }
}

// ---------------------------------------------------------------- other methods

/// A program that fails with a message has not converged.
ComparedAnswer compare(const HardRow& row, const BesideMethod& method, const SolveRecord& record) {
  if (method.is_program && record.status == RunStatus::failed) {
    return {MethodVerdict::not_converged, record.message, {}};
  }
  return compare_answer(row.record, record);
}

void compare_methods(std::vector<HardRow>& rows, const std::vector<BesideMethod>& methods, const ProcessPool& pool) {
  for (const BesideMethod& method : methods) {
    std::vector<RunSpec> runs;
    pool.progress().begin(method.name);
    for (const HardRow& row : rows) runs.push_back(changed(row.hard.run, {method.override}));
    const std::vector<SolveRecord> records = pool.run_or_refuse(runs);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      rows[i].methods.push_back({method.name, compare(rows[i], method, records[i])});
    }
  }
}

// ---------------------------------------------------------------- JSON and text

void set_known(Json& json, const char* key, const std::optional<Number>& number) {
  if (number) set_number(json, key, *number);
}

template <typename Judged>
void add_verdict(Json& json, const Judged& judged) {
  json.push_back({"verdict", to_string(judged.verdict)});
  if (!judged.reason.empty()) json.push_back({"reason", judged.reason});
  if (!judged.numbers) return;
  const JudgedNumbers& numbers = *judged.numbers;
  set_numbers(json, {{"operator_applications", numbers.operator_applications},
                     {"pressure_applications", numbers.pressure_applications},
                     {"seconds.total", numbers.seconds},
                     {"slip_direction.mean", numbers.slip_direction}});
  if (numbers.safeguards) json.push_back({"safeguards", to_json(*numbers.safeguards)});
  set_known(json, "error", numbers.error);
  set_known(json, "uncertainty", numbers.uncertainty);
  set_known(json, "certificate.gap", numbers.gap);
  set_known(json, "finer_meshes.error", numbers.finer_error);
  set_known(json, "finer_meshes.change", numbers.finer_change);
  set_known(json, "difference", numbers.difference);
}

/// The files of fields, and the numbers that an audit of them needs.
Json written_json(const HardRow& row) {
  const SolveRecord& record = row.record;
  Json json{{"fields", row.fields.string()},
            {"cells", record.problem.cells},
            {"cell_size", record.problem.cell_size},
            {"normal_load", record.end.contact.normal_load.value},
            {"moment", record.end.loads.moment.value},
            {"moment_limit", record.end.loads.moment_limit.value},
            {"force", record.end.loads.force.values},
            {"tolerance", record.problem.tolerance},
            {"certificate.rounding", record.end.certificate.rounding.value}};
  if (record.history && record.history->steps.size() > 1) {
    json.push_back({"before", step_before_file(row.fields).string()});
  }
  return json;
}

}  // namespace

void to_json(Json& json, const HardRow& row) {
  json = {{"family", row.hard.family},
          {"case", row.hard.name},
          {"set", row.hard.run.overrides},
          {"scene", row.hard.run.scene.string()}};
  add_verdict(json, row.judged);
  if (!row.fields.empty() && row.record.is_converged()) json.push_back({"written", written_json(row)});
  Json variants = Json::object();
  for (const auto& [name, difference] : row.variants) set_number(variants, name, difference);
  if (!variants.empty()) json.push_back({"variants", variants});
  Json methods = Json::object();
  for (const auto& [name, compared] : row.methods) add_verdict(methods[name] = Json::object(), compared);
  if (!methods.empty()) json.push_back({"methods", methods});
}

namespace {

template <typename Verdict, std::size_t N>
Json by_verdict(const std::array<std::size_t, N>& counts) {
  Json json = Json::object();
  for (std::size_t i = 0; i < N; ++i) json[to_string(static_cast<Verdict>(i))] = counts[i];
  return json;
}

/// Names of the families in the order of the cases, with the reason why each is hard.
nlohmann::ordered_map<std::string, std::string> families_of(const HardResult& result) {
  nlohmann::ordered_map<std::string, std::string> families;
  for (const HardRow& row : result.rows) families.insert({row.hard.family, row.hard.why});
  return families;
}

std::string methods_text(const HardResult& result) {
  std::string text = fmt::format("\n  {:20} {:>8} {:>8} {:>13} {:>15} {:>12}\n", "other methods", "agrees", "refused",
                                 "not converged", "other direction", "other answer");
  for (std::size_t i = 0; i < result.methods.size(); ++i) {
    const auto [agree, refuse, open, direction, answer] = result.method_counts(i);
    text += fmt::format("  {:20} {:>8} {:>8} {:>13} {:>15} {:>12}\n", result.methods[i], agree, refuse, open, direction,
                        answer);
  }
  return text;
}

}  // namespace

std::array<std::size_t, 4> HardResult::counts(const std::string& family) const {
  std::array<std::size_t, 4> counts{};
  for (const HardRow& row : rows) {
    if (family.empty() || row.hard.family == family) ++counts[static_cast<std::size_t>(row.judged.verdict)];
  }
  return counts;
}

std::array<std::size_t, 5> HardResult::method_counts(std::size_t method) const {
  std::array<std::size_t, 5> counts{};
  for (const HardRow& row : rows) ++counts[static_cast<std::size_t>(row.methods[method].second.verdict)];
  return counts;
}

std::vector<Stage> hard_stages(const HardOptions& options) {
  // Seconds of the project's scenes on two busy processors.
  std::vector<Stage> stages{{kScenes, 85.0}};
  if (options.variants) stages.push_back({kEquivalent, 420.0});
  if (options.finer_meshes) stages.push_back({kFiner, 105.0});
  for (const BesideMethod& method : options.methods) stages.push_back({method.name, 85.0});
  return stages;
}

HardResult run_hard_cases(const std::vector<HardCase>& cases, const HardOptions& options, const ProcessPool& pool) {
  pool.progress().begin(kScenes);
  HardResult result{.rows = solve_cases(cases, options.fields, pool), .methods = {}};
  pool.progress().begin(kEquivalent);
  if (options.variants) judge_variants(result.rows, pool);
  pool.progress().begin(kFiner);
  if (options.finer_meshes) judge_by_finer_meshes(result.rows, pool);
  compare_methods(result.rows, options.methods, pool);
  for (const BesideMethod& method : options.methods) result.methods.push_back(method.name);
  return result;
}

Json counts_json(const HardResult& result) { return by_verdict<HardVerdict>(result.counts()); }

Json to_json(const HardResult& result) {
  Json families = Json::object();
  for (const auto& [name, why] : families_of(result)) {
    families[name] = {{"why", why}, {"counts", by_verdict<HardVerdict>(result.counts(name))}};
  }
  Json json{{"counts", counts_json(result)}, {"families", std::move(families)}, {"rows", result.rows}};
  Json methods = Json::object();
  for (std::size_t i = 0; i < result.methods.size(); ++i) {
    methods[result.methods[i]] = by_verdict<MethodVerdict>(result.method_counts(i));
  }
  if (!methods.empty()) json.push_back({"methods", std::move(methods)});
  json.push_back({"provenance", provenance(1)});
  return json;
}

std::string hard_text(const HardResult& result) {
  std::string text =
      fmt::format("  {:28} {:>9} {:>8} {:>13} {:>6}\n", "family", "certified", "refused", "not converged", "wrong");
  const auto line = [&](const std::string& name, const std::string& family) {
    const auto [certain, refuse, open, false_answers] = result.counts(family);
    text += fmt::format("  {:28} {:>9} {:>8} {:>13} {:>6}\n", name, certain, refuse, open, false_answers);
  };
  for (const auto& [name, why] : families_of(result)) line(name, name);
  line("all", "");
  if (!result.methods.empty()) text += methods_text(result);
  for (const HardRow& row : result.rows) {
    const JudgedCase& judged = row.judged;
    if (judged.verdict != wrong && judged.verdict != not_converged) continue;
    text += fmt::format("\n{}: {} {}\n  {}\n  again: slipstick solve {}", to_string(judged.verdict), row.hard.family,
                        row.hard.name, judged.reason, row.hard.run.scene.string());
    for (const std::string& assignment : row.hard.run.overrides) text += fmt::format(" --set '{}'", assignment);
    text += "\n";
  }
  return text;
}

}  // namespace slipstick::convergence
