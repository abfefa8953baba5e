#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "convergence/hard/hard_case.hpp"
#include "convergence/results/result_parts.hpp"
#include "convergence/runs/process_pool.hpp"
#include "convergence/runs/variant.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

/// What solves each scene too: a name, and the override of the scene's keys that asks for it.
struct BesideMethod {
  std::string name;
  std::string override;
  bool is_program = false;
};
/// A word of solver.method, or the file of a program (TOML). Throws InputError for what is neither.
BesideMethod read_beside_method(const std::string& word);

struct HardOptions {
  bool variants = true;                    ///< each scene is seen otherwise too
  bool finer_meshes = true;                ///< those without an exact answer are solved on finer meshes too
  std::vector<BesideMethod> methods = {};  ///< to be compared with the first answer
  /// Gets a file of fields for each case that is solved; empty: none.
  std::filesystem::path fields = {};
};

/// Solves and judges. Rows in the order of the cases, counts by family and verdict:
/// docs/schema/hard.schema.json. An answer is wrong too where the same contact seen otherwise has another
/// one.
Json run_hard_cases(const std::vector<HardCase>& cases, const HardOptions& options, const ProcessPool& pool);

/// For a person: counts of each family, then what is wrong or did not converge, with the command that
/// repeats it.
std::string hard_text(const Json& result);

// ---------------------------------------------------------------- verdicts (hard_judgement.cpp)

/// How a hard case ends: solved, with a certificate and as near to what is known as it says; refused with a
/// reason; not converged, and said so; or wrong: an answer that passes for right.
enum class HardVerdict { certified, refused, not_converged, wrong };
std::string to_string(HardVerdict verdict);

struct JudgedCase {
  HardVerdict verdict;
  std::string reason;  ///< of all but certified
  Json numbers;        ///< what the verdict rests on
};

/// A result by itself: its status, its certificate, and its distance from the exact answer, if there is one.
JudgedCase judge_alone(const Json& result);

/// The size of the number that a result's uncertainty is of; NaN where it is missing, zero, or
/// open to nothing but rounding.
double main_value(const Json& result);

/// A value beside those on twice and four times the cells, with as many times the parts of each step.
struct MeshReference {
  double error;   ///< from the finest, relative to that
  double change;  ///< between the finer two, likewise: how far the finest may be off itself
  bool holds;     ///< the error is within what is stated and the change; 100 % claims nothing
};
/// absolute: the stated uncertainty, in the value's unit.
MeshReference judge_by_finer(double value, double absolute, double twice, double four_times);

/// Two answers to one discrete problem: how far one seen otherwise is from the first, relative; NaN where a
/// number is missing.
double variant_difference(const Json& result, const Json& seen, Variant variant);

/// How far equal problems may differ in the twist, the moment and energies: 1e-6, and next to the limit the
/// tolerance over the part of the load that is missing to it, since the twist grows like the logarithm of
/// that part.
double same_answer(const Json& result);

/// How another method's answer stands beside a certified one to the same discrete problem: it agrees, or it
/// is refused, or not converged and says so; or it calls itself converged with slip that does not oppose
/// traction, or with another answer.
enum class MethodVerdict { agrees, refused, not_converged, other_direction, other_answer };
std::string to_string(MethodVerdict verdict);

struct ComparedAnswer {
  MethodVerdict verdict;
  std::string reason;  ///< of all but those that agree
  Json numbers;        ///< what the verdict rests on, with the work; empty where nothing was solved
};

/// `certified` and `other` are results of `solve`. An answer agrees within 1 % of twist, moment and energy,
/// that of another program within what the mesh leaves open, too.
/// Without a certified answer any other is another one.
ComparedAnswer compare_answer(const Json& certified, const Json& other);

}  // namespace slipstick::convergence
