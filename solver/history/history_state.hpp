#pragma once

#include <cstddef>

#include "solver/contact/normal_contact.hpp"
#include "solver/step/contact_state.hpp"

namespace slipstick::solver {

/// Where a history stands at the end of a step: all that the next one needs to give the same digits.
struct HistoryState {
  std::size_t finished = 0;  ///< steps, those of earlier cycles too
  ContactState contact;
  /// How its pressure was found, for a step under the same normal load. The pressure itself is contact's.
  NormalSolution normal;
};

}  // namespace slipstick::solver
