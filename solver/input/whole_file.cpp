#include "solver/input/whole_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <random>
#include <system_error>
#include <utility>

#include "solver/input/input_error.hpp"

namespace slipstick::solver {
namespace {

namespace fs = std::filesystem;

/// Between the name of a file and the digits that are its draft's own.
constexpr std::string_view kDraft = ".part-";
constexpr std::size_t kDigits = 8;
/// Bytes of a file's name that are in its draft's: the name may be as long as the system allows, 255.
constexpr std::size_t kLongestStem = 200;
/// As many links as the system follows.
constexpr int kMaxLinks = 40;
/// A draft is made again where another process took it for abandoned, as it may before it is locked.
constexpr int kMaxAttempts = 3;

[[noreturn]] void refuse(const fs::path& file, int error) {
  throw InputError(file.string(), why_not_written(error));
}

/// A failed call of the system, by its errno.
struct Failure {
  int error;
};

void require(bool done) {
  if (!done) throw Failure{errno == 0 ? EIO : errno};
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : "."; }

std::string stem_of_drafts(const fs::path& file) {
  return file.filename().string().substr(0, kLongestStem) + std::string(kDraft);
}

bool is_draft(const std::string& name, const std::string& stem) {
  return name.starts_with(stem) && name.size() == stem.size() + kDigits &&
         name.find_first_not_of("0123456789abcdef", stem.size()) == std::string::npos;
}

/// Who writes a draft has it locked, wherever that process runs: the system lets go when it ends. Numbers of
/// processes tell less: one that is dead has its own until its parent asks.
bool lock(int descriptor) { return flock(descriptor, LOCK_EX | LOCK_NB) == 0; }

void remove_abandoned_drafts(const fs::path& file) {
  std::error_code ignored;
  const std::string stem = stem_of_drafts(file);
  for (const auto& entry : fs::directory_iterator(folder_of(file), ignored)) {
    if (!is_draft(entry.path().filename(), stem)) continue;
    const int draft = open(entry.path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (draft < 0) continue;
    if (lock(draft)) unlink(entry.path().c_str());
    close(draft);
  }
}

/// A stream that is closed.
class Stream {
 public:
  explicit Stream(int descriptor) {
    require(descriptor >= 0);
    file_ = fdopen(descriptor, "wb");
    if (file_ == nullptr) close(descriptor);
    require(file_ != nullptr);
  }
  ~Stream() {
    if (file_ != nullptr) std::fclose(file_);
  }
  Stream(const Stream&) = delete;
  Stream& operator=(const Stream&) = delete;

  /// What `write` writes is with the system afterwards, or on the disk.
  void take(const std::function<void(std::FILE*)>& write, bool to_disk) {
    try {
      write(file_);
    } catch (const std::system_error& error) {  // as fmt::print() says it
      throw Failure{error.code().value()};
    }
    require(std::ferror(file_) == 0 && std::fflush(file_) == 0);
    if (to_disk) require(fsync(fileno(file_)) == 0);
    require(std::fclose(std::exchange(file_, nullptr)) == 0);
  }

 private:
  std::FILE* file_ = nullptr;
};

/// A draft that takes the place of a file, or goes.
class Draft {
 public:
  Draft(const fs::path& file, const struct stat* before) : file_(file) {
    std::random_device random;
    path_ = folder_of(file) / fmt::format("{}{:08x}", stem_of_drafts(file), random());
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    require(descriptor_ >= 0);
    lock(descriptor_);  // in vain where a file system knows none: there no draft is taken for abandoned
    // Where the old file is somebody else's, its permissions are what can be kept of it.
    if (before != nullptr) fchmod(descriptor_, before->st_mode & 07777);
  }
  ~Draft() {
    if (!path_.empty()) unlink(path_.c_str());
    if (descriptor_ >= 0) close(descriptor_);
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  void take(const std::function<void(std::FILE*)>& write) {
    Stream(fcntl(descriptor_, F_DUPFD_CLOEXEC, 0)).take(write, true);
  }

  void replace() {
    require(std::rename(path_.c_str(), file_.c_str()) == 0);
    path_.clear();
    // That the name is on the disk too, some file systems cannot say.
    const int folder = open(folder_of(file_).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    fsync(folder);
    close(folder);
  }

 private:
  const fs::path& file_;
  fs::path path_;
  int descriptor_ = -1;
};

void write_plain(const fs::path& file, const struct stat* before,
                 const std::function<void(std::FILE*)>& write) {
  remove_abandoned_drafts(file);
  for (int attempt = 1;; ++attempt) {
    try {
      Draft draft(file, before);
      draft.take(write);
      return draft.replace();
    } catch (const Failure& failure) {
      const bool again = failure.error == ENOENT && fs::exists(folder_of(file)) && attempt < kMaxAttempts;
      if (!again) throw;
    }
  }
}

}  // namespace

fs::path behind_links(fs::path file) {
  std::error_code error;
  for (int link = 0; link < kMaxLinks && fs::is_symlink(fs::symlink_status(file, error)); ++link) {
    if (fs::canonical(folder_of(file), error).string().starts_with("/proc/")) return file;
    file = folder_of(file) / fs::read_symlink(file, error);
  }
  return file;
}

std::string why_not_written(int error) {
  std::string_view advice = "name another place";
  switch (error) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      advice = "make room there, or name another place";
      break;
    case EACCES:
    case EPERM:
    case EROFS:
      advice = "allow it, or name another place";
      break;
    case ENOENT:
    case ENOTDIR:
      advice = "make its folder, or name another place";
      break;
    case EISDIR:
      advice = "name a file in that folder";
      break;
    default:
      break;
  }
  return fmt::format("cannot be written: {}; {}", std::generic_category().message(error), advice);
}

void write_whole_file(const fs::path& file, const std::function<void(std::FILE*)>& write) {
  try {
    const fs::path target = behind_links(file);
    struct stat before {};
    const bool exists = stat(target.c_str(), &before) == 0;
    if (!exists || S_ISREG(before.st_mode)) return write_plain(target, exists ? &before : nullptr, write);
    Stream(open(target.c_str(), O_WRONLY | O_CLOEXEC)).take(write, false);
  } catch (const Failure& failure) {
    refuse(file, failure.error);
  }
}

void write_whole_file(const fs::path& file, std::string_view content) {
  write_whole_file(file, [&](std::FILE* stream) { std::fwrite(content.data(), 1, content.size(), stream); });
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) refuse(folder, error.value());
}

void require_writable(const fs::path& folder) {
  if (access(folder.c_str(), W_OK) != 0) refuse(folder, errno);
}

void require_place_for(const fs::path& file) {
  std::error_code error;
  const fs::path target = behind_links(file);
  if (fs::is_directory(target, error)) refuse(file, EISDIR);
  if (fs::exists(target, error) && !fs::is_regular_file(target, error)) return;
  if (access(folder_of(target).c_str(), W_OK) != 0) refuse(file, errno);
}

}  // namespace slipstick::solver
