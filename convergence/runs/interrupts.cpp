#include "convergence/runs/interrupts.hpp"

namespace slipstick::convergence {
namespace {

constexpr std::array kInterrupts{SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t interrupted = 0;

}  // namespace

Interrupts::Interrupts() {
  interrupted = 0;
  for (std::size_t i = 0; i < kInterrupts.size(); ++i) {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupted = 1; };  // no SA_RESTART: waiting ends
    sigaction(kInterrupts[i], nullptr, &before_[i]);
    if (before_[i].sa_handler != SIG_IGN) sigaction(kInterrupts[i], &action, nullptr);
  }
}

Interrupts::~Interrupts() {
  for (std::size_t i = 0; i < kInterrupts.size(); ++i) sigaction(kInterrupts[i], &before_[i], nullptr);
}

bool Interrupts::seen() { return interrupted != 0; }

}  // namespace slipstick::convergence
