#pragma once

#include <filesystem>
#include <functional>

#include "convergence/results/result_parts.hpp"

namespace slipstick::convergence {

/// Throws InputError unless the ending is one that a figure can have, and its folder exists.
void require_figure_format(const std::filesystem::path& figure);

/// Draws slip and stick, tractions and pressure of a result; write_fields writes its cells to the file it is
/// given. Throws std::runtime_error if the figure cannot be drawn.
void draw_figure(const std::filesystem::path& figure, const Json& result,
                 const std::function<void(const std::filesystem::path&)>& write_fields);

}  // namespace slipstick::convergence
