#include "solver/input/whole_file.hpp"

#include <fcntl.h>
#include <fmt/core.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <map>
#include <memory>
#include <set>
#include <system_error>
#include <utility>

#include "solver/input/input_error.hpp"

namespace slipstick::solver {
namespace {

namespace fs = std::filesystem;

/// Bytes of a file's name that its draft's name begins with: a name has 255 at most.
constexpr std::size_t kLongestStem = 200;
/// The system follows as many links.
constexpr int kMaxLinks = 40;

[[noreturn]] void refuse(const fs::path& file, int error) { throw InputError(file.string(), why_not_written(error)); }

/// For the result of a call of the system, which says why in errno.
void require(bool done) {
  if (!done) throw std::system_error(errno == 0 ? EIO : errno, std::generic_category());
}

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : "."; }

/// Writes to an open file and closes it; then the system has all, or the disk.
void fill(int descriptor, const fs::path& name, const WriteNamed& write, bool to_disk) {
  require(descriptor >= 0);
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(fdopen(descriptor, "wb"), std::fclose);
  if (!stream) close(descriptor);
  require(stream != nullptr);
  write(stream.get(), name);
  require(std::ferror(stream.get()) == 0 && std::fflush(stream.get()) == 0);
  if (to_disk) require(fsync(fileno(stream.get())) == 0);
  require(std::fclose(stream.release()) == 0);
}

/// A draft in the file's folder that is renamed to the file or deleted. Its writer holds a lock on it, so
/// that another writer reuses only the draft of a killed writer.
class Draft {
 public:
  explicit Draft(const fs::path& file) {
    for (int number = 0; descriptor_ < 0; ++number) {
      path_ = folder_of(file) /
              fmt::format("{}.slipstick.part-{}", file.filename().string().substr(0, kLongestStem), number);
      lock();
    }
    require(ftruncate(descriptor_, 0) == 0);
  }
  ~Draft() {
    if (!path_.empty()) unlink(path_.c_str());
    close(descriptor_);
  }
  Draft(const Draft&) = delete;
  Draft& operator=(const Draft&) = delete;

  int descriptor() const { return descriptor_; }
  const fs::path& path() const { return path_; }

  void replace(const fs::path& file) {
    require(std::rename(path_.c_str(), file.c_str()) == 0);
    path_.clear();
    // The name goes to the disk too, where the file system can do that.
    const int folder = open(folder_of(file).c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (folder < 0) return;
    fsync(folder);
    close(folder);
  }

 private:
  /// Opens the draft, unless another process writes it. A new one is free where the file system has no locks.
  void lock() {
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    const bool is_new = descriptor_ >= 0;
    require(is_new || errno == EEXIST);
    if (!is_new) descriptor_ = open(path_.c_str(), O_WRONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor_ < 0) return;
    const bool locked = flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
    struct stat open_one {
    }, named{};
    const bool own = locked ? fstat(descriptor_, &open_one) == 0 && stat(path_.c_str(), &named) == 0 &&
                                  open_one.st_ino == named.st_ino && S_ISREG(named.st_mode)
                            : is_new && errno != EWOULDBLOCK;
    if (!own) close(std::exchange(descriptor_, -1));
  }

  fs::path path_;
  int descriptor_ = -1;
};

/// Permissions of an old file can be kept, its owner cannot.
void replace(const fs::path& file, const WriteNamed& write, const struct stat* old) {
  Draft draft(file);
  if (old != nullptr) fchmod(draft.descriptor(), old->st_mode & 07777);
  fill(fcntl(draft.descriptor(), F_DUPFD_CLOEXEC, 0), draft.path(), write, true);
  draft.replace(file);
}

WriteNamed put(std::string_view content) {
  return [=](std::FILE* stream, const fs::path&) { std::fwrite(content.data(), 1, content.size(), stream); };
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
  static const std::map<std::string_view, std::set<int>> remedies{
      {"make room there, or name another place", {ENOSPC, EDQUOT, EFBIG}},
      {"allow it, or name another place", {EACCES, EPERM, EROFS}},
      {"make its folder, or name another place", {ENOENT, ENOTDIR}},
      {"allow more open files (ulimit -n)", {EMFILE, ENFILE}},
      {"name a file in that folder", {EISDIR}}};
  const auto found = std::ranges::find_if(remedies, [&](const auto& remedy) { return remedy.second.contains(error); });
  const std::string_view advice = found == remedies.end() ? "name another place" : found->first;
  return fmt::format("cannot be written: {}; {}", std::generic_category().message(error), advice);
}

void write_whole_named_file(const fs::path& file, const WriteNamed& write) {
  try {
    const fs::path target = behind_links(file);
    struct stat old {};
    const bool exists = stat(target.c_str(), &old) == 0;
    if (exists && !S_ISREG(old.st_mode)) return fill(open(target.c_str(), O_WRONLY | O_CLOEXEC), target, write, false);
    replace(target, write, exists ? &old : nullptr);
  } catch (const std::system_error& error) {
    refuse(file, error.code().value());
  }
}

void write_whole_file(const fs::path& file, std::string_view content) { write_whole_named_file(file, put(content)); }

void replace_whole_file(const fs::path& file, std::string_view content) {
  try {
    replace(file, put(content), nullptr);
  } catch (const std::system_error& error) {
    refuse(file, error.code().value());
  }
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
