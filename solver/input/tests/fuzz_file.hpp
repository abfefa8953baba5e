#pragma once

#include <stdlib.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

#include "solver/input/input_error.hpp"

/// Files and refusals for the fuzz targets.
namespace slipstick::solver {

/// The file that gets a fuzzer's bytes, for a reader to open, in a folder of its own that goes when this goes.
class FuzzFile {
 public:
  explicit FuzzFile(const std::string& name) {
    std::string folder = std::filesystem::temp_directory_path() / "slipstick-fuzz-XXXXXX";
    if (mkdtemp(folder.data()) == nullptr) throw std::runtime_error(folder + ": cannot be made");
    folder_ = folder;
    file_ = folder_ / name;
  }
  ~FuzzFile() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
  }
  FuzzFile(const FuzzFile&) = delete;
  FuzzFile& operator=(const FuzzFile&) = delete;

  const std::filesystem::path& write(std::string_view text) const {
    std::ofstream(file_, std::ios::binary) << text;
    return file_;
  }
  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path file_;
};

inline std::string_view text_of(const std::uint8_t* bytes, std::size_t size) {
  return {reinterpret_cast<const char*>(bytes), size};
}

/// Reads, and takes a refusal for an answer; whatever else comes out of it ends the fuzzer.
template <typename Read>
void read_or_refuse(const Read& read) {
  try {
    read();
  } catch (const InputError&) {
  }
}

}  // namespace slipstick::solver
