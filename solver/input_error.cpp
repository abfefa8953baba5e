#include "solver/input_error.hpp"

#include <fmt/core.h>

namespace slipstick::solver {

InputError::InputError(const std::string& file, const std::string& key, const std::string& value,
                       const std::string& allowed)
    : std::invalid_argument(fmt::format("{}: {} = {}: allowed: {}", file, key, value, allowed)) {}

InputError::InputError(const std::string& file, const std::string& complaint)
    : std::invalid_argument(fmt::format("{}: {}", file, complaint)) {}

}  // namespace slipstick::solver
