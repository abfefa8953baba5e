#pragma once

#include <string>
#include <vector>

#include "convergence/solve/uncertainty.hpp"

/// What first derivatives do not tell of uncertain inputs: which of them the contact does not carry, and
/// quantiles.
namespace slipstick::convergence {

/// Less of an output, relative, is rounding: the inputs do not change it.
constexpr double kVaries = 1e-9;

bool converged(const Json& result);

/// Null where the derivatives do: where each input alone, one standard uncertainty off, moves each output as
/// they say, within a tenth of its standard uncertainty, and three off there is an answer. Else draws all
/// inputs from normal distributions, adds "quantiles" of the draws with an answer to the outputs, and
/// returns how many were drawn, and the parts that slide or have none for another reason. Draws are solved
/// exactly where the result knows the exact answer, else on a grid of at most 64 cells a side, to which its
/// own answer is the scale. The same inputs give the same draws.
Json draw_inputs(const Json& result, const std::vector<UncertainInput>& inputs, const SolveWith& solve,
                 Json& outputs);

/// The line of the draws for a person.
std::string draws_text(const Json& draws);

}  // namespace slipstick::convergence
