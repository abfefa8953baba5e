#include "convergence/exchange/allowed_programs.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "convergence/results/json_text.hpp"
#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

constexpr const char* kKey = "solver.program=";

}  // namespace

std::string program_override(const std::filesystem::path& file) {
  return kKey + json_text(std::filesystem::absolute(file).string());
}

void require_allowed(const solver::Scene& scene, const std::vector<std::string>& overrides,
                     const AllowedPrograms& allowed) {
  if (scene.program.empty() || allowed.all) return;
  const auto last = std::find_if(overrides.rbegin(), overrides.rend(),
                                 [](const std::string& assignment) { return assignment.starts_with(kKey); });
  if (last != overrides.rend() && std::ranges::find(allowed.overrides, *last) != allowed.overrides.end())
    return;
  throw solver::InputError(
      scene.source.string(), "solver.program", scene.program.string(),
      "a program that a file names runs only with --allow-programs; it may do whatever you may do");
}

}  // namespace slipstick::convergence
