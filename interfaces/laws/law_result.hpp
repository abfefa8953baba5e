#pragma once

#include <string>

#include "convergence/laws/contact_law.hpp"
#include "convergence/results/result_parts.hpp"

namespace slipstick::laws {

using convergence::ContactLaw;
using convergence::Json;

/// All forms of a law with their errors.
Json law_json(const ContactLaw& law);

/// The result in a few lines of text.
std::string law_text(const Json& result);

}  // namespace slipstick::laws
