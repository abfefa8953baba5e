#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "convergence/results/solve_record.hpp"
#include "convergence/runs/run_spec.hpp"
#include "solver/input/setting_key.hpp"

/// Scenes that are hard to solve, by the hundred, and verdicts on the records of their solves. Distances are relative.
namespace slipstick::convergence {

/// One scene of a family, which varies some keys of a scene in all combinations.
struct HardCase {
  std::string family;
  std::string why;   ///< what makes the family hard
  std::string name;  ///< of the case: the varied values, joined with "-"
  RunSpec run;
};

/// Every key that a file of hard cases may have; read_hard_cases() reads by it.
const solver::SettingKeys& hard_keys();

/// The cases of a file (TOML): [[family]] tables with `name`, `why`, `scene`, a table `set` of keys of the scene, and
/// [[family.vary]] tables with `key` and `values`. Throws InputError naming file, key, value and what is allowed.
std::vector<HardCase> read_hard_cases(const std::filesystem::path& file);

/// Outcome of a hard case: solved, with a valid certificate and within its stated uncertainty of all that is
/// known; refused with a reason; not converged, with a message; or wrong, an answer that passes for right.
enum class HardVerdict { certified, refused, not_converged, wrong };
std::string to_string(HardVerdict verdict);

/// The numbers that a verdict rests on, and the work.
struct JudgedNumbers {
  Number operator_applications;
  Number pressure_applications;
  Number seconds;         ///< s
  Number slip_direction;  ///< mean angle to the reverse of traction, degrees
  std::optional<solver::Safeguards> safeguards;
  std::optional<Number> error;         ///< against the exact answer; this and the following of converged answers only
  std::optional<Number> uncertainty;   ///< as stated
  std::optional<Number> gap;           ///< certificate.gap
  std::optional<Number> finer_error;   ///< see MeshReference
  std::optional<Number> finer_change;  ///< see MeshReference
  std::optional<Number> difference;    ///< from another answer, see compare_answer()
};

struct JudgedCase {
  HardVerdict verdict = HardVerdict::wrong;
  std::string reason;                    ///< empty: certified
  std::optional<JudgedNumbers> numbers;  ///< none where nothing was solved
};

/// Judges a record by its status, its certificate, and its distance from the exact answer, if there is one.
JudgedCase judge_alone(const SolveRecord& record);

/// The size of the number whose uncertainty the record states; NaN where it is missing, zero, or uncertain by
/// rounding only.
double main_value(const SolveRecord& record);

/// A value compared with those on twice and four times the cells, with as many times the parts of each step.
struct MeshReference {
  double error;   ///< distance from the finest
  double change;  ///< distance of the finer two, an estimate of the finest one's own error
  bool holds;     ///< error <= stated uncertainty + change; an uncertainty of 100 % claims nothing
};
/// absolute: the stated uncertainty, in the value's unit.
MeshReference judge_by_finer(double value, double absolute, double twice, double four_times);

/// The largest distance between the numbers of a variant and of the scene itself, see transformed(); NaN
/// where one has a number that the other lacks.
double variant_difference(const SolveRecord& record, const SolveRecord& seen, Variant variant);

/// The allowed difference of equal problems in the twist, the moment and energies: 1e-6; near the limit,
/// where the twist grows like the logarithm of the missing part of the load, also tolerance / missing part.
double same_answer(const SolveRecord& record);

/// How another method's answer compares with a certified one to the same discrete problem: it agrees; it is
/// refused; it is not converged, with a message; it passes for converged with slip that does not oppose
/// traction, or with another answer.
enum class MethodVerdict { agrees, refused, not_converged, other_direction, other_answer };
std::string to_string(MethodVerdict verdict);

struct ComparedAnswer {
  MethodVerdict verdict = MethodVerdict::other_answer;
  std::string reason;                    ///< empty: it agrees
  std::optional<JudgedNumbers> numbers;  ///< none where nothing was solved
};

/// An answer agrees within 1 % of twist, moment and energy, that of another program also within the mesh's
/// uncertainty. Without a certified answer any other is other_answer.
ComparedAnswer compare_answer(const SolveRecord& certified, const SolveRecord& other);

}  // namespace slipstick::convergence
