#include "convergence/report/scene_page.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "convergence/check/check.hpp"
#include "convergence/hard/hard_run.hpp"
#include "convergence/hard/rounding_digits.hpp"
#include "convergence/orders/order.hpp"
#include "convergence/report/scene_cost.hpp"
#include "convergence/report/scene_numbers.hpp"
#include "convergence/report/validation.hpp"
#include "convergence/results/json_text.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/solve/uncertainty.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;
using solver::Index;
using solver::Scene;

/// Parts of the limit moment, towards 0 and towards 1.
const char* const kRatios[] = {"1e-9", "1e-6", "1e-3", "0.99", "0.999", "0.9999", "0.999999"};
const Index kCoarseCells[] = {8, 12, 16};
/// Randomly rounded solves, enough to distinguish ten digits from twelve.
constexpr int kRoundingSamples = 6;

/// The uncertainty of the answer by the uncertainty of the scene's numbers.
Json uncertainty(const PageScene& at, const Json& answer, const std::vector<UncertainInput>& inputs) {
  const RunSpec finest = at.on_finest();
  return to_json(uncertainty_of(from_json(answer), inputs, {finest.scene, finest.overrides}, {}));
}

/// Equivalent scenes, coarse meshes, tiny and near-limit loads; this program solves them.
std::vector<HardCase> hard_cases(const PageScene& at) {
  std::vector<HardCase> cases;
  const auto add = [&](const char* family, const char* why, const std::string& name, RunSpec run) {
    if (!at.own) run.overrides.emplace_back(kNoProgram);
    cases.push_back({.family = family, .why = why, .name = name, .run = std::move(run)});
  };
  add("as_it_is", "the scene itself, turned, mirrored, shifted, in other units", at.scene.name, at.on_coarsest());
  if (!at.meshes.given) {
    for (const Index cells : kCoarseCells) {
      add("coarse_meshes", "a few cells: the answer must state its uncertainty", std::to_string(cells), at.on(cells));
    }
  }
  const std::vector<solver::Step>& steps = at.scene.steps;
  const bool by_ratio = steps.size() == 1 && !solver::brings_translation(steps.front()) &&
                        solver::value_if<solver::MomentRatio>(steps.front().torsion).value_or(0.0) != 0.0;
  if (!by_ratio) return cases;
  for (const char* ratio : kRatios) {
    add("load_ramp", "tiny and near-limit moments", ratio,
        changed(at.on_coarsest(), {fmt::format("load.moment_ratio={}", ratio)}));
  }
  return cases;
}

/// The scene as the page answers it.
Scene on_finest_mesh(const PageScene& at) {
  const RunSpec finest = at.on_finest();
  return solver::read_scene(finest.scene, finest.overrides);
}

/// The scene in words, and the meshes that are omitted for a long history.
SceneDescription described(const PageScene& at) {
  SceneDescription found = describe(at.scene, on_finest_mesh(at), at.base.scene);
  if (at.shortened && !at.meshes.given) {
    found.summary.emplace_back("Left out", fmt::format("meshes of more than {} cells, of a history of more than {} "
                                                       "steps (a page without --quick has them)",
                                                       at.meshes.answer.back(), at.size.long_history));
  }
  return found;
}

/// A program may find only the pressure.
bool has_tractions(const Json& answer) {
  const auto program = answer.find("program");
  return program == answer.end() || program->value("fields", "") != "pressure";
}

/// The verdict of `check` on the field of a program.
Json check_program(const PageScene& at, const Json& answer, const fs::path& fields) {
  CheckOptions options;
  const double twist = number_at(answer, "program.own.twist_angle");
  if (std::isfinite(twist)) options.twist = twist;
  return to_json(check_field(on_finest_mesh(at), fields, options));
}

/// By its certificate; for another program by `check`, or by its pressure if it finds only that.
Finding judge_answer(const Page& page) {
  if (!page.answer.contains("program")) return judge_certificate(page.answer);
  return page.check ? judge_check(page.answer, *page.check) : judge_pressure(page.answer);
}

/// The headline of the page that is in the folder; null without one.
Json earlier_headline(const fs::path& file) {
  const Json report = find_json(file);
  return report.is_object() ? report.value("headline", Json{}) : Json{};
}

/// Hard variants of the scene, by this program or by another one.
HardResult hard_variants(const PageScene& at, const Json& answer, const std::vector<BesideMethod>& programs,
                         const ProcessPool& pool) {
  HardOptions options{.variants = at.own, .finer_meshes = at.own && at.size.finer_meshes, .methods = programs};
  if (!at.own) {
    const std::string name = answer.at("program").value("name", "");
    options.methods = {{name, program_override(at.scene.solver.program), true}};
  }
  return run_hard_cases(hard_cases(at), options, pool);
}

}  // namespace

std::vector<Stage> page_stages(const PageRequest& request, const std::string& scene) {
  // Seconds of pages of the ellipse and of the paper's scene on two processors.
  std::vector<Stage> stages{{"answer", 0.5, scene},
                            {"study", 3.0, scene},
                            {"costs", 5.0, scene},
                            {"hard variants", 2.0, scene},
                            {"rounding", 0.5, scene}};
  if (request.validation) std::ranges::move(validation_stages(*request.validation), std::back_inserter(stages));
  return stages;
}

Page scene_page(const PageRequest& request, const fs::path& folder, const ProcessPool& pool) {
  const PageScene at = page_scene(request.base, request.size);
  if (!at.own && !request.uncertain.empty())
    throw solver::InputError("--uncertain", "cannot be combined with solver.program; allowed: without it");
  const std::vector<UncertainInput> uncertain = uncertain_inputs({at.base.scene, at.base.overrides}, request.uncertain);
  solver::make_folder(folder);
  const fs::path fields = folder / ("answer" + solver::fields_ending());
  pool.progress().begin("answer");
  const std::vector<Json> results = solve_answer(at, fields, pool);
  Page page{.provenance = provenance(std::max(1, at.scene.solver.threads)),
            .scene = described(at),
            .answer = results.back(),
            .fields = fields.filename().string()};
  if (!at.own && has_tractions(page.answer)) page.check = check_program(at, page.answer, fields);
  std::vector<Finding> findings{judge_answer(page)};
  Json counts = Json::object();
  pool.progress().begin("study");
  const std::vector<StudyResult> studies = scene_studies(at, pool);
  for (const StudyResult& study : studies) page.studies.push_back(to_json(study));
  page.numbers = number_rows(at.scene, results, studies.front());
  const Reference reference = reference_of(page.answer, page.numbers);
  for (const WantedError& each : request.wanted) findings.push_back(judge_wanted(each, page.numbers));
  if (std::ranges::find(request.wanted, reference.number, &WantedError::quantity) == request.wanted.end())
    findings.push_back(judge_accuracy(page.numbers, reference.number));
  if (!uncertain.empty()) page.uncertainty = uncertainty(at, page.answer, uncertain);
  findings.push_back(judge_order(studies.front(), reference.number, words_of(reference.number)));
  pool.progress().begin("costs");
  if (!at.meshes.given) page.costs = costs_of(at, {request.beside, page.numbers, reference}, pool);
  if (at.own || has_tractions(page.answer)) {
    pool.progress().begin("hard variants");
    const HardResult hard = hard_variants(at, page.answer, request.beside, pool);
    findings.push_back(at.own ? judge_hard(hard, "Hard variants") : judge_hard_beside(hard));
    counts.emplace("hard", counts_json(hard));
    page.hard = to_json(hard);
  }
  if (at.own) {
    pool.progress().begin("rounding");
    page.digits = to_json(rounding_digits(at.on_coarsest(), {.samples = kRoundingSamples}, pool));
  }
  if (request.validation) {
    const PaperValidation paper = validate(*request.validation, folder, pool);
    std::ranges::move(judge_validation(paper), std::back_inserter(findings));
    counts.update(counts_json(paper));
    page.paper = to_json(paper);
  }
  const fs::path file = folder / "report.json";
  page.headline = with_changes(headline_of(std::move(findings), std::move(counts), page), earlier_headline(file));
  write_json_file(file, to_json(page));
  return page;
}

}  // namespace slipstick::convergence
