#include "convergence/system/machine.hpp"

#include "convergence/system/portable/command_line.hpp"

namespace slipstick::convergence {

namespace fs = std::filesystem;

fs::path& named_program() {
  static fs::path program;
  return program;
}

fs::path own_program() { return own_program_file(); }

fs::path own_program_file() {
  std::error_code error;
  return fs::is_regular_file(named_program(), error) ? fs::absolute(named_program()) : fs::path();
}

std::string processor_name() { return "unknown"; }

bool starts_programs() { return false; }

}  // namespace slipstick::convergence
