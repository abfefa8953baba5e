#include "convergence/runs/memory_option.hpp"

#include <CLI/CLI.hpp>

namespace slipstick::convergence {

void MemoryOption::add_to(CLI::App& command) {
  constexpr bool kThousands = true;  // as 1 kB = 1000 bytes has it; 1 KiB = 1024 bytes
  command
      .add_option("--memory-limit", bytes_,
                  "most memory that solving may take, e.g. 500MB, 4GiB, or bytes: what would take more is "
                  "refused; left out: what the machine has left")
      ->transform(CLI::AsSizeValue(kThousands).description(""))
      ->transform([](std::string size) {  // called first
        if (size.starts_with('-')) throw CLI::ValidationError("allowed: bytes above zero, as 500MB or 4GiB");
        return size;
      })
      ->type_name("SIZE");
}

std::optional<double> MemoryOption::limit() const {
  return bytes_ ? std::optional(static_cast<double>(*bytes_)) : std::nullopt;
}

}  // namespace slipstick::convergence
