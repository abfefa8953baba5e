#include "solver/fft/wisdom.hpp"

#include <fftw3.h>
#include <fmt/core.h>
#include <unistd.h>

#include <cstdlib>
#include <memory>
#include <utility>

#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/input/run_apart.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::solver {
namespace {

namespace fs = std::filesystem;

void forget() {
  fftw_forget_wisdom();
  fftwf_forget_wisdom();
}

/// As the file has it: of double precision, then of single precision.
std::string known() {
  const auto text = [](char* exported) {
    return std::string(std::unique_ptr<char, decltype(&std::free)>(exported, std::free).get());
  };
  return text(fftw_export_wisdom_to_string()) + "\n" + text(fftwf_export_wisdom_to_string()) + "\n";
}

/// Over some damaged files FFTW ends the process: so another one tries first.
bool import(const fs::path& file) {
  const std::string text = read_input_file(file, kLargestSettings, "a file of FFTW's wisdom");
  const std::size_t single = text.find("(fftw-", 1);
  if (single == std::string::npos) return false;
  const auto import_text = [&] {
    return fftw_import_wisdom_from_string(text.substr(0, single).c_str()) == 1 &&
           fftwf_import_wisdom_from_string(text.substr(single).c_str()) == 1;
  };
  const std::string tried = run_apart(
      [&](const Send& send) {
        if (import_text()) send("+", 1);
      },
      1);
  return !tried.empty() && import_text();
}

[[noreturn]] void fail(const fs::path& file, const std::string& complaint) {
  throw InputError(
      file.string(),
      fmt::format("{}; allowed for solver.wisdom: what {} wrote on such a processor, or the name of "
                  "a new file in a folder that can be written to",
                  complaint, fftw_version));
}

}  // namespace

Wisdom::Wisdom(fs::path file) : file_(std::move(file)) {
  const fs::path folder = file_.has_parent_path() ? file_.parent_path() : fs::path(".");
  if (access(folder.c_str(), W_OK) != 0)
    fail(file_, "stands in a folder that is missing or cannot be written to");
  forget();
  if (fs::exists(file_)) {
    if (!import(file_)) {
      forget();
      fail(file_, "holds no plans of this FFTW");
    }
    read_ = known();
  }
}

Wisdom::~Wisdom() { forget(); }

bool Wisdom::save() const {
  const std::string text = known();
  if (text == read_) return true;
  try {
    write_whole_file(file_, text);
  } catch (const InputError&) {
    return false;
  }
  return true;
}

}  // namespace slipstick::solver
