#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "solver/elasticity.hpp"

namespace slipstick::solver {

enum class Shape { sphere, ellipsoid, cone, flat_punch, height_map };

/// Surface of the indenter; the members that its shape uses are set.
struct Surface {
  Shape shape = Shape::sphere;
  double radius = 0.0;              ///< m: sphere; flat_punch
  double radius_1 = 0.0;            ///< m: ellipsoid, radius of curvature along x1
  double radius_2 = 0.0;            ///< m: along x2
  double slope = 0.0;               ///< cone: gap over radius
  std::filesystem::path file;       ///< height_map: heights in m, one a cell, larger where further away
  std::array<double, 2> spacing{};  ///< height_map: m
};

struct Material {
  double young_modulus = 0.0;  ///< Pa; infinite: rigid
  double poisson_ratio = 0.0;
};

/// Where the pressure comes from: solved on the same grid; Hertz's at cell centres; Hertz's averaged over
/// each cell; a file.
enum class PressureModel { solved, hertz, hertz_averaged, file };

/// Whether the pressure's tangential displacement of dissimilar materials enters: where they are dissimilar,
/// never, always.
enum class Coupling { automatic, none, pressure };

/// Which method finds the tractions.
enum class Method { coulomb, projected_gradient, paper };

/// What may be left out of the model: what symmetry and the contact's size allow; nothing; the grid itself,
/// where the scene has an exact answer.
enum class ModelChoice { automatic, full, exact };

/// One of the three is set.
struct TorsionLoad {
  std::optional<double> moment_ratio;  ///< M over the limit of this pressure and mesh
  std::optional<double> moment;        ///< N m
  std::optional<double> twist;         ///< rad
};

/// What a scene file says, checked, with defaults filled in; SI units, or any other consistent set.
struct Scene {
  std::filesystem::path source;  ///< the file it was read from
  std::string name;
  Surface surface;
  Material upper;
  Material lower;
  double friction = 0.0;
  PressureModel pressure = PressureModel::solved;
  std::filesystem::path pressure_file;
  Coupling coupling = Coupling::automatic;
  std::optional<double> normal_load;  ///< N; may be left out where the pressure comes from a file
  TorsionLoad torsion;
  std::array<Index, 2> cells{};
  std::optional<std::array<double, 2>> extent;  ///< m
  Method method = Method::coulomb;
  ModelChoice model = ModelChoice::automatic;
  OperatorKind op = OperatorKind::dcfft;
  Precision precision = Precision::double_precision;
  double tolerance = 1e-8;
  int max_iterations = 5000;
  int threads = 1;
};

/// Reads a scene file (TOML); each override is "key=value" with a dotted key, applied before anything is
/// checked. Relative paths in the scene are relative to the scene file. Throws InputError naming file, key,
/// value and what is allowed.
Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// Words of the enumerations, as scene files and results have them.
std::string to_string(Shape shape);
std::string to_string(PressureModel model);
std::string to_string(OperatorKind kind);
std::string to_string(Method method);
std::string to_string(Precision precision);

}  // namespace slipstick::solver
