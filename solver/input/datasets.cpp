#include "solver/input/datasets.hpp"

#include <fmt/ranges.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <sstream>
#include <system_error>

#include "cmake/loaded_library.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"
#include "solver/input/whole_file.hpp"

namespace slipstick::solver {
namespace {

namespace fs = std::filesystem;

/// Where each dataset's values lie in a file.
using Offsets = std::vector<off_t>;

constexpr std::size_t kNames = std::size_t{1} << 16;  ///< bytes of a file for names and their tree

[[noreturn]] void fail(int error) { throw std::system_error(error, std::generic_category()); }

/// Flushes to the disk and returns errno; 0: success.
int error_of(std::FILE* file) {
  const bool done = std::ferror(file) == 0 && std::fflush(file) == 0 && fsync(fileno(file)) == 0;
  return done ? 0 : (errno != 0 ? errno : EIO);
}

/// HDF5 opens a file by its name, so the name must still belong to this file.
void require_name(std::FILE* file, const fs::path& name) {
  struct stat open_one {
  }, named{};
  if (fstat(fileno(file), &open_one) != 0 || !S_ISREG(open_one.st_mode)) fail(ESPIPE);
  if (stat(name.c_str(), &named) != 0 || named.st_ino != open_one.st_ino) fail(ENOENT);
}

/// Allocates the space for names first: HDF5 keeps data that it could not write and crashes when the process ends.
Offsets lay_out(std::FILE* file, const fs::path& name, const std::vector<LongDataset>& contents) {
  require_name(file, name);
  const std::string room(kNames, '\0');
  std::fwrite(room.data(), 1, room.size(), file);
  if (const int error = error_of(file)) fail(error);
  std::vector<DatasetLayout> layouts;
  for (const LongDataset& content : contents) layouts.push_back(content.layout);
  return hdf5_library(name).lay_out(name, layouts);
}

/// This rank's part of all datasets.
void write_values(std::FILE* file, const Offsets& offsets, const std::vector<LongDataset>& contents) {
  for (std::size_t k = 0; k < contents.size(); ++k) {
    const auto before = static_cast<off_t>(contents[k].first * contents[k].layout.bytes_of_value());
    if (fseeko(file, offsets[k] + before, SEEK_SET) != 0) fail(errno);
    contents[k].write([&](const void* bytes, std::size_t count) { std::fwrite(bytes, 1, count, file); });
  }
  if (const int error = error_of(file)) fail(error);
}

/// Whether all ranks have done their part: an error of the system that one of them has met; 0: none.
int first_error(int own, const Ranks& ranks) {
  for (const double error : ranks.of_each(own)) {
    if (error != 0.0) return static_cast<int>(error);
  }
  return 0;
}

/// This rank's part of a draft that the first one has laid out; its error. what: the offsets, and its name.
int write_into(const std::string& what, const std::vector<LongDataset>& contents) {
  if (what.empty()) return 0;
  std::istringstream text(what);
  Offsets offsets(contents.size());
  for (off_t& offset : offsets) text >> offset;
  std::string draft;
  std::getline(text.ignore(), draft, '\0');
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(draft.c_str(), "r+b"), std::fclose);
  if (!file) return errno;
  try {
    write_values(file.get(), offsets, contents);
  } catch (const std::system_error& error) {
    return error.code().value();
  }
  return 0;
}

void write_shared(const fs::path& path, const std::vector<LongDataset>& contents, const Ranks& ranks) {
  if (!ranks.first()) {
    first_error(write_into(ranks.of_first({}), contents), ranks);
    return;
  }
  bool begun = false;
  try {
    write_whole_named_file(path, [&](std::FILE* file, const fs::path& draft) {
      const Offsets offsets = lay_out(file, draft, contents);
      begun = true;
      const std::string what = ranks.of_first(fmt::format("{} {}", fmt::join(offsets, " "), draft.string()));
      if (const int error = first_error(write_into(what, contents), ranks)) fail(error);
    });
  } catch (...) {
    if (!begun) {
      ranks.of_first({});
      first_error(0, ranks);
    }
    throw;
  }
}

/// Here too: the library crashes over a file that it may not make so large.
void require_room(const fs::path& path, const std::vector<LongDataset>& contents) {
  std::size_t bytes = kNames;
  for (const LongDataset& content : contents) bytes += content.layout.size * content.layout.bytes_of_value();
  rlimit most{};
  if (getrlimit(RLIMIT_FSIZE, &most) == 0 && most.rlim_cur != RLIM_INFINITY && bytes > most.rlim_cur) {
    throw InputError(path.string(), why_not_written(EFBIG));
  }
}

}  // namespace

const Hdf5Library& hdf5_library(const std::filesystem::path& file) {
  try {
    static const Hdf5Library& library = *loaded_library<const Hdf5Library>("slipstick_hdf5");
    return library;
  } catch (const std::runtime_error& error) {
    throw InputError(file.string(), fmt::format("HDF5 files are read and written by a library that cannot be "
                                                "opened: {}; allowed: install it, or another format",
                                                error.what()));
  }
}

std::vector<Dataset> read_datasets(const std::filesystem::path& file, const std::vector<std::string>& names, int rank,
                                   Eigen::Index most) {
  require_input_file(file, kLargestHdf5, "an HDF5 file");
  return hdf5_library(file).read(file, names, rank, most);
}

void write_datasets(const fs::path& file, const std::vector<Column>& columns, const std::vector<NamedText>& texts) {
  std::vector<LongDataset> datasets;
  const auto add = [&](const DatasetLayout& layout, const void* values) {
    const std::size_t bytes = layout.size * layout.bytes_of_value();
    datasets.push_back({layout, 0, [=](const PutBytes& put) { put(values, bytes); }});
  };
  for (const Column& column : columns) {
    add({column.name, false, static_cast<std::size_t>(column.values.size())}, column.values.data());
  }
  for (const NamedText& text : texts) add({text.name, true, text.text.size()}, text.text.data());
  write_datasets(file, datasets);
}

void write_datasets(const fs::path& file, const std::vector<LongDataset>& datasets, const Ranks& ranks) {
  hdf5_library(file);
  require_room(file, datasets);
  if (ranks.several()) return write_shared(file, datasets, ranks);
  write_whole_named_file(file, [&](std::FILE* stream, const fs::path& draft) {
    write_values(stream, lay_out(stream, draft, datasets), datasets);
  });
}

}  // namespace slipstick::solver
