#include "convergence/system/run_program.hpp"

#include <stdexcept>

#include "convergence/system/portable/command_line.hpp"

namespace slipstick::convergence {
namespace {

constexpr const char* kNone = "this build starts no other programs (SLIPSTICK_PORTABLE)";

}  // namespace

Program::Program(const std::vector<std::string>&, const ProgramOptions&) { throw std::runtime_error(kNone); }
Program::~Program() = default;
bool Program::read_on() { return true; }
void Program::feed(std::string_view) {}
void Program::close_descriptor(int&) {}
ProgramEnd Program::wait() { return end_; }
ProgramEnd Program::wait_at_most(double, std::size_t) { return end_; }

ProgramEnd run_program(const std::vector<std::string>&, const ProgramOptions&) {
  return {.started = false, .output = {}, .trouble = std::string("not started: ") + kNone};
}

void die_with_parent(int& argc, char**& argv) {
  if (argc > 0) named_program() = argv[0];
}

}  // namespace slipstick::convergence
