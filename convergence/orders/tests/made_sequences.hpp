#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "convergence/orders/order.hpp"

namespace slipstick::convergence {

using Meshes = std::vector<MeshSample>;

inline const std::vector<double> kHalves{1.0, 0.5, 0.25, 0.125, 0.0625};

inline Meshes made(const std::vector<double>& sizes, const std::function<double(double)>& value) {
  Meshes meshes;
  for (const double size : sizes) meshes.push_back({size, value(size)});
  return meshes;
}

inline Meshes made(const std::vector<double>& values) {
  Meshes meshes;
  for (std::size_t i = 0; i < values.size(); ++i) {
    meshes.push_back({std::pow(0.5, static_cast<double>(i)), values[i]});
  }
  return meshes;
}

/// limit + factor size^order.
inline Meshes power(double order, const std::vector<double>& sizes = kHalves, double factor = 0.3, double limit = 0.0) {
  return made(sizes, [&](double size) { return limit + factor * std::pow(size, order); });
}

/// Mean and spread over grids that each miss a value by a normal deviate times its scatter.
inline MeshSample drawn(double size, double value, double scatter, int grids, std::mt19937& random) {
  std::normal_distribution<double> normal(value, scatter);
  std::vector<double> values;
  double mean = 0.0;
  for (int i = 0; i < grids; ++i) mean += values.emplace_back(normal(random)) / grids;
  double squares = 0.0;
  for (const double one : values) squares += (one - mean) * (one - mean);
  return {size, mean, grids > 1 ? std::sqrt(squares / (grids - 1)) : 0.0, grids};
}

}  // namespace slipstick::convergence
