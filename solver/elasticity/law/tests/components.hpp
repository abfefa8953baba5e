#pragma once

#include <array>

#include "solver/elasticity/law/half_spaces.hpp"

namespace slipstick::solver {

inline constexpr std::array kComponents{Component::k11, Component::k12, Component::k22,
                                        Component::k13, Component::k23, Component::k33};

/// The relative error that cell_integrals() promises. influence_test.cpp holds it against adaptive
/// quadrature.
inline constexpr double kPromised = 1e-13;

}  // namespace slipstick::solver
