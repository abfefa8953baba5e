#pragma once

#include <functional>
#include <iosfwd>
#include <nlohmann/json_fwd.hpp>

namespace CLI {
class App;
}

namespace slipstick::bench {

/// Adds `bench`: times everything beside the error that it buys and draws it; or two builds or two methods
/// against each other. The returned function runs it, see main.cpp; the result is timings in Google
/// Benchmark's JSON.
std::function<int(std::ostream&, nlohmann::ordered_json&)> add_bench_command(CLI::App& app);

}  // namespace slipstick::bench
