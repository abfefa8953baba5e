#pragma once

#include <string>

#include "solver/input/input_error.hpp"

namespace slipstick::solver {

/// The message of the InputError that a call throws; empty where it throws none.
template <typename Call>
std::string complaint(const Call& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace slipstick::solver
