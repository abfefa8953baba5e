#pragma once

#include <array>
#include <csignal>

namespace slipstick::convergence {

/// What asks a program to end, SIGINT, SIGTERM and SIGHUP, is noted for as long as this lives; what was
/// ignored before, as under nohup, stays so. For the program's commands: a library leaves signals to its
/// host.
class Interrupts {
 public:
  Interrupts();
  ~Interrupts();
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  /// Whether any has come.
  static bool seen();

 private:
  std::array<struct sigaction, 3> before_{};
};

}  // namespace slipstick::convergence
