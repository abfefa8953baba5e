#include "convergence/programs/package_module.hpp"

#include <fmt/core.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

#include "convergence/system/machine.hpp"
#include "convergence/system/run_program.hpp"

namespace slipstick::convergence {

namespace fs = std::filesystem;

namespace {

/// Folder from which Python imports the package `slipstick`: around the program in a wheel, in share/ of an
/// installation, in the program's folder in a build.
fs::path package_folder() {
  const fs::path folder = own_program_file().parent_path();
  for (const fs::path& candidate : {folder.parent_path().parent_path(),
                                    folder.parent_path() / "share" / "slipstick" / "python", folder / "python"}) {
    if (fs::exists(candidate / "slipstick" / "_native" / "libslipstick.so")) return candidate;
  }
  throw std::runtime_error(
      fmt::format("this command is part of the Python package, which is not installed with {}: build the "
                  "target slipstick_python, or install all of slipstick",
                  own_program_file().string()));
}

/// -E ignores PYTHONPATH and PYTHONHOME; the package's folder replaces the working folder.
constexpr const char* kRunModule = R"(import sys
sys.path[0] = sys.argv[1]
try:
  from slipstick._module import main
except ModuleNotFoundError as error:
  print('{"missing": "%s"}' % error.name)
else:
  main(sys.argv[2])
)";

}  // namespace

std::string python_interpreter() {
  const char* const chosen = std::getenv("SLIPSTICK_PYTHON");
  if (chosen != nullptr && *chosen != '\0') return chosen;
  const std::string found = SLIPSTICK_PYTHON;
  return found.empty() ? "python3" : found;
}

ModuleAnswer run_package_module(const std::string& module, const Json& request) {
  const std::string python = python_interpreter();
  Program program({python, "-E", "-B", "-c", kRunModule, package_folder(), module},
                  {.captured = Captured::output, .fed = true, .tied_by = own_program()});
  program.feed(request.dump(-1, ' ', true, Json::error_handler_t::replace));
  program.end_feed();
  while (!program.read_on()) {
  }
  const ProgramEnd end = program.wait();
  if (end.code != 0) {
    throw std::runtime_error(fmt::format("{} of the Python package failed ({} {})", module, python, end.trouble));
  }
  Json answer = Json::parse(end.output);
  if (answer.contains("error")) throw std::invalid_argument(answer["error"].get<std::string>());
  if (answer.contains("missing")) {
    const auto name = answer["missing"].get<std::string>();
    throw std::runtime_error(
        fmt::format("{0} cannot import {1}, which this command needs. On Debian or Ubuntu: "
                    "apt-get install python3-{1}; elsewhere: {0} -m pip install {1}",
                    python, name.substr(0, name.find('.'))));
  }
  ModuleAnswer result{answer.value("exit_code", 0), answer.value("text", ""), std::move(answer["result"]), {}};
  for (const char* taken : {"exit_code", "text", "result"}) answer.erase(taken);
  result.rest = std::move(answer);
  return result;
}

}  // namespace slipstick::convergence
