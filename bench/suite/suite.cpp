#include "bench/suite/suite.hpp"

#include <exception>
#include <utility>

namespace slipstick::bench {

benchmark::internal::Benchmark* Suite::add(const std::string& name, Prepare prepare) {
  entries_.push_back({name, std::move(prepare)});
  const Entry& entry = entries_.back();
  // Google Benchmark owns what it makes here, which the analyzer cannot see.
  return benchmark::RegisterBenchmark(  // NOLINT(clang-analyzer-cplusplus.NewDeleteLeaks)
             name.c_str(), [this, &entry](benchmark::State& state) { run(state, entry); })
      ->Unit(benchmark::kMicrosecond);
}

void Suite::run(benchmark::State& state, const Entry& entry) {
  if (&entry != latest_) {
    prepared_ = {};  // before the next one takes memory
    latest_ = &entry;
    try {
      prepared_ = entry.prepare();
    } catch (const std::exception& exception) {
      prepared_.invalid_reason = exception.what();
    }
  }
  for (const auto& [counter, value] : prepared_.counters) state.counters[counter] = value;
  if (!prepared_.invalid_reason.empty()) return state.SkipWithError(prepared_.invalid_reason.c_str());
  prepared_.timing(state);
}

}  // namespace slipstick::bench
