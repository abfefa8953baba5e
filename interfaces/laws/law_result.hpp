#pragma once

#include <string>

#include "convergence/laws/contact_law.hpp"
#include "convergence/results/result_parts.hpp"

namespace slipstick::laws {

using convergence::ContactLaw;
using convergence::Json;

/// All forms of a law with their errors.
Json law_json(const ContactLaw& law);

/// What a person wants to know of it: a few lines.
std::string law_text(const Json& result);

}  // namespace slipstick::laws
