#include "solver/input/setting_key.hpp"

#include <fmt/core.h>

namespace slipstick::solver {

Range whole(double low, double high) {
  return {fmt::format("a whole number from {:g} to {:g}", low, high),
          [low, high](double x) { return x >= low && x <= high && x == std::floor(x); }};
}

std::string without_indices(const std::string& key) {
  std::string name;
  bool index = false;
  for (const char c : key) {
    index = (index || c == '[') && c != ']';
    if (!index && c != ']') name += c;
  }
  return name;
}

}  // namespace slipstick::solver
