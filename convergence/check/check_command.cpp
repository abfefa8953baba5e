#include "convergence/commands.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "convergence/check/check.hpp"
#include "convergence/check/loop_request.hpp"
#include "convergence/check/mesh_request.hpp"
#include "convergence/check/stress_request.hpp"
#include "convergence/programs/output_options.hpp"
#include "convergence/programs/package_module.hpp"
#include "convergence/results/markup.hpp"
#include "convergence/results/output.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/runs/run_options.hpp"
#include "convergence/runs/run_spec.hpp"
#include "solver/input/input_error.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {
namespace {

struct CheckRequest {
  std::string scene;
  std::string field;
  std::vector<std::string> overrides;
  CheckOptions check;
  MeshOptions mesh;
  std::string junit;
  std::string summary;
};

/// Runs the module of the Python package that judges the requested file.
int run_judge(const char* module, const Json& request, std::ostream& text, Json& result) {
  const ModuleAnswer answer = run_package_module(module, request);
  result = answer.result;
  result["provenance"] = provenance(1);
  text << answer.text;
  return answer.exit_code;
}

int judge_file(const CLI::App& command, const CheckRequest& request, std::ostream& text, Json& result) {
  if (request.check.twist && !std::isfinite(*request.check.twist)) {
    throw solver::InputError(fmt::format("--twist {}", *request.check.twist), "allowed: a finite number, in rad");
  }
  if (const auto& tolerance = request.check.tolerance; tolerance && !(*tolerance > 0.0)) {
    throw solver::InputError("check", "--tolerance", fmt::format("{}", *tolerance), "larger than zero");
  }
  const solver::Scene scene = solver::read_scene(request.scene, request.overrides);
  require_inputs_kept(command, input_files(scene));
  if (request.check.columns.empty() && is_loop_file(request.field)) {
    if (request.check.twist || request.check.discrete || request.check.pressure_given) {
      throw solver::InputError(request.field,
                               "is a loop; --twist, --discrete and --pressure-given are for a field of "
                               "tractions; allowed: without them");
    }
    return run_judge("loops", loop_request(scene, request.field, request.check), text, result);
  }
  if (is_stress_file(request.field, request.check.columns)) {
    MeshOptions others = request.mesh;
    others.read_as.clear();
    if (request.check.twist || request.check.discrete || request.check.pressure_given || others.any()) {
      throw solver::InputError(request.field,
                               "has stresses below the surface; allowed: --tolerance, --strict, --columns "
                               "and --read-as body=lower or body=upper");
    }
    return run_judge("subsurface", stress_request(scene, request.field, request.check, request.mesh.read_as), text,
                     result);
  }
  if (request.mesh.any() || (request.check.columns.empty() && is_mesh_file(request.field))) {
    if (request.check.discrete || request.check.pressure_given || !request.check.columns.empty()) {
      throw solver::InputError(request.field,
                               "is a field on a mesh; --discrete, --pressure-given and --columns are for a "
                               "field on a regular grid; allowed: without them");
    }
    return run_judge("meshes", mesh_request(scene, request.overrides, request.field, request.check, request.mesh), text,
                     result);
  }
  const FieldCheck check = check_field(scene, request.field, request.check);
  result = to_json(check);
  text << check_text(check);
  return check.good() ? 0 : 1;
}

/// The verdict with its reason, and below it the text as a block of code.
std::string check_markdown(const CheckRequest& request, const JunitCase& judged) {
  std::string text = fmt::format("### {}: {} for {}\n\n{}\n\n", judged.type, markdown_text(request.field),
                                 markdown_text(request.scene), markdown_text(judged.message));
  std::istringstream lines(as_utf8(plain_text(judged.shown + judged.details)));
  for (std::string line; std::getline(lines, line);) text += "    " + line + "\n";
  return text + "\n";
}

/// Judges the file, and writes the verdict, or why there is none, for CI servers.
int run_check(const CLI::App& command, const CheckRequest& request, std::ostream& text, Json& result) {
  require_output("--junit", request.junit);
  require_output("--summary", request.summary);
  JunitCase judged{.suite = request.scene, .classname = "check", .name = request.field};
  const auto write_reports = [&] {
    write_option_file("--junit", request.junit, junit_text("slipstick check", {judged}));
    append_option_file("--summary", request.summary, check_markdown(request, judged));
  };
  std::ostringstream shown;
  int exit_code = 0;
  try {
    exit_code = judge_file(command, request, shown, result);
  } catch (const std::exception& error) {
    judged.verdict = CaseVerdict::error;
    judged.type = "not judged";
    judged.message = error.what();
    write_reports();
    throw;
  }
  text << shown.str();
  judged.verdict = exit_code == 0 ? CaseVerdict::passed : CaseVerdict::failure;
  judged.type = result.at("verdict").get<std::string>();
  judged.message = result.at("why").get<std::string>();
  (exit_code == 0 ? judged.shown : judged.details) = shown.str();
  write_reports();
  return exit_code;
}

}  // namespace

RunCommand add_check_command(CLI::App& app) {
  const auto request = std::make_shared<CheckRequest>();
  CLI::App* const command =
      app.add_subcommand("check", "Judge a traction field, stresses or a loop that any program computed");
  command->add_option("scene", request->scene, "scene file (TOML) that the program solved")->required();
  command
      ->add_option("field", request->field,
                   "columns x1, x2 (m), pressure, q1, q2 (Pa), one row for each contact cell: text, .h5 or .vti; or a "
                   "field at any points or on a mesh: text, .vtu, .vtk, .frd, .xdmf, ...; or stresses at x1, x2, x3 "
                   "(depth, m): some of s11, s22, s33, s12, s13, s23 (Pa), text; or a loop: moment (N m), rotation "
                   "(rad), or force (N), displacement (m), and perhaps time, normal_load: text or .json")
      ->required();
  add_set_option(*command, request->overrides, "override a key of the scene, e.g. load.moment_ratio=0.5");
  command
      ->add_option("--columns", request->check.columns,
                   "names of all columns of a field without a header, in order, as x1,x2,pressure,q1,q2; of HDF5 the "
                   "paths of these five")
      ->delimiter(',')
      ->allow_extra_args(false);
  command->add_option("--twist", request->check.twist,
                      "rad, that the program reported; without it your twist is not judged");
  command->add_flag("--discrete", request->check.discrete,
                    "good only if it solves its own grid's problem, of constant cells, up to iteration error");
  command->add_option(
      "--tolerance", request->check.tolerance,
      "error of loads, twist and tractions that is allowed, instead of the one derived from the mesh; of a "
      "loop's moment, root mean square, and of stresses, over the largest von Mises stress, instead of 0.01");
  command->add_flag("--pressure-given", request->check.pressure_given,
                    "take the field's pressure as given: judge only its load, and the tractions under it");
  command->add_flag("--strict", request->check.strict,
                    "good only in the scene's own conventions: m, Pa, tractions on the lower body");
  command->add_option("--junit", request->junit, "write the verdict as JUnit's XML to this file");
  command->add_option("--summary", request->summary, "add the verdict in Markdown to this file");
  MeshOptions& mesh = request->mesh;
  command->add_option("--stick-slope", mesh.stick_slope,
                      "Pa/m, of a field on a mesh: shear stress over the slip at which its penalty lets it stick");
  command->add_option("--normal-stiffness", mesh.normal_stiffness,
                      "Pa/m, of a field on a mesh: pressure over the penetration of its penalty");
  command
      ->add_option("--held-at", mesh.held_at,
                   "m, of a field on a mesh: radius at which the bodies are held, perhaps with a factor of its "
                   "effect on the reported twist")
      ->delimiter(',')
      ->expected(1, 2)
      ->allow_extra_args(false);
  command
      ->add_option("--read-as", mesh.read_as,
                   "choices for the reader of a field on a mesh, each key=value: kind=nodes, units=mm,MPa, "
                   "body=upper, axis=z, pressure=CPRESS, ...")
      ->allow_extra_args(false);
  command->footer(
      "Example:\n  slipstick check convergence/scenes/paper.toml tractions.csv --twist 2.361e-3\nExit code "
      "0: good; 1: bad; 2: cannot be judged. docs/guides/verify-your-solver.md explains each number.");
  return running(command, request, run_check);
}

}  // namespace slipstick::convergence
