#include "convergence/report/scene_page.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>

#include "convergence/check/check.hpp"
#include "convergence/orders/order.hpp"
#include "convergence/report/page.hpp"
#include "convergence/report/scene_cost.hpp"
#include "convergence/report/scene_numbers.hpp"
#include "convergence/report/scene_verdict.hpp"
#include "convergence/results/json_text.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/result_cache.hpp"
#include "convergence/runs/run_spec.hpp"
#include "convergence/runs/solve_scene.hpp"
#include "convergence/solve/uncertainty.hpp"
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

/// The override for the coarsest mesh of the answer; none where the files of the scene give the grid.
std::vector<std::string> coarse_mesh(const Scene& scene, const Meshes& meshes) {
  if (meshes.given) return {};
  return {cells_override(scene, meshes.answer.front())};
}

/// The uncertainty of the answer by the uncertainty of the scene's numbers.
Json uncertainty(const RunSpec& base, const Scene& scene, const Meshes& meshes, const Json& answer,
                 const std::vector<UncertainInput>& inputs) {
  SceneFile file{base.scene, base.overrides};
  if (!meshes.given) file.overrides.push_back(cells_override(scene, meshes.answer.back()));
  return to_json(uncertainty_of(from_json(answer), inputs, file, {}));
}

/// Equivalent scenes, coarse meshes, tiny and near-limit loads.
std::vector<HardCase> hard_cases(const RunSpec& base, const Scene& scene, const Meshes& meshes) {
  std::vector<HardCase> cases;
  const auto add = [&](const char* family, const char* why, const std::string& name,
                       const std::vector<std::string>& overrides) {
    cases.push_back({.family = family, .why = why, .name = name, .run = changed(base, overrides)});
  };
  const std::vector<std::string> mesh = coarse_mesh(scene, meshes);
  add("as_it_is", "the scene itself, turned, mirrored, shifted, in other units", scene.name, mesh);
  if (!meshes.given) {
    for (const Index cells : kCoarseCells) {
      add("coarse_meshes", "a few cells: the answer must state its uncertainty", std::to_string(cells),
          {cells_override(scene, cells)});
    }
  }
  const bool by_ratio =
      scene.steps.size() == 1 && !solver::brings_translation(scene.steps.front()) &&
      solver::value_if<solver::MomentRatio>(scene.steps.front().torsion).value_or(0.0) != 0.0;
  if (!by_ratio) return cases;
  for (const char* ratio : kRatios) {
    std::vector<std::string> overrides = mesh;
    overrides.push_back(fmt::format("load.moment_ratio={}", ratio));
    add("load_ramp", "tiny and near-limit moments", ratio, overrides);
  }
  return cases;
}

bool is_long(const Scene& scene, const PageSize& size) {
  return scene.steps.size() * static_cast<std::size_t>(scene.cycles) > size.long_history;
}

/// Coarser meshes for a long history, whose time is proportional to its steps.
PageSize for_history(PageSize size, const Scene& scene) {
  if (!is_long(scene, size)) return size;
  size.most_cells /= 2;
  size.most_study_cells /= 2;
  size.method_cells /= 2;
  size.operator_cells.resize(size.operator_cells.size() / 2);
  return size;
}

/// The scene as the page answers it.
Scene on_finest_mesh(const RunSpec& base, const Scene& scene, const Meshes& meshes) {
  std::vector<std::string> overrides = base.overrides;
  if (!meshes.given) overrides.push_back(cells_override(scene, meshes.answer.back()));
  return solver::read_scene(base.scene, overrides);
}

/// The scene in words, and the meshes that are omitted for a long history.
SceneDescription described(const RunSpec& base, const Scene& scene, const Meshes& meshes,
                           const PageSize& size) {
  SceneDescription found = describe(scene, on_finest_mesh(base, scene, meshes), base.scene);
  if (is_long(scene, size) && !meshes.given) {
    found.summary.emplace_back("Left out",
                               fmt::format("meshes of more than {} cells, of a history of more than {} "
                                           "steps (a page without --quick has them)",
                                           meshes.answer.back(), size.long_history));
  }
  return found;
}

/// A program may find only the pressure.
bool has_tractions(const Json& answer) {
  const auto program = answer.find("program");
  return program == answer.end() || program->value("fields", "") != "pressure";
}

/// The verdict of `check` on the field of a program.
Json check_program(const RunSpec& base, const Scene& scene, const Meshes& meshes, const Json& answer,
                   const fs::path& fields) {
  CheckOptions options;
  const double twist = number_at(answer, "program.own.twist_angle");
  if (std::isfinite(twist)) options.twist = twist;
  return to_json(check_field(on_finest_mesh(base, scene, meshes), fields, options));
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

/// A scene of a page with all that its solves need.
struct PageScene {
  RunSpec base;
  Scene scene;
  PageSize size;
  Meshes meshes;
  bool own;  ///< this program solves it
};

PageScene page_scene(const PageRequest& request) {
  Scene scene = solver::read_scene(request.base.scene, request.base.overrides);
  const bool own = scene.solver.program.empty();
  const PageSize size = for_history(own ? request.size : for_program(request.size), scene);
  Meshes meshes = meshes_of(scene, size);
  return {request.base, std::move(scene), size, std::move(meshes), own};
}

/// Error against time, answers of other programs, direct sums against convolution. A scene whose files give
/// its grid has none of them.
void add_costs(Page& page, const PageScene& at, const Reference& reference,
               const std::vector<BesideMethod>& programs, const ProcessPool& pool) {
  const auto& [base, scene, size, meshes, own] = at;
  if (meshes.given) return;
  page.cost = error_against_time(base, scene, meshes.answer, reference, size, pool);
  if (!programs.empty()) {
    const Meshes coarse = meshes_of(scene, for_program(size));
    page.programs =
        answers_of_programs(base, scene, coarse.answer, {programs, page.numbers, reference.number}, pool);
  }
  if (own) page.operators = direct_against_dcfft(base, scene, size, pool);
}

/// Hard variants of the scene, by this program or by another one.
HardResult hard_variants(const PageScene& at, const Json& answer, const std::vector<BesideMethod>& programs,
                         const ProcessPool& pool) {
  HardOptions options{.variants = at.own, .finer_meshes = at.own && at.size.finer_meshes};
  options.methods = programs;
  if (!at.own) {
    const std::string name = answer.at("program").value("name", "");
    options.methods = {{name, program_override(at.scene.solver.program), true}};
  }
  const RunSpec base = at.own ? at.base : changed(at.base, {kNoProgram});
  return run_hard_cases(hard_cases(base, at.scene, at.meshes), options, pool);
}

}  // namespace

PageSize for_program(PageSize size) {
  constexpr Index kSlower = 4;
  size.most_cells = std::max(size.most_cells / kSlower, 4 * kFewestCells);
  size.most_study_cells = size.most_cells;
  size.shifts = 1;
  return size;
}

PageSize quick_page() {
  return {.most_cells = 64,
          .most_study_cells = 64,
          .shifts = 1,
          .method_cells = 32,
          .operator_cells = {8, 12, 16, 24},
          .repetitions = 2,
          .finer_meshes = false,
          .long_history = 40};
}

PageSize usual_page() {
  return {.most_cells = 256,
          .most_study_cells = 256,
          .shifts = 4,
          .method_cells = 64,
          .operator_cells = {8, 12, 16, 24, 32, 48},
          .repetitions = 3,
          .finer_meshes = true,
          .long_history = std::numeric_limits<std::size_t>::max()};
}

PageSize full_page() {
  PageSize size = usual_page();
  size.most_cells = 1024;
  size.most_study_cells = 1024;
  size.method_cells = 128;
  return size;
}

WantedError read_wanted_error(const std::string& word) {
  const std::size_t at = std::min(word.find('='), word.size());
  const std::string number = word.substr(std::min(at + 1, word.size()));
  double error = kNaN;
  const auto [end, problem] = std::from_chars(number.data(), number.data() + number.size(), error);
  if (problem != std::errc() || end != number.data() + number.size() || !(error > 0.0 && error < 1.0)) {
    throw solver::InputError("--want", word, "no error",
                             "QUANTITY=ERROR with a relative error between 0 and 1, as twist=1e-3");
  }
  const std::string quantity = word.substr(0, at);
  return {quantity == "twist" ? "twist_angle" : quantity, error};
}

Page scene_page(const PageRequest& request, const fs::path& folder, const ProcessPool& pool) {
  const PageScene at = page_scene(request);
  const auto& [base, scene, size, meshes, own] = at;
  if (!own && !request.uncertain.empty())
    throw solver::InputError("--uncertain", "cannot be combined with solver.program; allowed: without it");
  const std::vector<UncertainInput> uncertain =
      uncertain_inputs({base.scene, base.overrides}, request.uncertain);
  solver::make_folder(folder);
  const fs::path fields = folder / "answer.h5";
  const std::vector<Json> results = solve_answer(base, scene, meshes, fields, pool);
  Page page{.provenance = provenance(std::max(1, scene.solver.threads)),
            .scene = described(base, scene, meshes, size),
            .answer = results.back()};
  if (!own && has_tractions(page.answer))
    page.check = check_program(base, scene, meshes, page.answer, fields);
  std::vector<Finding> findings{judge_answer(page)};
  page.studies = scene_studies(base, scene, meshes, size, pool);
  page.numbers = number_rows(scene, results, page.studies.front());
  const Reference reference = reference_of(page.answer, page.numbers);
  for (const WantedError& each : request.wanted) findings.push_back(judge_wanted(each, page.numbers));
  if (std::ranges::find(request.wanted, reference.number, &WantedError::quantity) == request.wanted.end())
    findings.push_back(judge_accuracy(page.numbers, reference.number));
  if (!uncertain.empty()) page.uncertainty = uncertainty(base, scene, meshes, page.answer, uncertain);
  findings.push_back(judge_order(page.studies.front(), reference.number, words_of(reference.number)));
  add_costs(page, at, reference, request.beside, pool);
  if (own || has_tractions(page.answer)) {
    page.hard = hard_variants(at, page.answer, request.beside, pool);
    findings.push_back(own ? judge_hard(*page.hard, "Hard variants") : judge_hard_beside(*page.hard));
  }
  if (own) {
    page.digits =
        rounding_digits(changed(base, coarse_mesh(scene, meshes)), {.samples = kRoundingSamples}, pool);
  }
  if (request.validation) {
    page.paper = validate(*request.validation, folder, pool);
    std::ranges::move(judge_validation(*page.paper), std::back_inserter(findings));
  }
  const fs::path file = folder / "report.json";
  page.headline = with_changes(headline_of(std::move(findings), page), earlier_headline(file));
  write_json_file(file, to_json(page));
  return page;
}

std::vector<JunitCase> page_cases(const Page& page) {
  std::vector<JunitCase> cases;
  for (const auto& [what, line, shown] : page.headline.findings) {
    const bool holds = shown == Shown::holds;
    cases.push_back({.suite = page.scene.name,
                     .classname = "report",
                     .name = what,
                     .verdict = holds                   ? CaseVerdict::passed
                                : shown == Shown::fails ? CaseVerdict::failure
                                                        : CaseVerdict::skipped,
                     .type = "page",
                     .message = holds ? "" : line,
                     .shown = line});
  }
  return cases;
}

}  // namespace slipstick::convergence
