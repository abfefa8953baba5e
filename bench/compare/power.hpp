#pragma once

#include <cstddef>
#include <span>

namespace slipstick::bench {

/// The rules by which a benchmark is found slower.
struct Search {
  double effect = 0.0;  ///< smallest change that counts; found is what is estimated to be as large
  double level = 0.0;   ///< and significant at this level, by one benchmark
  /// Repetitions, over those of the first run, of a second one that must find it too; 0: there is none. Where
  /// there is one, it alone has to be significant.
  std::size_t second_run = 0;
};

/// The smallest ratio of times that is found nine times in ten by repetitions that scatter as these
/// logarithms do, once their medians are taken off: drawn from them with replacement (Efron 1979), with a
/// fixed seed, and tested as compare() does. Infinite where so few can show nothing; NaN without two of each.
double smallest_found(std::span<const double> base, std::span<const double> now, bool paired,
                      const Search& search);

}  // namespace slipstick::bench
