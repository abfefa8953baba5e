#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {

/// The interpreter that runs Python: SLIPSTICK_PYTHON of the environment, else the one with NumPy that was
/// found when the program was built, else python3.
std::string python_interpreter();

/// The answer of a module of the Python package.
struct ModuleAnswer {
  int exit_code = 0;
  std::string text;  ///< for the reader
  Json result;       ///< for --json
  Json rest;         ///< further values, for example the texts of files to write
};

/// Runs `slipstick.<module>.answer(request)` of the Python package with python_interpreter() and waits. The
/// package is the one that contains this program, or the one installed or built with it. Throws
/// std::invalid_argument with the message of an InputError of the module, and std::runtime_error if Python,
/// the package or a package that it imports is missing, or if the module fails.
ModuleAnswer run_package_module(const std::string& module, const Json& request);

}  // namespace slipstick::convergence
