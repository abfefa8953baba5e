#pragma once

#include <array>
#include <string>
#include <vector>

#include "solver/input/toml_reader.hpp"

/// Measured errors and costs of solves of smooth contacts on meshes of several sizes.
namespace slipstick::convergence {

/// The quantity that an accuracy is asked of: the twist (the moment, where the twist is imposed), the
/// tractions (root mean square), the stick radius.
enum class AccuracyOf { twist, traction, stick_radius };
inline constexpr std::size_t kAccuracies = 3;

/// Their words, as --accuracy-of and the data have them.
const solver::Words<AccuracyOf>& accuracy_words();

/// Error of a quantity on a mesh, the largest over the loads and over finer meshes; and the loosest tolerance
/// that changes it by at most a tenth.
struct MeasuredError {
  double error;
  double tolerance;
};

/// One mesh. Work is the seconds of a whole solve (with what symmetry leaves out) over those of one
/// application on the reference grid, see application_seconds().
struct MeasuredMesh {
  double cells_across;                            ///< the contact's diameter over a cell's side
  std::array<MeasuredError, kAccuracies> errors;  ///< as AccuracyOf
  std::vector<double> tolerances;                 ///< falling
  std::vector<double> applications;               ///< at each, the most over the loads
  std::vector<double> work;                       ///< likewise
};

struct AccuracyData {
  std::vector<MeasuredMesh> meshes;  ///< finer and finer, at least two
};

/// Those that come with the program: errors and tolerances fall from mesh to mesh.
AccuracyData accuracy_data();

/// The same as text; `origin` says in a comment where it was measured.
std::string accuracy_toml(const AccuracyData& data, const std::string& origin);

/// The mesh and the tolerance that reach an error.
struct Needed {
  double cells_across;
  double tolerance;
};

/// Coarsest mesh and loosest tolerance: between measured meshes as powers of the cells, beyond the finest as
/// among the three finest. The error must be positive.
Needed needed_for(const AccuracyData& data, AccuracyOf of, double error);

/// The error on a mesh with `cells_across` cells across the contact, found in the same way.
double error_with(const AccuracyData& data, AccuracyOf of, double cells_across);

/// Power of the cell size with which the error falls on the finest measured meshes.
double falling_order(const AccuracyData& data, AccuracyOf of);

/// Work of a solve with `cells_across` cells across the contact to a tolerance.
double work_of(const AccuracyData& data, double cells_across, double tolerance);

}  // namespace slipstick::convergence
