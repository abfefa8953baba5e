#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "solver/elasticity/operator_kind.hpp"
#include "solver/grid/grid.hpp"
#include "solver/scene/friction_law.hpp"
#include "solver/scene/surface.hpp"

namespace slipstick::solver {

/// An elastic layer, bonded to the surface of a body.
struct Coating {
  double thickness = 0.0;      ///< m
  double young_modulus = 0.0;  ///< Pa; finite
  double poisson_ratio = 0.0;
};

/// An elastic body, or a rigid one, and the layer on it.
struct Material {
  double young_modulus = 0.0;  ///< Pa; infinite: rigid
  double poisson_ratio = 0.0;
  std::optional<Coating> coating = {};      ///< none: the body itself is touched
  std::optional<double> yield_stress = {};  ///< Pa; a higher peak pressure is warned of
};

struct LawKind;

/// The layer between the two bodies, which are half-spaces.
struct Layer {
  const LawKind* kind = nullptr;    ///< one of law_kinds(), law_kind.hpp; null: there is no layer
  std::vector<double> values = {};  ///< of the kind's parameters, in SI units
};

/// Where the pressure comes from: solved on the same grid; Hertz's at cell centres; Hertz's averaged over
/// each cell; a file.
enum class PressureModel { solved, hertz, hertz_averaged, file };

/// How normal and tangential tractions of dissimilar materials couple: the pressure's tangential displacement
/// where they are dissimilar, nothing, that displacement, and also the shear's normal displacement.
enum class Coupling { automatic, none, pressure, full };

/// The method that finds the tractions.
enum class Method { coulomb, paper };

/// The reduction of the model: as far as symmetry and the contact's size allow; none; no grid, where the
/// scene has an exact answer.
enum class ModelChoice { automatic, full, exact };

/// The load that turns the upper body about the grid's origin. Signed: a history turns back.
struct MomentRatio {
  double value = 0.0;  ///< M over the limit of this pressure and mesh
  bool operator==(const MomentRatio&) const = default;
};
/// The moment itself.
struct Moment {
  double value = 0.0;  ///< N m
  bool operator==(const Moment&) const = default;
};
/// The rotation is imposed, and the moment follows.
struct Twist {
  double value = 0.0;  ///< rad, since the first step
  bool operator==(const Twist&) const = default;
};
using TorsionLoad = std::variant<MomentRatio, Moment, Twist>;

/// The load's value where it is of this kind, as value_if<Twist>(step.torsion).
template <class Kind>
std::optional<double> value_if(const TorsionLoad& load) {
  const auto* const kind = std::get_if<Kind>(&load);
  return kind != nullptr ? std::optional(kind->value) : std::nullopt;
}

/// The loads at the end of a step, which brings the normal load first, then the tangential ones.
struct Step {
  std::string key = "load";  ///< of its table in the scene file
  std::string name = {};
  std::optional<double> normal = {};  ///< N; may be left out where the pressure comes from a file
  TorsionLoad torsion = MomentRatio{0.0};
  std::array<double, 2> force{};                           ///< N, tangential, on the upper body; or else
  std::optional<std::array<double, 2>> displacement = {};  ///< m, imposed instead, since the first step
  /// Loads that neither this step nor an earlier one sets: the first cycle takes them from [load], later
  /// cycles from the last step.
  struct Inherited {
    bool normal = false, torsion = false, translation = false;
  } inherited = {};
};

/// A part of the problem that the model leaves out, and why the answer does not change by that.
struct Omission {
  std::string what;
  std::string why;
};

/// Whether a step brings a tangential force or displacement.
bool brings_translation(const Step& step);

/// The keys of [contact].
struct ContactSettings {
  FrictionLaw friction = {};
  PressureModel pressure = PressureModel::solved;
  std::filesystem::path pressure_file = {};
  Coupling coupling = Coupling::automatic;
};

/// The keys of [grid].
struct GridSettings {
  std::array<Index, 2> cells{};
  std::optional<std::array<double, 2>> extent = {};  ///< m
};

/// The keys of [solver], and the memory that the command line allows.
struct SolverSettings {
  /// File of another program that finds pressure and tractions instead of `method`; empty: none does.
  std::filesystem::path program = {};
  Method method = Method::coulomb;
  ModelChoice model = ModelChoice::automatic;
  OperatorKind op = OperatorKind::dcfft;
  CellTraction cell_traction = CellTraction::constant;
  double tolerance = 1e-8;
  int max_iterations = 5000;
  int substeps = 1;  ///< parts into which each step's change of load is divided
  int threads = 0;   ///< of one solve; 0: chosen by the number of cells, at most one for each processor
  /// 0: round to nearest; otherwise rounding is random with this seed, which shows the digits that depend on it.
  std::int64_t rounding_seed = 0;
  std::optional<double> memory_limit = {};  ///< bytes; none: the memory that the machine has free
};

/// The content of a scene file, checked, with defaults filled in; SI units, or any other consistent set.
struct Scene {
  std::filesystem::path source;  ///< the file it was read from
  std::string name;
  std::vector<Surface> surfaces{{}};  ///< of the indenter, at least one, then of the lower body
  Combine combine = Combine::sum;
  /// The indenter ends at the grid's edge, so its contact may reach that edge.
  bool ends_at_grid_edge = false;
  Material upper;
  Material lower;
  Layer layer;
  ContactSettings contact;
  std::vector<Step> steps = std::vector<Step>(1);  ///< at least one
  int cycles = 1;                                  ///< repetitions of the steps
  /// Steps at the beginning that are the points of one step: a later cycle begins them at its last step.
  std::size_t first_points = 1;
  GridSettings grid;
  SolverSettings solver;
  std::vector<Omission> left_out = {};  ///< by without_last_digits()
  /// The file's units for SI units, as {"m", "mm"}, in which texts show results. All members are in SI units.
  std::map<std::string, std::string> units = {};
};

/// Whether a layer is bonded to a body.
bool is_coated(const Scene& scene);

/// Whether the bodies are half-spaces that touch each other: without a layer between them or on them.
bool is_bare(const Scene& scene);

/// The loads when a part of a step's change is made.
Step on_the_way(const Step& before, const Step& step, double part);

/// The k-th step of the whole history, counted over all cycles.
Step step_of(const Scene& scene, std::size_t k);

/// Reads a scene file (TOML); each override is "key=value" with a dotted key, applied before anything is
/// checked. Relative paths in the scene are relative to the scene file. Throws InputError naming file, key,
/// value and allowed values.
Scene read_scene(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});

/// Reads a scene from text. `file` is its name in messages; relative paths are relative to it.
Scene read_scene_text(const std::string& text, const std::filesystem::path& file,
                      const std::vector<std::string>& overrides = {});

/// Throws InputError, naming key, value and allowed values, for a scene that cannot be solved. Errors that
/// depend on the solution (a contact wider than the grid, loads beyond the limit) are found by the solve.
/// solve() calls validate().
void validate(const Scene& scene);

/// Words of the enumerations, as scene files and results have them.
std::string to_string(PressureModel model);
std::string to_string(OperatorKind kind);
std::string to_string(FrictionKind kind);
std::string to_string(Method method);
std::string to_string(CellTraction traction);

}  // namespace slipstick::solver
