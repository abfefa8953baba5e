#include "convergence/exchange/allowed_programs.hpp"

#include <nlohmann/json.hpp>

#include "convergence/results/json_text.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

const std::string kKey = "solver.program=";

/// The text of a TOML value or of a bare word.
std::string unquoted(const std::string& value) {
  const Json read = Json::parse(value, nullptr, false);
  if (read.is_string()) return read;
  const bool quoted = value.size() > 1 && value.front() == '\'' && value.back() == '\'';
  return quoted ? value.substr(1, value.size() - 2) : value;
}

}  // namespace

std::string program_override(const std::filesystem::path& file) {
  return kKey + json_text(std::filesystem::absolute(file).string());
}

void require_allowed(const solver::Scene& scene, const AllowedPrograms& allowed) {
  if (scene.solver.program.empty() || allowed.all) return;
  for (const std::string& assignment : allowed.overrides) {
    if (assignment.starts_with(kKey) &&
        scene.solver.program == scene.source.parent_path() / unquoted(assignment.substr(kKey.size())))
      return;
  }
  throw solver::InputError(
      scene.source.string(), "solver.program", scene.solver.program.string(),
      "one that the command line names, by --program or by --set solver.program=FILE; others run with "
      "--allow-programs only, since a program may do whatever you may do");
}

}  // namespace slipstick::convergence
