#pragma once

#include <filesystem>
#include <string>

namespace slipstick::solver {

/// What FFTW learns while it measures which plans are quickest, in both precisions, kept in a file from one
/// run to the next. It is one for the whole process: there may be one Wisdom at a time, which begins with
/// what its file holds, and afterwards FFTW knows nothing. For wisdom changes what is planned by estimate,
/// too.
class Wisdom {
 public:
  /// A file that does not exist holds nothing. Throws InputError for one that this build of FFTW did not
  /// write on such a processor, and for a place where none can be written.
  explicit Wisdom(std::filesystem::path file);
  ~Wisdom();
  Wisdom(const Wisdom&) = delete;
  Wisdom& operator=(const Wisdom&) = delete;

  /// Writes the file, unless it holds all that there is to know; whoever reads it meanwhile sees the old one
  /// or the new one. False where that failed.
  bool save() const;

 private:
  std::filesystem::path file_;
  std::string read_;  ///< what the file held
};

}  // namespace slipstick::solver
