// Any text is compared with itself as a benchmark's timings or is refused.

#include "bench/compare/comparison.hpp"
#include "bench/compare/comparison_report.hpp"
#include "solver/input/tests/fuzz_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace slipstick;
  solver::read_or_refuse([&] {
    const bench::Timings timings =
        bench::parse_timings(std::string(solver::text_of(bytes, size)), "new.json");
    const bench::ComparisonReport report{"base.json", "new.json", {}, bench::compare({timings, timings}), {}};
    bench::comparison_text(report);
    bench::comparison_markdown(report);
    bench::comparison_junit(report);
    bench::comparison_json(report);
  });
  return 0;
}
