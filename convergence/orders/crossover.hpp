#pragma once

#include <string>
#include <vector>

#include "convergence/orders/order.hpp"

/// Typical times, and the cells along a side from which on one way to compute overtakes another.
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
