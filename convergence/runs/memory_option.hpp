#pragma once

#include <cstdint>
#include <optional>

namespace CLI {
class App;
}

namespace slipstick::convergence {

/// --memory-limit, as all commands that solve have it.
class MemoryOption {
 public:
  void add_to(CLI::App& command);
  /// Bytes; none where it was not given.
  std::optional<double> limit() const;

 private:
  std::optional<std::uint64_t> bytes_;
};

}  // namespace slipstick::convergence
