#pragma once

#include <limits>
#include <string>
#include <vector>

namespace slipstick::convergence {

/// A quantity on one mesh, or on several grids of about the same cell size that lie differently under the
/// contact.
struct MeshSample {
  double size;          ///< cell size; only ratios matter
  double value;         ///< the quantity itself, or its signed error; mean over the grids
  double spread = 0.0;  ///< standard deviation from grid to grid, of one grid
  int grids = 1;
  double noise = 0.0;  ///< bound of the errors by iteration and rounding
};

/// A missing number.
inline constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// The probability that all intervals hold, and that below the upper end of a two-sided one.
inline constexpr double kConfidence = 0.95;
inline constexpr double kBothSides = 0.5 * (1.0 + kConfidence);

/// The verdict on a sequence of meshes.
enum class OrderVerdict { asymptotic, preasymptotic, superconvergent, oscillatory, floor, too_few };
std::string to_string(OrderVerdict verdict);

/// The samples that are numbers with a noise that is one, of at least one grid, coarsest first.
struct MeshSequence {
  std::vector<MeshSample> meshes;
  std::string left_out;  ///< which samples are none; empty where all are
};

/// Throws std::invalid_argument for a size that is not positive and for one given twice.
MeshSequence coarsest_first(const std::vector<MeshSample>& samples);

/// Three values are the fewest that a limit, a factor and an order can be determined from.
inline constexpr std::size_t kMinMeshes = 3;

/// An error, or the distance of two values, is distinguished from its noise where it is this many times as
/// large: a tenth of it then moves an order between meshes of twice the size by 0.15.
inline constexpr double kAboveNoise = 10.0;

/// Standard errors that a mean is believed to: 95 % of a normal distribution.
inline constexpr double kBelievedScatter = 2.0;

/// Standard error of the mean over the grids.
double standard_error(const MeshSample& sample);

/// Bound of the distance of a value from the converged mean of its mesh: noise, and scatter of the mean.
double uncertainty(const MeshSample& sample);

/// Up to here an error of the sample cannot be distinguished from zero.
double resolution(const MeshSample& sample);

/// Whether the numbers, in the order of the meshes, go up and then down or down and then up by more than the
/// meshes' resolution.
bool is_non_monotone(const std::vector<MeshSample>& meshes);

}  // namespace slipstick::convergence
