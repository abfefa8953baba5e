#pragma once

#include <array>
#include <cstdio>
#include <functional>
#include <vector>

#include "solver/stresses/subsurface_stresses.hpp"

namespace slipstick::convergence {

/// Names of the components, and of von Mises' stress, in files of stresses.
inline constexpr std::array kStressNames{"s11", "s22", "s33", "s12", "s13", "s23", "von_mises"};

/// Writes all planes into one file as VTK's rectilinear grid (.vtr, for ParaView), whose points are the centres of the
/// cells at the depths: m and Pa, stresses in single precision. Memory holds one plane. depths: m, each once;
/// plane(depth) is called in their order. Throws InputError for a file that cannot be written at any place.
void write_stress_volume(std::FILE* stream, const std::string& file, const solver::Grid& grid,
                         const std::vector<double>& depths,
                         const std::function<solver::StressPlane(double depth)>& plane);

}  // namespace slipstick::convergence
