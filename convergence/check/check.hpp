#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/check/causes.hpp"
#include "convergence/check/examination.hpp"
#include "convergence/check/verdict.hpp"
#include "convergence/results/result_parts.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// Options of a check. A good field is right within its mesh; discrete and strict make the check stricter.
struct CheckOptions {
  std::optional<double> twist = {};       ///< rad, that the program reported
  std::vector<std::string> columns = {};  ///< names for a file without a header, or paths in an HDF5 file
  bool discrete = false;                  ///< a good field solves its own grid's problem, with constant cells
  bool strict = false;                    ///< a good field is in the scene's conventions
  bool pressure_given = false;            ///< the pressure is not judged
  /// Error allowed for loads, pressure, motion and tractions, instead of the one derived from the mesh.
  std::optional<double> tolerance = {};
};

/// A field that was checked.
struct FieldCheck {
  std::filesystem::path file;
  CheckOptions options;
  Examination examination;
  Verdict verdict;
  Explanation explanation;

  bool good() const;
  std::string headline() const;  ///< the first quantity that is wrong, or that all are right
  std::string details() const;   ///< the causes, further wrong quantities, the right ones
};

/// Judges a traction field that any program computed for a scene, by Coulomb's law and against the exact
/// solution where one exists:
///
///  1. examine(): read the field, put it into the scene's conventions, pose its contact, measure its errors
///     and the errors that its mesh causes in right fields.
///  2. reach_verdict(): compare each quantity with its allowed maximum.
///  3. explain(): name likely causes of wrong quantities.
///
/// Without a twist, the scene's is taken if it imposes one, otherwise the one that fits Coulomb's law best.
/// Throws InputError for a field or a scene that cannot be judged.
FieldCheck check_field(const solver::Scene& scene, const std::filesystem::path& file,
                       const CheckOptions& options = {});

/// The result in SI units, docs/schema/check.schema.json.
Json to_json(const FieldCheck& check);

/// The result in a few lines of text.
std::string check_text(const FieldCheck& check);

}  // namespace slipstick::convergence
