#pragma once

#include <string>
#include <vector>

#include "convergence/orders/mesh_sequence.hpp"

/// How times grow with the cells along a side, and where one way to compute overtakes another.
namespace slipstick::convergence {

/// The repetitions of a benchmark at one size. Repetitions without a positive number are ignored.
struct SizedSeconds {
  double cells;
  std::vector<double> seconds;
};

/// One benchmark at several sizes, smallest first.
using Family = std::vector<SizedSeconds>;

/// The median of repetitions with its 95 % interval: Student's, of their logarithms, widened as a median is
/// less certain than a mean. NaN: fewer than two repetitions.
struct TypicalSeconds {
  double seconds;
  double low;
  double high;
};
TypicalSeconds typical(const std::vector<double>& seconds);

/// Sizes that a law needs: two would fit any law.
inline constexpr std::size_t kMinSizes = 3;

/// t = constant cells^exponent, with the exponent's 95 % interval (Student's, from the residuals).
struct PowerLaw {
  double exponent;  ///< NaN where none was fitted
  double low;
  double high;
  double constant;
  std::vector<double> cells;  ///< the sizes that it was fitted to
  std::string why_not;        ///< empty: it was fitted
};

/// By least squares of logarithms over the asymptotic part: from an eighth of the largest size up, three
/// doublings, at least three sizes. Below, what each call costs whatever its size takes a part of the time.
PowerLaw fit_power_law(const Family& family);

/// Growth by theory. N: cells along a side. The logarithm is that of 2 N, the length that N is padded to.
enum class Growth { n2, n2_log_n, n4 };
std::string to_string(Growth growth);
double grown(Growth growth, double cells);

/// The cells from which on the quick family stays the quicker one, over the sizes that both have; between two
/// of them the ratio of times is a power of the cells.
struct Crossover {
  double cells;        ///< NaN where there is none within the sizes
  double low;          ///< of its 95 % interval; -infinity: below the smallest size too; NaN: unknown
  double high;         ///< infinity: above the largest size too
  std::string remark;  ///< why something of this is missing; empty: nothing is
};

/// The interval is that between the crossings of the ratios' 95 % limits at each size (see TypicalSeconds).
Crossover find_crossover(const Family& slow, const Family& quick);

}  // namespace slipstick::convergence
