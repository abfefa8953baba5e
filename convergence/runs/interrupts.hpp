#pragma once

#include <array>
#include <csignal>

namespace slipstick::convergence {

/// What asks a program to end, SIGINT, SIGTERM and SIGHUP, is noted for as long as this lives; what was
/// ignored before, as under nohup, stays so. For the program's commands: a library leaves signals to its
/// host.
class Interrupts {
 public:
  Interrupts() {
    interrupted = 0;
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = 1; };  // no SA_RESTART: waiting ends
    for (std::size_t i = 0; i < kSignals.size(); ++i) {
      sigaction(kSignals[i], nullptr, &before_[i]);
      if (before_[i].sa_handler != SIG_IGN) sigaction(kSignals[i], &action, nullptr);
    }
  }
  ~Interrupts() {
    for (std::size_t i = 0; i < kSignals.size(); ++i) sigaction(kSignals[i], &before_[i], nullptr);
  }
  Interrupts(const Interrupts&) = delete;
  Interrupts& operator=(const Interrupts&) = delete;

  /// Whether any has come.
  static bool seen() { return interrupted != 0; }

 private:
  static constexpr std::array kSignals{SIGINT, SIGTERM, SIGHUP};
  static inline volatile std::sig_atomic_t interrupted = 0;

  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace slipstick::convergence
