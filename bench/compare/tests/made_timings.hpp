#pragma once

#include <fmt/core.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <vector>

#include "bench/compare/comparison.hpp"
#include "bench/timing/timings.hpp"

/// Timings with a known answer, by seeded draws.
namespace slipstick::bench {

inline TimingContext quiet_machine() {
  TimingContext context;
  context.host_name = "somewhere";
  context.cpus = 8;
  context.mhz = 3000.0;
  context.caches = "[]";
  context.load_average = 0.3;
  context.library_build_type = "release";
  return context;
}

/// One benchmark with these times in seconds, all of them the processor's.
inline TimedBenchmark timed(const std::string& name, const std::vector<double>& seconds) {
  TimedBenchmark benchmark;
  benchmark.name = name;
  for (const double time : seconds) benchmark.timings.push_back({.real = time, .cpu = time});
  return benchmark;
}

inline Timings file_of(const std::string& file, const std::vector<TimedBenchmark>& benchmarks) {
  return {.file = file, .context = quiet_machine(), .benchmarks = benchmarks};
}

/// Evenly spread by a percent around a time; of two seeds, times differ but not their spread.
inline TimedBenchmark steady(const std::string& name, double seconds, std::size_t repetitions, int seed) {
  std::mt19937_64 generator(static_cast<std::uint64_t>(seed));
  std::uniform_real_distribution<double> spread(0.995, 1.005);
  std::vector<double> times(repetitions);
  for (double& time : times) time = seconds * spread(generator);
  return timed(name, times);
}

/// How times scatter on real machines: lognormal, now and then a third longer, and slowly changing speed that
/// two builds run in turn share.
struct Noise {
  double scatter = 0.03;
  double outliers = 0.05;  ///< as a part of all repetitions
  double outlier = 1.3;
  double drift = 0.0;  ///< of the speed, from one repetition to the next
};

/// Two files of equal benchmarks, but that the first `slower` ones take `factor` times as long in the new
/// one.
inline TwoTimings draw(std::mt19937_64& generator, std::size_t benchmarks, std::size_t repetitions,
                       bool paired, const Noise& noise, std::size_t slower = 0, double factor = 1.0) {
  std::normal_distribution<double> normal;
  std::bernoulli_distribution is_outlier(noise.outliers);
  const auto disturbed = [&](double seconds) {
    return seconds * std::exp(noise.scatter * normal(generator)) *
           (is_outlier(generator) ? noise.outlier : 1.0);
  };
  TwoTimings run{file_of("base.json", {}), file_of("new.json", {})};
  if (paired) run.base.context.session = run.now.context.session = "one";
  for (std::size_t b = 0; b < benchmarks; ++b) {
    std::vector<double> before(repetitions);
    std::vector<double> after(repetitions);
    double speed = 1.0;
    for (std::size_t i = 0; i < repetitions; ++i) {
      speed *= std::exp(noise.drift * normal(generator));
      before[i] = disturbed(1e-3 * speed);
      after[i] = disturbed(1e-3 * speed * (b < slower ? factor : 1.0));
    }
    run.base.benchmarks.push_back(timed(fmt::format("operator/{}", b), before));
    run.now.benchmarks.push_back(timed(fmt::format("operator/{}", b), after));
  }
  return run;
}

}  // namespace slipstick::bench
