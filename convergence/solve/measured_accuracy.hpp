#pragma once

#include <array>
#include <vector>

#include "solver/input/toml_reader.hpp"

/// Measured errors and work of solves of smooth contacts on several meshes.
namespace slipstick::convergence {

/// The quantity whose error is bounded: the twist (the moment if the twist is imposed), the tractions (root
/// mean square), the stick radius.
enum class AccuracyOf { twist, traction, stick_radius };
inline constexpr std::size_t kAccuracies = 3;

/// Their words in --accuracy-of and in the data.
const solver::Words<AccuracyOf>& accuracy_words();

/// Relative error of a quantity on a mesh, the largest over the loads and over finer meshes, and the loosest
/// tolerance that changes the error by at most a tenth.
struct MeasuredError {
  double error;
  double tolerance;
};

/// One mesh. Work is the seconds of a solve, with symmetry used, divided by application_seconds().
struct MeasuredMesh {
  double cells_across;                            ///< the contact's diameter over a cell's side
  std::array<MeasuredError, kAccuracies> errors;  ///< as AccuracyOf
  std::vector<double> tolerances;                 ///< falling
  std::vector<double> work;                       ///< at each tolerance, the most over the loads
};

struct AccuracyData {
  std::vector<MeasuredMesh> meshes;  ///< finer and finer, at least two
};

/// The data of accuracy.toml, which `bench --accuracy-data` writes: errors and tolerances fall from mesh to mesh.
AccuracyData accuracy_data();

/// The mesh and the tolerance that reach an error.
struct Needed {
  double cells_across;
  double tolerance;
};

/// Coarsest mesh and loosest tolerance: by a power law between neighbouring meshes; beyond the finest mesh by
/// the power law of the three finest. The error must be positive.
Needed needed_for(const AccuracyData& data, AccuracyOf of, double error);

/// The error on a mesh with `cells_across` cells across the contact, by the same power laws.
double error_with(const AccuracyData& data, AccuracyOf of, double cells_across);

/// Power of the cell size with which the error falls on the finest measured meshes.
double falling_order(const AccuracyData& data, AccuracyOf of);

/// Work of a solve with `cells_across` cells across the contact to a tolerance.
double work_of(const AccuracyData& data, double cells_across, double tolerance);

}  // namespace slipstick::convergence
