// What FFTW's plans for the tangential operator take to make: estimated, measured, and measured before, from
// wisdom. What measured plans are worth is application/dcfft_measured beside application/dcfft.

#include <cstdlib>
#include <memory>
#include <string>

#include "bench/suite/suite.hpp"
#include "solver/fft/padded_transform.hpp"

namespace slipstick::bench {
namespace {

using solver::Index;

void plan(Index cells, unsigned flags) {
  constexpr std::size_t kFields = 2;
  benchmark::DoNotOptimize(solver::PaddedTransform<double>({cells, cells, 1.0, 1.0}, kFields, 1, flags));
}

/// What planning such a transform has taught FFTW.
std::string wisdom_of(Index cells) {
  fftw_forget_wisdom();
  plan(cells, FFTW_MEASURE);
  const std::unique_ptr<char, decltype(&std::free)> text(fftw_export_wisdom_to_string(), std::free);
  fftw_forget_wisdom();
  return text.get();
}

/// FFTW learns nothing from one iteration to the next.
Prepared planning(Index cells, unsigned flags) {
  return {.timing = repeated([cells, flags] {
            plan(cells, flags);
            fftw_forget_wisdom();
          })};
}

Prepared planning_with_wisdom(Index cells) {
  const std::string wisdom = wisdom_of(cells);
  const bool usable = fftw_import_wisdom_from_string(wisdom.c_str()) != 0;
  fftw_forget_wisdom();
  return {.counters = {{"wisdom_bytes", static_cast<double>(wisdom.size())}},
          .invalid_reason = usable ? "" : "FFTW does not read the wisdom that it wrote",
          .timing = repeated([cells, wisdom] {
            fftw_import_wisdom_from_string(wisdom.c_str());
            plan(cells, FFTW_MEASURE);
            fftw_forget_wisdom();
          })};
}

}  // namespace

void add_planning_benchmarks(Suite& suite) {
  for (const Index cells : {64, 128, 256, 512, 1024}) {
    const std::string size = "/cells:" + std::to_string(cells);
    suite.add("planning/estimate" + size, [cells] { return planning(cells, FFTW_ESTIMATE); });
    suite.add("planning/measure" + size, [cells] { return planning(cells, FFTW_MEASURE); });
    suite.add("planning/wisdom" + size, [cells] { return planning_with_wisdom(cells); });
  }
}

}  // namespace slipstick::bench
