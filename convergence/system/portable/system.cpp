#include <stdexcept>

#include "convergence/system/machine.hpp"
#include "convergence/system/run_program.hpp"

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNone = "this build starts no other programs (SLIPSTICK_PORTABLE)";

/// The first word of the command line, set by die_with_parent(); empty before.
fs::path& named_program() {
  static fs::path program;
  return program;
}

}  // namespace

fs::path own_program() { return own_program_file(); }

fs::path own_program_file() {
  std::error_code error;
  return fs::is_regular_file(named_program(), error) ? fs::absolute(named_program()) : fs::path();
}

std::string processor_name() { return "unknown"; }

bool starts_programs() { return false; }

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
