#pragma once

#include <gmock/gmock.h>

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

/// Whether a message has all these parts.
template <typename... Parts>
auto says(const Parts&... parts) {
  return testing::AllOf(testing::HasSubstr(parts)...);
}

}  // namespace slipstick::solver
