// The law as source text: a C header and a Python module, with the same functions.

#include <fmt/ranges.h>

#include <utility>
#include <vector>

#include "interfaces/laws/law_files.hpp"
#include "law_templates.hpp"  // law.h.in and law.py.in

namespace slipstick::laws {

using namespace convergence;

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

std::string source(const char* text, const ContactLaw& law, const std::string& heading,
                   std::vector<std::pair<std::string, std::string>> values) {
  values.insert(values.end(), {{"@PREFIX@", law.contact.prefix},
                               {"@CAPITALS@", capital_prefix_of(law)},
                               {"@HEADING@", heading},
                               {"@ERROR@", fmt::format("{}", law.law.error)},
                               {"@LAST@", number(law.law.last_twist * law.rotation_unit())},
                               {"@LIMIT@", number(law.limit_moment())},
                               {"@STIFFNESS@", number(kStiffness * law.moment_unit() / law.rotation_unit())},
                               {"@ROTATION_UNIT@", number(law.rotation_unit())},
                               {"@DEFICIT@", fmt::format("{}", kLastDeficit)},
                               {"@FULL_STICK@", number(law.law.full_stick)},
                               {"@FIRST_LOGARITHM@", number(law.law.first_logarithm)},
                               {"@LOSS_POWER@", number(law.law.loss_power)},
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

}  // namespace slipstick::laws
