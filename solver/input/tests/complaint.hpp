#pragma once

#include <string>

#include "solver/input/input_error.hpp"

namespace slipstick::solver {

/// What a call complains of; nothing where it does not.
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
