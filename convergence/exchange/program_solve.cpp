#include "convergence/exchange/program_solve.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <utility>

#include "convergence/exchange/given_fields.hpp"
#include "convergence/programs/temporary_folder.hpp"
#include "convergence/results/json_text.hpp"
#include "convergence/results/output.hpp"
#include "solver/elasticity/law/law_kind.hpp"
#include "solver/input/field_file.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/table_text.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;
using Eigen::ArrayXd;
using solver::Grid;
using solver::Index;
using solver::Scene;

/// Version of the exchange files, for programs that depend on it.
constexpr int kFormat = 1;
/// Relative error of the normal load beyond which a file lacks rows or is not in Pa: coarse meshes and crude
/// quadratures are off by less.
constexpr double kLoadOff = 0.25;

/// NumPy's format, version 1.0: doubles of this machine, row by row.
void write_npy(const fs::path& file, const Grid& grid, const ArrayXd& values) {
  std::string header = fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}", grid.n1, grid.n2);
  constexpr std::size_t kBefore = 10;  // magic, version, the header's length
  constexpr std::size_t kAligned = 64;
  header.resize((kBefore + header.size() + kAligned) / kAligned * kAligned - kBefore - 1, ' ');
  header += '\n';
  std::string text = std::string("\x93NUMPY\x01\x00", 8);
  text += static_cast<char>(header.size() % 256);
  text += static_cast<char>(header.size() / 256);
  text += header;
  solver::write_whole_file(file, [&](std::FILE* out) {
    std::fwrite(text.data(), 1, text.size(), out);
    std::fwrite(values.data(), sizeof(double), static_cast<std::size_t>(values.size()), out);
  });
}

/// A line for each x1.
void write_csv(const fs::path& file, const Grid& grid, const ArrayXd& values) {
  solver::write_whole_file(file, [&](std::FILE* out) {
    for (Index i = 0; i < grid.n1; ++i) {
      std::string line;
      for (Index j = 0; j < grid.n2; ++j) {
        line += fmt::format("{}{:.17g}", j == 0 ? "" : ",", values[i * grid.n2 + j]);
      }
      fmt::print(out, "{}\n", line);
    }
  });
}

/// Writes an array into the folder of the scene and returns its name.
std::string write_array(const SolverProgram& program, const ExchangeFiles& files, const std::string& name,
                        const Grid& grid, const ArrayXd& values) {
  std::string file = name + (program.numpy ? ".npy" : ".csv");
  (program.numpy ? write_npy : write_csv)(files.scene.parent_path() / file, grid, values);
  return file;
}

Json body_json(const solver::Material& body) {
  if (std::isinf(body.young_modulus)) return {{"rigid", true}, {"young_modulus", nullptr}, {"poisson_ratio", nullptr}};
  return {{"rigid", false}, {"young_modulus", body.young_modulus}, {"poisson_ratio", body.poisson_ratio}};
}

Json load_json(const solver::Step& step) {
  Json load{{"normal", step.normal ? Json(*step.normal) : Json()}};
  if (const auto twist = solver::value_if<solver::Twist>(step.torsion)) {
    load.update({{"twist", *twist}});
  } else {
    load.update({{"moment", solver::value_if<solver::Moment>(step.torsion).value_or(0.0)}});
  }
  if (step.displacement) {
    load.update({{"displacement", *step.displacement}});
  } else {
    load.update({{"force", step.force}});
  }
  return load;
}

/// How normal and tangential tractions are to be coupled.
const char* coupling_word(const solver::Scene& scene, const PosedScene& posed) {
  if (!posed.coupled) return "none";
  return scene.contact.coupling == solver::Coupling::full ? "full" : "pressure";
}

/// Writes the scene's numbers: grid, cell centres, materials, loads; and the gap and a given pressure as
/// files of their own.
void write_exchange(const SolverProgram& program, const ExchangeFiles& files, const solver::Scene& scene,
                    const PosedScene& posed) {
  if (!scene.contact.friction.is_coulomb()) {
    throw solver::InputError(scene.source.string(), "contact.friction_law",
                             fmt::format("\"{}\"", to_string(scene.contact.friction.kind)),
                             "\"coulomb\" without a map, where another program solves: it receives only a coefficient");
  }
  const Grid& grid = posed.grid;
  std::vector<double> x1;
  std::vector<double> x2;
  for (Index i = 0; i < grid.n1; ++i) x1.push_back(grid.x1(i));
  for (Index j = 0; j < grid.n2; ++j) x2.push_back(grid.x2(j));
  Json json{{"format", kFormat},
            {"name", scene.name},
            {"cells", {grid.n1, grid.n2}},
            {"cell_size", {grid.h1, grid.h2}},
            {"x1", x1},
            {"x2", x2},
            {"combined",
             {{"shear_modulus", posed.shear_modulus},
              {"poisson_ratio", posed.poisson_ratio},
              {"contact_modulus", posed.contact_modulus},
              {"mismatch", posed.mismatch}}},
            {"upper", body_json(scene.upper)},
            {"lower", body_json(scene.lower)},
            {"layer", nullptr},
            {"friction", scene.contact.friction.coefficient},
            {"coupling", coupling_word(scene, posed)},
            {"load", load_json(scene.steps.front())},
            {"tolerance", scene.solver.tolerance},
            {"threads", std::max(1, scene.solver.threads)},
            {"gap", write_array(program, files, "gap", grid, posed.gap)},
            {"pressure", nullptr}};
  if (scene.layer.kind != nullptr) json["layer"] = scene.layer.kind->word;
  if (is_coated(scene)) json["layer"] = "bonded";  // the constants of the bodies are not all
  if (posed.pressure.size() > 0) {
    json["pressure"] = write_array(program, files, "pressure", grid, posed.pressure);
  }
  solver::write_whole_file(files.scene, json_text(json, 1) + "\n");
}

/// The fields that a program wrote; tractions are zero and `tractions` is false where it found only the
/// pressure. Throws ProgramFailure for a file that is missing, broken or of another grid, that holds no
/// finite number or a negative pressure, or that carries another normal load.
struct ReadFields {
  GivenFields fields;
  bool tractions;
};
ReadFields read_exchange(const SolverProgram& program, const ExchangeFiles& files, const solver::Scene& scene,
                         const PosedScene& posed) {
  if (!fs::is_regular_file(files.field)) {
    throw ProgramFailure(fmt::format("{} ended well but wrote no field", program.name));
  }
  try {
    const std::vector<std::string> there = solver::text_table_names(files.field);
    const bool tractions = std::ranges::find(there, "q1") != there.end();
    std::vector<std::string> names{"x1", "x2", "pressure"};
    if (tractions) names.insert(names.end(), {"q1", "q2"});
    const std::vector<solver::Column> columns = solver::read_columns(files.field, names);
    const std::vector<Index> cells = solver::cells_of_rows(files.field, posed.grid, columns);
    const Index all = posed.grid.cells();
    ReadFields read{{ArrayXd::Zero(all), ArrayXd::Zero(2 * all)}, tractions};
    for (std::size_t row = 0; row < cells.size(); ++row) {
      const auto at = static_cast<Index>(row);
      const double pressure = columns[2].values[at];
      if (!(pressure >= 0.0)) {
        throw solver::InputError(files.field.string(),
                                 fmt::format("row {}: pressure = {}; allowed: zero or positive", row + 1, pressure));
      }
      read.fields.pressure[cells[row]] = pressure;
      if (!tractions) continue;
      read.fields.traction[cells[row]] = columns[3].values[at];
      read.fields.traction[all + cells[row]] = columns[4].values[at];
    }
    const double carried = read.fields.pressure.sum() * posed.grid.cell_area();
    const double load = scene.steps.front().normal.value_or(carried);
    if (!(carried > 0.0 && std::abs(carried / load - 1.0) <= kLoadOff)) {
      throw solver::InputError(files.field.string(),
                               fmt::format("its pressure carries {:.6g} N of {:.6g} N: it is not whole, or "
                                           "its pressure is not in Pa",
                                           carried, load));
    }
    return read;
  } catch (const solver::InputError& error) {
    throw ProgramFailure(fmt::format("{} wrote a field that cannot be used: {}", program.name, error.what()));
  }
}

/// The program's own numbers, if it wrote any: twist_angle (rad), iterations, seconds, converged, message.
OwnNumbers read_own_numbers(const SolverProgram& program, const ExchangeFiles& files) {
  OwnNumbers own;
  if (!fs::is_regular_file(files.numbers)) return own;
  try {
    const Json read = read_json(files.numbers, "JSON with twist_angle, iterations, seconds, converged, message");
    const auto find = [&](const char* key, auto& value, bool (Json::*is_right)() const noexcept) {
      const auto found = read.find(key);
      if (found != read.end() && ((*found).*is_right)()) found->get_to(value.emplace());
    };
    std::optional<std::string> message;
    find("twist_angle", own.twist_angle, &Json::is_number);
    find("twist", own.twist, &Json::is_number);
    find("iterations", own.iterations, &Json::is_number);
    find("seconds", own.seconds, &Json::is_number);
    find("converged", own.converged, &Json::is_boolean);
    find("message", message, &Json::is_string);
    own.message = plain_text(message.value_or(""));
    // Its older name, rad here, which in results is G a^2 phi/(mu W).
    if (own.twist_angle) own.twist.reset();
    if (own.twist) own.twist_angle = own.twist;
  } catch (const solver::InputError& error) {
    throw ProgramFailure(fmt::format("{} wrote numbers that cannot be read: {}", program.name, error.what()));
  }
  return own;
}

/// A field whose errors are larger belongs to another scene. Coarse meshes are off by a hundredth. The gap is
/// not limited: it depends on the discretisation.
constexpr solver::CertificateBounds kSameLoads{
    .gap = std::numeric_limits<double>::infinity(), .moment = 0.05, .force = 0.05, .friction_bound = 0.05};

/// The largest count of iterations that is taken seriously.
constexpr double kMaxIterations = 1e9;

/// The scene under loads in N and N m.
Scene under_given_loads(Scene scene, double limit) {
  solver::Step& step = scene.steps.front();
  if (const auto ratio = solver::value_if<solver::MomentRatio>(step.torsion)) {
    step.torsion = solver::Moment{*ratio * limit};
  }
  return scene;
}

/// The scene's normal contact only.
Scene normal_contact_of(Scene scene) {
  solver::Step& step = scene.steps.front();
  step.torsion = solver::Moment{0.0};
  step.force = {};
  step.displacement.reset();
  scene.contact.coupling = solver::Coupling::none;
  return scene;
}

}  // namespace

ProgramAnswer solve_by_program(const Scene& scene, const AllowedPrograms& allowed) {
  const SolverProgram program = read_solver_program(scene.solver.program);
  const auto ratio = solver::value_if<solver::MomentRatio>(scene.steps.front().torsion);
  const bool by_ratio = ratio.value_or(0.0) != 0.0;
  const PosedScene posed = pose(scene, by_ratio);
  ProgramAnswer answer{
      .scene = under_given_loads(scene, posed.moment_limit), .exact = {}, .solution = {}, .program = {}};

  const TemporaryFolder folder;
  const ExchangeFiles files{folder / "scene.json", folder / "field.csv", folder / "numbers.json"};
  write_exchange(program, files, answer.scene, posed);
  const auto start = std::chrono::steady_clock::now();
  const ProgramEnd end = run_solver_program(program, files, allowed.tied_by);
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const ReadFields read = read_exchange(program, files, answer.scene, posed);
  const OwnNumbers own = read_own_numbers(program, files);

  if (!read.tractions) answer.scene = normal_contact_of(std::move(answer.scene));
  answer.exact = find_oracle(read.tractions ? scene : answer.scene);
  answer.solution = describe_given(answer.scene, read.fields);
  const std::string off = solver::violated_bounds(answer.solution.certificate, kSameLoads);
  if (read.tractions && !off.empty()) {
    answer.solution.status = solver::Status::not_converged;
    answer.solution.message = off + ": no answer to these loads, although " + program.name + " returned it";
  }
  if (!own.converged.value_or(true)) {
    answer.solution.status = solver::Status::not_converged;
    answer.solution.message = own.message.empty() ? program.name + " says that it did not converge" : own.message;
  }
  const double said = own.seconds.value_or(wall);
  const double seconds = said >= 0.0 && said <= wall ? said : wall;
  answer.solution.seconds = {.traction = seconds, .total = seconds};
  answer.solution.iterations = static_cast<int>(std::clamp(own.iterations.value_or(0.0), 0.0, kMaxIterations));
  answer.program = {.name = program.name,
                    .file = program.file.string(),
                    .version = allowed.version ? *allowed.version : version_of(program, allowed.tied_by),
                    .fields = read.tractions ? "pressure and tractions" : "pressure",
                    .wall_seconds = wall,
                    .cpu_seconds = end.cpu_seconds,
                    .own = own};
  return answer;
}

}  // namespace slipstick::convergence
