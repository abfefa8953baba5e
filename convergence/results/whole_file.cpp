#include "convergence/results/whole_file.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <fstream>
#include <stdexcept>
#include <string>
#include <system_error>

namespace slipstick::convergence {
namespace {

namespace fs = std::filesystem;

/// In the name of a draft, before the number of the process that writes it.
constexpr std::string_view kDraft = ".part";

[[noreturn]] void refuse(const fs::path& file) {
  throw std::runtime_error(fmt::format("{}: cannot be written", file.string()));
}

void write(const fs::path& file, std::ofstream& stream, std::string_view content) {
  stream << content;
  stream.close();
  if (!stream) refuse(file);
}

/// Whether a file is the draft of another, by a process that is gone.
bool is_abandoned_draft(const std::string& name, const std::string& of) {
  if (!name.starts_with(of + std::string(kDraft))) return false;
  const char* const number = name.data() + of.size() + kDraft.size();
  const char* const end = name.data() + name.size();
  pid_t writer = 0;
  const auto [read, error] = std::from_chars(number, end, writer);
  return error == std::errc() && read == end && writer > 0 && kill(writer, 0) != 0 && errno == ESRCH;
}

void remove_abandoned_drafts(const fs::path& file) {
  std::error_code ignored;
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  for (const auto& entry : fs::directory_iterator(folder, ignored)) {
    if (is_abandoned_draft(entry.path().filename(), file.filename())) fs::remove(entry.path(), ignored);
  }
}

}  // namespace

void write_whole_file(const fs::path& file, std::string_view content) {
  std::error_code error;
  const fs::file_status before = fs::symlink_status(file, error);
  const bool plain = !fs::exists(before) || fs::is_regular_file(before);
  if (plain) remove_abandoned_drafts(file);
  const fs::path draft = fmt::format("{}{}{}", file.string(), kDraft, getpid());
  std::ofstream stream;
  if (plain) stream.open(draft);
  if (!stream.is_open()) {
    stream.clear();
    stream.open(file);
    return write(file, stream, content);
  }
  try {
    write(file, stream, content);
    if (fs::exists(before)) fs::permissions(draft, before.permissions());
    fs::rename(draft, file);
  } catch (const std::exception&) {
    fs::remove(draft, error);
    refuse(file);
  }
}

}  // namespace slipstick::convergence
