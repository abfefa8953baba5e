// The law as source text: a C header and a Python module, with the same functions.

#include <fmt/core.h>
#include <fmt/ranges.h>

#include <string>
#include <utility>
#include <vector>

#include "convergence/laws/law_files.hpp"

namespace slipstick::convergence {
namespace {

/// Replaces each name in the text by its value.
std::string filled(std::string text, const std::vector<std::pair<std::string, std::string>>& values) {
  for (const auto& [name, value] : values) {
    for (std::size_t at = text.find(name); at != std::string::npos; at = text.find(name, at + value.size())) {
      text.replace(at, name.size(), value);
    }
  }
  return text;
}

std::string number(double value) { return fmt::format("{:.17g}", value); }

std::string list(const std::vector<double>& values) {
  std::string text;
  for (std::size_t i = 0; i < values.size(); ++i) {
    text += (i == 0 ? "" : i % 4 == 0 ? ",\n    " : ", ") + number(values[i]);
  }
  return text;
}

/// Ends of the pieces, where each one's coefficients begin, and these.
struct FlatFit {
  std::vector<double> ends;
  std::vector<std::size_t> first;
  std::vector<double> coefficients;
};
FlatFit flat(const PiecewiseChebyshev& fit) {
  FlatFit flat{{fit.pieces.front().low}, {0}, {}};
  for (const ChebyshevPiece& piece : fit.pieces) {
    flat.ends.push_back(piece.high);
    flat.coefficients.insert(flat.coefficients.end(), piece.coefficients.begin(), piece.coefficients.end());
    flat.first.push_back(flat.coefficients.size());
  }
  return flat;
}

std::string c_arrays(const PiecewiseChebyshev& fit) {
  const auto [ends, first, coefficients] = flat(fit);
  return fmt::format(
      "  static const double ends[] = {{{}}};\n  static const int first[] = {{{}}};\n"
      "  static const double c[] = {{\n    {}}};\n",
      list(ends), fmt::join(first, ", "), list(coefficients));
}

std::string python_arrays(const std::string& name, const PiecewiseChebyshev& fit) {
  const auto [ends, first, coefficients] = flat(fit);
  return fmt::format("{} = ([{}],\n    [{}],\n    [{}])\n", name, list(ends), fmt::join(first, ", "),
                     list(coefficients));
}

constexpr const char* kHeader = R"(/*
@HEADING@   Relative errors of moment and rotation on first loading at most @ERROR@; of a moment on a later branch at
   most three times that of the largest moment. A rotation beyond @LAST@ carries the limit.
*/
#ifndef SLIPSTICK_LAW_H
#define SLIPSTICK_LAW_H

#include <math.h>

#define SLIPSTICK_LAW_LIMIT @LIMIT@
#define SLIPSTICK_LAW_STIFFNESS @STIFFNESS@ /* at rest: moment over rotation */
#define SLIPSTICK_LAW_ERROR @ERROR@
#define SLIPSTICK_LAW_LAST_ROTATION @LAST@

static inline double slipstick_law_fit(const double *ends, const int *first, const double *c, int pieces, double x) {
  int k = 0, i;
  double scaled, next = 0, after = 0;
  while (k + 1 < pieces && x > ends[k + 1]) ++k;
  scaled = (2 * x - ends[k] - ends[k + 1]) / (ends[k + 1] - ends[k]);
  for (i = first[k + 1] - 1; i > first[k]; --i) {
    const double value = c[i] + 2 * scaled * next - after;
    after = next;
    next = value;
  }
  return c[first[k]] + scaled * next - after;
}

/* The moment of first loading at a rotation. */
static inline double slipstick_law_moment(double rotation) {
@LOGARITHM@  const double size = fabs(rotation) / @ROTATION_UNIT@;
  if (fabs(rotation) >= SLIPSTICK_LAW_LAST_ROTATION) return copysign(SLIPSTICK_LAW_LIMIT, rotation);
  return copysign(-SLIPSTICK_LAW_LIMIT * expm1(-size * slipstick_law_fit(ends, first, c, @PIECES_1@, size)), rotation);
}

/* The rotation of first loading at a moment; infinite from the limit on. */
static inline double slipstick_law_rotation(double moment) {
@TWIST@  const double size = fabs(moment) / SLIPSTICK_LAW_LIMIT;
  double l;
  if (size > 1 - @DEFICIT@) return copysign(HUGE_VAL, moment);
  l = -log1p(-size);
  return copysign(@ROTATION_UNIT@ * l * slipstick_law_fit(ends, first, c, @PIECES_2@, l), moment);
}

/* The moment at a rotation on the branch that began at a reversal (Masing's rule), until it leaves the range of the
   largest rotation so far: from there on it is that of first loading. */
static inline double slipstick_law_branch(double start_rotation, double start_moment, double rotation) {
  return start_moment + 2 * slipstick_law_moment(0.5 * (rotation - start_rotation));
}

/* The energy that a cycle between a moment and its negative loses; NaN from the limit on. */
static inline double slipstick_law_energy_lost(double moment) {
@LOSS@  const double size = fabs(moment) / SLIPSTICK_LAW_LIMIT;
  if (!(size <= 1 - @DEFICIT@)) return NAN;
  if (size <= @FULL_STICK@) return 0;
  return 4 * fabs(moment) * slipstick_law_rotation(fabs(moment)) *
         slipstick_law_fit(ends, first, c, @PIECES_3@, -log1p(-size));
}

#endif
)";

constexpr const char* kModule = R"("""
@HEADING@Relative errors of moment and rotation on first loading at most @ERROR@; of a moment on a later branch at
most three times that of the largest moment. A rotation beyond LAST_ROTATION carries the limit.
"""

from bisect import bisect_left
from math import copysign, expm1, inf, log1p, nan

LIMIT = @LIMIT@
STIFFNESS = @STIFFNESS@  # at rest: moment over rotation
ERROR = @ERROR@
LAST_ROTATION = @LAST@

@LOGARITHM@@TWIST@@LOSS@

def _fit(data, x):
    ends, first, c = data
    k = min(bisect_left(ends, x, 1), len(ends) - 1) - 1
    scaled = (2 * x - ends[k] - ends[k + 1]) / (ends[k + 1] - ends[k])
    following = after = 0.0
    for i in range(first[k + 1] - 1, first[k], -1):
        following, after = c[i] + 2 * scaled * following - after, following
    return c[first[k]] + scaled * following - after


def moment(rotation):
    """The moment of first loading at a rotation."""
    if abs(rotation) >= LAST_ROTATION:
        return copysign(LIMIT, rotation)
    size = abs(rotation) / @ROTATION_UNIT@
    return copysign(-LIMIT * expm1(-size * _fit(_LOGARITHM, size)), rotation)


def rotation(moment):
    """The rotation of first loading at a moment; infinite from the limit on."""
    size = abs(moment) / LIMIT
    if size > 1 - @DEFICIT@:
        return copysign(inf, moment)
    logarithm = -log1p(-size)
    return copysign(@ROTATION_UNIT@ * logarithm * _fit(_TWIST, logarithm), moment)


def branch(start_rotation, start_moment, rotation):
    """The moment at a rotation on the branch that began at a reversal (Masing's rule), until it leaves the range of
    the largest rotation so far: from there on it is that of first loading."""
    return start_moment + 2 * moment(0.5 * (rotation - start_rotation))


def energy_lost(moment):
    """The energy that a cycle between a moment and its negative loses; NaN from the limit on."""
    size = abs(moment) / LIMIT
    if not size <= 1 - @DEFICIT@:
        return nan
    if size <= @FULL_STICK@:
        return 0.0
    return 4 * abs(moment) * rotation(abs(moment)) * _fit(_LOSS, -log1p(-size))
)";

std::string source(const char* text, const ContactLaw& law, const std::string& heading,
                   std::vector<std::pair<std::string, std::string>> values) {
  values.insert(values.end(), {{"@HEADING@", heading},
                               {"@ERROR@", fmt::format("{}", law.law.error)},
                               {"@LAST@", number(law.law.last_twist * law.rotation_unit())},
                               {"@LIMIT@", number(law.limit_moment())},
                               {"@STIFFNESS@", number(kStiffness * law.moment_unit() / law.rotation_unit())},
                               {"@ROTATION_UNIT@", number(law.rotation_unit())},
                               {"@DEFICIT@", fmt::format("{}", kLastDeficit)},
                               {"@FULL_STICK@", number(law.law.full_stick)},
                               {"@PIECES_1@", fmt::format("{}", law.law.logarithm.pieces.size())},
                               {"@PIECES_2@", fmt::format("{}", law.law.twist.pieces.size())},
                               {"@PIECES_3@", fmt::format("{}", law.law.loss_factor.pieces.size())}});
  return filled(text, values);
}

/// A name that closes no comment and no text.
std::string harmless(std::string text) {
  for (char& letter : text) {
    if (letter == '*' || letter == '"' || letter == '\\') letter = '_';
  }
  return text;
}

}  // namespace

std::string c_header(const ContactLaw& law) {
  return source(kHeader, law, harmless(law_heading(law, "   ")),
                {{"@LOGARITHM@", c_arrays(law.law.logarithm)},
                 {"@TWIST@", c_arrays(law.law.twist)},
                 {"@LOSS@", c_arrays(law.law.loss_factor)}});
}

std::string python_module(const ContactLaw& law) {
  return source(kModule, law, harmless(law_heading(law, "")),
                {{"@LOGARITHM@", python_arrays("_LOGARITHM", law.law.logarithm)},
                 {"@TWIST@", python_arrays("_TWIST", law.law.twist)},
                 {"@LOSS@", python_arrays("_LOSS", law.law.loss_factor)}});
}

}  // namespace slipstick::convergence
