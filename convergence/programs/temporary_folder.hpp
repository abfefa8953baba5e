#pragma once

#include <stdlib.h>

#include <cerrno>
#include <filesystem>
#include <string>
#include <system_error>

#include "convergence/system/run_program.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::convergence {

/// A folder that the destructor removes. A shell removes it if this process is killed: the shell runs in
/// another session, which no signal to the process's group reaches, and waits for the end of its input.
class TemporaryFolder {
 public:
  TemporaryFolder()
      : path_(make()), remover_({"setsid", "sh", "-c", "read -r end; rm -rf -- \"$0\"", path_}, {.fed = true}) {}
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  std::filesystem::path operator/(const char* file) const { return path_ / file; }

 private:
  static std::string make() {
    std::error_code error;
    const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
    if (error) {
      throw solver::InputError("TMPDIR", "names no folder for temporary files (" + error.message() +
                                             "); allowed: one that is there, or none, for /tmp");
    }
    std::string name = folder / "slipstick-XXXXXX";
    if (mkdtemp(name.data()) == nullptr) throw solver::InputError(name, solver::why_not_written(errno));
    return name;
  }

  std::filesystem::path path_;
  Program remover_;
};

}  // namespace slipstick::convergence
