#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bench/plane/plane_design.hpp"
#include "convergence/results/result_parts.hpp"

/// The speed-error plane: what each choice of method, operator, model, pressure, mesh and
/// tolerance costs, and the error that it buys.
///
/// The result (JSON), times in seconds, errors relative:
///
///   quick
///   quantities       [{name: twist | traction_l1 | traction_l2 | stick_radius, label}]
///   application_seconds  of one application on the reference grid, the unit for other machines
///   scenes [
///     name, moment_ratio
///     points [        one a choice, in the design's order
///       method, operator, model, pressure, cells, tolerance      the choice
///       contact_cells   cells across the contact, mean over the grids
///       not_timed       why there is no time: the result is wrong; absent where there is one
///       seconds {median, low, high, repetitions}    whole solve, one thread; null where not timed
///       error {twist, traction_l1, traction_l2, stick_radius}   root mean square over the grids; null (with
///                       NAME_reason) where a number is missing
///       errors {the same: [signed, of each grid]}
///       gap, applications, pressure_applications, bytes         of the first grid, the one that is timed
///     ]
///     exact {seconds {...}, error, cells}   the exact side: stick radius, twist and tractions in all cells
///     envelope {QUANTITY: [indices into points, quickest first]}   the exact side not among them
///     time_to [{quantity, error, method, point (index) | null, reason, seconds}]  method also "any", "exact"
///   ]
///   dominated [{scene, quantity, key, value, by, everywhere, from_cells, times_slower {median, low, high},
///               points, text}]
///   not_timed [{scene, choice, reason}]
///   provenance
namespace slipstick::bench {

using convergence::Json;

struct PlaneOptions {
  std::filesystem::path scene;   ///< the paper's, whose loads and choices are set
  std::filesystem::path output;  ///< folder that keeps finished points: the same command goes on from there
  bool quick = false;
  std::function<void(const std::string& point)> progress = {};  ///< called after each point
};

/// Measures the plane, points one after the other in this process. Throws InputError for a scene that cannot
/// be read or has no exact answer.
Json measure_plane(const PlaneOptions& options);

/// Points that plane holds.
std::size_t plane_size(bool quick);

/// One moment ratio's points, those that are in the output folder from there, and the exact side.
Json measure_scene(const PlaneOptions& options, double moment_ratio, const std::vector<PlaneChoice>& design);

/// One point: errors on several grids, seconds on the first, unless the result is wrong.
Json measure_point(const std::filesystem::path& scene, double moment_ratio, const PlaneChoice& choice);

/// Envelopes, dominated choices and times to errors of the measured points, put into the result.
void judge_plane(Json& plane);

/// The same for a person.
std::string plane_text(const Json& plane);
/// The least times to errors alone.
std::string times_text(const Json& plane);

}  // namespace slipstick::bench
