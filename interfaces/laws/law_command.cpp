#include "interfaces/laws/law_command.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>

#include "analytic/named_profile.hpp"
#include "convergence/oracle/law_contact.hpp"
#include "convergence/programs/output_options.hpp"
#include "convergence/programs/package_module.hpp"
#include "convergence/results/output.hpp"
#include "convergence/results/provenance.hpp"
#include "convergence/runs/run_options.hpp"
#include "convergence/runs/run_spec.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::laws {

using namespace convergence;

namespace {

struct LawRequest {
  std::string scene;
  std::vector<std::string> overrides;
  std::string profile = "hertz";
  std::string prefix = "slipstick";
  double error = 1e-6;          ///< relative, of the polynomials
  double table_error = 1e-4;    ///< over the limit, of the table
  double element_error = 1e-2;  ///< over the limit, of the elements on first loading
  std::optional<int> elements;  ///< a number of elements, instead of their error
  int limit_loads = 65;
  std::vector<std::string> files;
};

LawContact contact_of(const CLI::App& command, const LawRequest& request) {
  if (request.scene.empty()) {
    try {
      return {request.profile, analytic::find_profile(request.profile).profile, {}};
    } catch (const std::logic_error& error) {
      throw std::domain_error(fmt::format("--profile: {}", error.what()));
    }
  }
  const solver::Scene scene = solver::read_scene(request.scene, request.overrides);
  require_inputs_kept(command, input_files(scene));
  return law_contact(scene);
}

/// Arguments of slipstick.laws.Law, and the files.
Json arguments(const LawContact& contact, const LawRequest& request) {
  Json json{{"name", contact.name},
            {"profile", request.scene.empty() ? request.profile : contact.profile->name()},
            {"profile_name", contact.profile->name()},
            {"prefix", request.prefix},
            {"error", request.error},
            {"table_error", request.table_error},
            {"element_error", request.element_error},
            {"limit_loads", request.limit_loads},
            {"files", request.files}};
  if (request.elements) json["elements"] = *request.elements;
  if (contact.units) {
    json["units"] = {{"friction", contact.units->friction},
                     {"normal_load", contact.units->normal_load},
                     {"contact_radius", contact.units->contact_radius},
                     {"shear_modulus", contact.units->shear_modulus}};
    if (contact.units->sphere_radius) json["units"]["sphere_radius"] = *contact.units->sphere_radius;
  }
  return json;
}

int run_law(const CLI::App& command, const LawRequest& request, std::ostream& text, Json& result) {
  for (const std::string& file : request.files) require_output("--write", file);
  ModuleAnswer answer = run_package_module("laws", arguments(contact_of(command, request), request));
  result = std::move(answer.result);
  result["provenance"] = provenance(1);
  text << answer.text;
  for (std::size_t i = 0; i < request.files.size(); ++i) {
    write_option_file("--write", request.files[i], answer.rest["files"][i].get<std::string>());
  }
  return answer.exit_code;
}

void add_accuracy_options(CLI::App& command, LawRequest& request) {
  command
      .add_option("--error", request.error,
                  "relative, of moment, rotation and energy lost in .h, .py and JSON; 1e-11 to 0.01")
      ->capture_default_str();
  command.add_option("--table-error", request.table_error, "over the limit, of the table; 1e-7 to 0.5")
      ->capture_default_str();
  CLI::Option* const error =
      command.add_option("--element-error", request.element_error,
                         "over the limit, of the elements in parallel on first loading; 1e-5 to 0.5");
  error->capture_default_str();
  command.add_option("--elements", request.elements, "number of elements, 1 to 200, whose error is the least")
      ->excludes(error);
  command
      .add_option("--limit-loads", request.limit_loads,
                  "points of the limit surface, from pure moment to pure force; at least 3")
      ->check(CLI::Range(3, 10000))
      ->capture_default_str();
}

}  // namespace

convergence::RunCommand add_law_command(CLI::App& app) {
  const auto request = std::make_shared<LawRequest>();
  CLI::App* const command = app.add_subcommand("law", "The contact law of torsion for other programs, with its error");
  CLI::Option* const scene = command->add_option(
      "scene", request->scene, "scene file (TOML) with an exact answer: the law in SI units, at its first load");
  add_set_option(*command, request->overrides, "override a key of the scene, e.g. load.normal=500");
  command->get_option("--set")->needs(scene);
  command->add_option("--profile", request->profile, "without a scene, dimensionless: " + analytic::profile_words())
      ->excludes(scene)
      ->capture_default_str();
  command
      ->add_option("--write", request->files,
                   "write the law to this file, as often as you like: .csv table; .h C; .py Python; .table "
                   "LAMMPS; .inp Abaqus; .xml MuJoCo; .sdf Drake")
      ->take_all()
      ->allow_extra_args(false);
  command
      ->add_option("--prefix", request->prefix,
                   "begins the names in .h, .table and .inp, so that one program can take several laws; a name "
                   "in C")
      ->check(CLI::Validator(
          [](const std::string& word) {
            return std::regex_match(word, std::regex("[A-Za-z_][A-Za-z0-9_]*")) ? "" : "allowed: a name in C";
          },
          "NAME"))
      ->capture_default_str();
  add_accuracy_options(*command, *request);
  command->footer(
      "Examples: slipstick law convergence/scenes/paper.toml --write law.h --write law.inp --json law.json\n"
      "          slipstick law --profile cone --elements 8\n"
      "docs/guides/contact-law.md describes each form and its error.");
  return running(command, request, run_law);
}

}  // namespace slipstick::laws
