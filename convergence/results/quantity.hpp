#pragma once

#include <string>
#include <vector>

#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {

/// One value of a result.
struct FoundQuantity {
  const Json* value = nullptr;      ///< null pointer: there is none of this name
  std::vector<const Json*> within;  ///< what it stands in, the whole result first
  std::string reason;               ///< why the value, or what it should stand in, is null in the result
};

/// Follows a path into a result: keys joined by dots, places in lists (counted from 0) in brackets, as in
/// steps[3].traction_error.l2. Keys may hold dots themselves, as names of series do. The result must outlive
/// what is returned.
FoundQuantity find_quantity(const Json& result, const std::string& path);

/// The number at a path; NaN where there is none.
double number_at(const Json& result, const std::string& path);

/// The size of a number of a result, or the length of a pair; NaN where there is none.
double size_at(const Json& result, const std::string& path);

/// Seconds of a whole solve, of a history all its steps; NaN where there are none.
double seconds_of(const Json& result);

/// Paths of all numbers, words and nulls of a result.
std::vector<std::string> quantity_paths(const Json& result);

}  // namespace slipstick::convergence
