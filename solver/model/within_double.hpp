#pragma once

#include <fmt/core.h>

#include <stdexcept>

#include "solver/input/input_error.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::solver {

/// Does a piece of work for a scene. Numbers whose squares or products leave double precision show only while they are
/// computed with, as std::invalid_argument or std::domain_error: what comes out is an InputError that names the scene.
template <typename Work>
auto within_double(const Scene& scene, const Work& work) {
  const auto refuse = [&](const std::exception& error) {
    return InputError(scene.source.string(),
                      fmt::format("leads to numbers that double precision does not hold ({}); allowed: moduli, "
                                  "lengths and loads some hundred orders of magnitude from its ends",
                                  error.what()));
  };
  try {
    return work();
  } catch (const InputError&) {
    throw;
  } catch (const std::invalid_argument& error) {
    throw refuse(error);
  } catch (const std::domain_error& error) {
    throw refuse(error);
  }
}

}  // namespace slipstick::solver
