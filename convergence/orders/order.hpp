#pragma once

#include <limits>
#include <string>
#include <vector>

namespace slipstick::convergence {

/// A quantity on one mesh, or on several grids of about the same cell size that lie differently under the contact.
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

/// p of error = C size^p with its 95 % confidence interval, and whether to believe it.
struct Order {
  double value;  ///< NaN where none was fitted
  double low;
  double high;
  double constant;  ///< C, signed: the error at size 1
  OrderVerdict verdict;
  std::string why;                 ///< one sentence, for a person
  std::vector<double> sizes = {};  ///< of the meshes that it was fitted to, coarsest first
};

/// How far an order may be from the expected one on meshes that one can afford, where the next term of the
/// error is still there.
inline constexpr double kOrderMargin = 0.1;

/// A wider interval, on either side of the order, does not distinguish whole orders.
inline constexpr double kWidestHalf = 0.5;

/// Least squares of log |error| against log size over the meshes whose error is distinguished from its noise
/// and scatter. errors: signed, in any order of the meshes. expected: the order that theory gives; NaN where
/// it gives none, and then the verdict is preasymptotic at best. The interval is Student's. Where all meshes
/// have several grids whose spread explains the residuals (chi squared, 95 %), it follows from the spread,
/// and meshes have weights by their spread; otherwise from the residuals, with equal weights. The effect of
/// the noise on the order is added. Throws as coarsest_first().
///
/// Verdict, the first that holds:
/// - too_few: fewer than three meshes have a number, or an error above noise;
/// - floor: the finest error is lost in noise or scatter, or has stopped falling;
/// - oscillatory: the sign changes, other than once before the three finest meshes (the meshes before that
///   take no part), or the size rises on one mesh and falls on another;
/// - preasymptotic: the order between the two finest meshes is not the order of all, to kOrderMargin, and a
///   curvature is significant at 95 % (or there are too few meshes to say);
/// - superconvergent: the interval lies above expected + kOrderMargin;
/// - preasymptotic: the interval is wider than kWidestHalf on a side, or ends below expected - kOrderMargin;
/// - asymptotic.
Order fit_order(const std::vector<MeshSample>& errors, double expected);

/// The sizes of meshes, in their order.
std::vector<double> sizes_of(const std::vector<MeshSample>& meshes);

/// No order, since fewer than kMinMeshes of the meshes that were asked for have a number.
Order order_of_few(const MeshSequence& found, std::size_t asked);

/// The verdict by the interval of a fitted order where nothing else speaks against it: superconvergent,
/// preasymptotic or asymptotic, with the reason.
Order judged_by_interval(Order order, double expected);

}  // namespace slipstick::convergence
