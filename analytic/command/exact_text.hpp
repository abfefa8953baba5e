#pragma once

#include <iosfwd>

#include "analytic/command/exact_answer.hpp"

/// The answers of the command `exact`, as text for a person.
namespace slipstick::analytic {

void write_state(std::ostream& out, const ExactContact& contact, const Json& answer);
void write_history(std::ostream& out, const ExactContact& contact, const Json& answer);
void write_certified(std::ostream& out, const ExactContact& contact, const Json& answer);

}  // namespace slipstick::analytic
