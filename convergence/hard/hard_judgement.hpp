#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "convergence/results/result_parts.hpp"
#include "convergence/runs/variant.hpp"
#include "solver/scene/scene.hpp"

namespace slipstick::convergence {

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
