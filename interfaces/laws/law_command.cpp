#include "interfaces/laws/law_command.hpp"

#include <fmt/core.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <regex>
#include <stdexcept>

#include "analytic/named_profile.hpp"
#include "convergence/laws/contact_law.hpp"
#include "convergence/programs/output_options.hpp"
#include "convergence/results/output.hpp"
#include "convergence/runs/run_options.hpp"
#include "convergence/runs/run_spec.hpp"
#include "interfaces/laws/law_files.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::laws {

using namespace convergence;

namespace {

struct LawRequest {
  std::string scene;
  std::vector<std::string> overrides;
  std::string profile = "hertz";
  std::string prefix = "slipstick";
  LawOptions options;
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

int run_law(const CLI::App& command, const LawRequest& request, std::ostream& text, Json& result) {
  for (const std::string& file : request.files) require_output("--write", file);
  LawContact contact = contact_of(command, request);
  contact.prefix = request.prefix;
  const ContactLaw law = make_contact_law(contact, request.options);
  std::vector<std::string> texts;
  for (const std::string& file : request.files) texts.push_back(law_file(law, file));
  result = law_json(law);
  text << law_text(law);
  for (std::size_t i = 0; i < texts.size(); ++i) write_option_file("--write", request.files[i], texts[i]);
  return 0;
}

void add_accuracy_options(CLI::App& command, LawOptions& options) {
  command
      .add_option("--error", options.error,
                  "relative, of moment, rotation and energy lost in .h, .py and JSON; 1e-11 to 0.01")
      ->capture_default_str();
  command.add_option("--table-error", options.table_error, "over the limit, of the table; 1e-7 to 0.5")
      ->capture_default_str();
  CLI::Option* const error =
      command.add_option("--element-error", options.element_error,
                         "over the limit, of the elements in parallel on first loading; 1e-5 to 0.5");
  error->capture_default_str();
  command
      .add_option("--elements", options.elements, "number of elements, 1 to 200, whose error is the least")
      ->excludes(error);
  command
      .add_option("--limit-loads", options.limit_loads,
                  "points of the limit surface, from pure moment to pure force; at least 3")
      ->check(CLI::Range(3, 10000))
      ->capture_default_str();
}

}  // namespace

convergence::RunCommand add_law_command(CLI::App& app) {
  const auto request = std::make_shared<LawRequest>();
  CLI::App* const command =
      app.add_subcommand("law", "The contact law of torsion for other programs, with its error");
  CLI::Option* const scene =
      command->add_option("scene", request->scene,
                          "scene file (TOML) with an exact answer: the law in SI units, at its first load");
  add_set_option(*command, request->overrides, "override a key of the scene, e.g. load.normal=500");
  command->get_option("--set")->needs(scene);
  command
      ->add_option("--profile", request->profile,
                   "without a scene, dimensionless: " + analytic::profile_words())
      ->excludes(scene)
      ->capture_default_str();
  command
      ->add_option("--write", request->files,
                   "write the law to this file, as often as you like: .csv table; .h C; .py Python; .table "
                   "LAMMPS; .inp Abaqus; .xml MuJoCo; .sdf Drake")
      ->take_all()
      ->allow_extra_args(false);
  command
      ->add_option(
          "--prefix", request->prefix,
          "begins the names in .h, .table and .inp, so that one program can take several laws; a name "
          "in C")
      ->check(CLI::Validator(
          [](const std::string& word) {
            return std::regex_match(word, std::regex("[A-Za-z_][A-Za-z0-9_]*")) ? "" : "allowed: a name in C";
          },
          "NAME"))
      ->capture_default_str();
  add_accuracy_options(*command, request->options);
  command->footer(
      "Examples: slipstick law convergence/scenes/paper.toml --write law.h --write law.inp --json law.json\n"
      "          slipstick law --profile cone --elements 8\n"
      "docs/guides/contact-law.md describes each form and its error.");
  return running(command, request, run_law);
}

}  // namespace slipstick::laws
