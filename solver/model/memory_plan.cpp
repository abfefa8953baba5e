#include "solver/model/memory_plan.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <system_error>
#include <vector>

#include "solver/elasticity/elasticity.hpp"
#include "solver/grid/own_rows.hpp"
#include "solver/model/memory.hpp"
#include "solver/model/symmetry.hpp"

namespace slipstick::solver {
namespace {

/// Doubles a cell of the whole grid that a solve holds in addition to operators and workspaces. All of these
/// numbers are measured by convergence/solve/tests/memory_test.py.
constexpr double kFieldsHeld = 2.2;
/// Doubles a cell of the part that is solved; each of several processes has its own rows of it.
constexpr double kFieldsOfPart = 2.0;
/// Doubles a cell of the whole grid before and after the solve, without operators and workspaces.
constexpr double kFieldsAround = 12.0;
constexpr double kFieldsAroundPressure = 8.8;  ///< where only the pressure is solved
/// Doubles a cell of the whole grid that the solve of a pressure holds in addition to operators and workspaces.
constexpr double kFieldsOfPressure = 1.4;
/// Doubles a cell of the part that the other methods than Coulomb's hold.
constexpr double kFieldsOfOthers = 21.0;
/// Doubles a cell of the whole grid of the step before.
constexpr double kFieldsBefore = 20.0;
/// Doubles a cell of the whole grid where pressure and tractions are solved in turn: Anderson's combination
/// and guesses. They stand in for much of the step before.
constexpr double kFieldsOfTurns = 58.0;
constexpr double kFieldsBeforeTurns = 21.0;
/// Doubles a cell of a padded grid while stresses are computed, and for each state of a cycle.
constexpr double kFieldsOfStresses = 80.0, kFieldsOfState = 9.5;
/// Doubles a cell of the whole grid, and bytes at most, in freed blocks, which one process keeps: see prepare_heap().
constexpr double kFieldsKept = 3.0, kMostKept = 0x1p27;
double field_bytes(double fields, Index cells) { return fields * sizeof(double) * static_cast<double>(cells); }
/// The program, freed blocks and libraries, that for HDF5 included; where several processes share a grid MPI's too.
double program_bytes(const Grid& grid) {
  if (grid.ranks.several()) return 35.0 * 0x1p20;
  return 25.0 * 0x1p20 + std::min(field_bytes(kFieldsKept, grid.cells()), kMostKept);
}
double bytes_around(const Scene& scene, const Grid& grid) {
  const bool pressure = scene.contact.friction.is_frictionless() && scene.solver.method == Method::coulomb;
  return field_bytes(pressure ? kFieldsAroundPressure : kFieldsAround, grid.cells());
}

/// Bytes. Below this size the memory check is skipped.
constexpr double kLittleMemory = 0x1p26;

}  // namespace

void require_memory(const Scene& scene, const Grid& grid, double bytes) {
  if (!scene.solver.memory_limit && bytes < kLittleMemory) return;
  const double most = memory_within(scene.solver.memory_limit);
  if (bytes < most) return;
  throw OutOfMemory(scene.source.string(), "grid.cells", fmt::format("[{}, {}]", grid.n1, grid.n2),
                    fmt::format("what fits in memory: this needs {} with operator = \"{}\", and {} {}; {} less",
                                bytes_text(bytes), to_string(scene.solver.op), bytes_text(most),
                                scene.solver.memory_limit ? "are allowed (--memory-limit)" : "are there",
                                scene.solver.op == OperatorKind::dense    ? "fewer cells and operator = \"dcfft\" take"
                                : scene.solver.model == ModelChoice::full ? "fewer cells and model = \"auto\" take"
                                                                          : "fewer cells take"));
}

double memory_of_stresses(const Grid& grid, std::size_t states) {
  const double padded = 0.25 * static_cast<double>(fast_length(2 * grid.n1) * fast_length(2 * grid.n2));
  const double fields =
      kFieldsOfStresses * padded + kFieldsOfState * static_cast<double>(states) * static_cast<double>(grid.cells());
  return program_bytes(grid) + fields * sizeof(double);
}

void require_memory_for_files(const Scene& scene) {
  std::vector<std::filesystem::path> files{scene.contact.pressure_file, scene.contact.friction.map};
  for (const Surface& surface : scene.surfaces) files.push_back(surface.map.file);
  for (const std::filesystem::path& file : files) {
    std::error_code error;
    const std::uintmax_t size = file.empty() ? 0 : std::filesystem::file_size(file, error);
    const auto bytes = static_cast<double>(size);
    if (error || bytes < kLittleMemory || bytes < memory_within(scene.solver.memory_limit)) continue;
    throw OutOfMemory(file.string(), fmt::format("holds {}; allowed: what fits in memory, {}", bytes_text(bytes),
                                                 bytes_text(memory_within(scene.solver.memory_limit))));
  }
}

void require_memory_around(const Scene& scene, const Grid& grid) {
  require_memory(scene, grid, bytes_around(scene, grid));
}

Memory predicted_memory(const Scene& scene, const Model& model, const CandidateFraction& parts) {
  const bool follows = scene.steps.size() > 1 || scene.cycles > 1;
  const double before = model.shear_coupling ? kFieldsBeforeTurns : kFieldsBefore;
  const double turns = model.shear_coupling ? kFieldsOfTurns : 0.0;
  const double kept = field_bytes((follows ? before : 0.0) + turns, model.grid.cells());
  const Grid& part = model.pressure_part.grid();
  const Elasticity on_part = elasticity(scene, model, model.pressure_part);
  const double normal = scene.contact.pressure == PressureModel::solved
                            ? on_part.newton_bytes(part, normal_kernel(), parts.pressure)
                            : 0.0;
  // A solved pressure has the mirrors of the gap. Its tangential displacement lacks the mirrors of torsion.
  const bool whole = model.pressure_coupling || model.forces || scene.contact.pressure == PressureModel::file;
  const Grid& grid = whole ? model.grid : part;
  const Elasticity elastic = whole ? elasticity(scene, model, Reduction(model.grid)) : on_part;
  const double coupling = moves_by_pressure(scene, model) ? elastic.operator_bytes(grid, coupling_kernel()) : 0.0;
  const bool newton = scene.solver.method == Method::coulomb;
  const double tangential = !newton ? elastic.operator_bytes(grid, tangential_kernel())
                            : scene.contact.friction.is_frictionless()
                                ? 0.0  // nothing is solved
                                : elastic.newton_bytes(grid, tangential_kernel(), parts.tractions);
  const double of_part = newton ? field_bytes(kFieldsOfPart, own_rows(grid).count() * grid.n2)
                                : field_bytes(kFieldsOfOthers, grid.cells());
  const double pressed = normal + kept + field_bytes(kFieldsOfPressure, model.grid.cells());
  const double held = std::max(tangential, coupling) + kept + of_part + field_bytes(kFieldsHeld, model.grid.cells());
  const double solver = std::max({normal, tangential, coupling});
  return {solver, program_bytes(grid) + std::max({pressed, held, bytes_around(scene, model.grid)}) - solver};
}

void require_memory(const Scene& scene, const Model& model, const CandidateFraction& parts) {
  require_memory(scene, model.grid, predicted_memory(scene, model, parts).total());
}

}  // namespace slipstick::solver
