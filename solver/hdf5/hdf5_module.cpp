#include <fmt/ranges.h>
#include <hdf5.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <set>
#include <system_error>

#include "solver/input/datasets.hpp"
#include "solver/input/input_error.hpp"
#include "solver/input/input_file.hpp"

/// libslipstick_hdf5: all that calls HDF5.
namespace slipstick::solver {
namespace {

using Eigen::Index;
using std::filesystem::path;

/// Bytes of the widest floating-point format in use.
constexpr std::size_t kWidestNumber = 16;
using Extent = std::array<Index, 2>;
/// A file of more datasets and groups is not searched to its end.
constexpr std::size_t kMaxNames = 100'000;

/// An id of the HDF5 library, closed at the end.
class Id {
 public:
  Id(hid_t id, herr_t (*close)(hid_t), const std::string& complaint) : id_(id), close_(close) {
    if (id < 0) throw std::runtime_error(complaint);
  }
  ~Id() { close_(id_); }
  Id(const Id&) = delete;
  Id& operator=(const Id&) = delete;
  hid_t get() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void require(bool good, const std::string& complaint) {
  if (!good) throw std::runtime_error(complaint);
}

/// Throws for a link, which may lead to another file.
void require_own_dataset(hid_t file, const std::string& name) {
  H5L_info_t link{};
  for (std::size_t end = 0; end != std::string::npos;) {
    end = name.find('/', end + 1);
    const std::string part = name.substr(0, end);
    require(H5Lexists(file, part.c_str(), H5P_DEFAULT) > 0, "no such dataset");
    require(H5Lget_info(file, part.c_str(), &link, H5P_DEFAULT) >= 0 && link.type == H5L_TYPE_HARD,
            "is a link; allowed: a dataset of this file");
  }
}

/// "GROUP/" of the one group that has all of these names; nothing where the root has the first.
std::string find_group(hid_t file, const std::vector<std::string>& names) {
  if (names[0].find('/') != std::string::npos || H5Lexists(file, names[0].c_str(), H5P_DEFAULT) > 0) return "";
  std::set<std::string> links;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* to) {
    auto& found = *static_cast<std::set<std::string>*>(to);
    found.insert(name);
    return found.size() < kMaxNames ? 0 : 1;
  };
  H5Lvisit(file, H5_INDEX_NAME, H5_ITER_INC, add, &links);
  std::vector<std::string> groups;
  for (const std::string& link : links) {
    if (!link.ends_with("/" + names[0])) continue;
    const std::string group = link.substr(0, link.size() - names[0].size());
    if (std::ranges::all_of(names, [&](const std::string& name) { return links.contains(group + name); }))
      groups.push_back(group);
  }
  require(!groups.empty(), fmt::format("no such dataset; the file has: {}; check takes other paths by --columns",
                                       shown(fmt::format("{}", fmt::join(links, ", ")))));
  require(groups.size() == 1,
          fmt::format("several groups have one: {}; allowed: --columns with the paths", fmt::join(groups, ", ")));
  return groups[0];
}

/// Throws for data that lie outside the file or are put together from other files.
void require_own_data(hid_t dataset) {
  const Id creation(H5Dget_create_plist(dataset), H5Pclose, "cannot be read");
  const H5D_layout_t layout = H5Pget_layout(creation.get());
  require((layout == H5D_COMPACT || layout == H5D_CONTIGUOUS || layout == H5D_CHUNKED) &&
              H5Pget_external_count(creation.get()) == 0,
          "has its data elsewhere; allowed: data in this file");
}

void require_numbers(hid_t dataset) {
  const Id type(H5Dget_type(dataset), H5Tclose, "cannot be read");
  const H5T_class_t kind = H5Tget_class(type.get());
  const std::size_t size = H5Tget_size(type.get());
  require((kind == H5T_INTEGER || kind == H5T_FLOAT) && size > 0 && size <= kWidestNumber,
          "holds no numbers; allowed: whole or floating-point numbers");
}

Extent find_extent(hid_t dataset, int rank, Index most) {
  const Id space(H5Dget_space(dataset), H5Sclose, "cannot be read");
  const int found = H5Sget_simple_extent_ndims(space.get());
  const bool fits = rank == kTableRank ? found == 1 || found == 2 : found == rank;
  require(fits, fmt::format("has {} dimensions; allowed: {}", found,
                            rank == kTableRank ? "1 or 2" : fmt::format("{}", rank)));
  std::array<hsize_t, 2> size{1, 1};
  require(H5Sget_simple_extent_dims(space.get(), size.data(), nullptr) == found, "cannot be read");
  const auto limit = static_cast<hsize_t>(most);
  require(size[0] > 0 && size[1] > 0 && size[0] <= limit && size[1] <= limit / size[0],
          fmt::format("has {} x {} values; allowed: from 1 to {} in all", size[0], size[1], most));
  return {static_cast<Index>(size[0]), static_cast<Index>(size[1])};
}

Dataset read_dataset(hid_t file, const std::string& name, int rank, Index most) {
  require_own_dataset(file, name);
  const Id dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "is no dataset");
  require_numbers(dataset.get());
  require_own_data(dataset.get());
  const Extent extent = find_extent(dataset.get(), rank, most);
  Dataset values(extent[0], extent[1]);
  require(H5Dread(dataset.get(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
          "cannot be read as numbers");
  return values;
}

/// Names the file if the HDF5 library crashes during its lifetime, since the library does not withstand
/// malicious files. The process then ends with the program's exit code for bad input.
class CrashMessage {
 public:
  explicit CrashMessage(const path& file) {
    text = fmt::format("slipstick: {}: is damaged: the HDF5 library does not survive reading it\n",
                       printable(file.string()));
    struct sigaction say {};
    say.sa_handler = [](int) {
      constexpr int kBadInput = 2;
      [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
      _exit(kBadInput);
    };
    for (std::size_t i = 0; i < kCrashes.size(); ++i) sigaction(kCrashes[i], &say, &before_[i]);
  }
  ~CrashMessage() {
    for (std::size_t i = 0; i < kCrashes.size(); ++i) sigaction(kCrashes[i], &before_[i], nullptr);
  }
  CrashMessage(const CrashMessage&) = delete;
  CrashMessage& operator=(const CrashMessage&) = delete;

 private:
  static constexpr std::array kCrashes{SIGSEGV, SIGBUS, SIGFPE, SIGABRT};
  static inline std::string text;  // made before: a handler of signals may not allocate
  std::array<struct sigaction, kCrashes.size()> before_{};
};

std::vector<Dataset> read(const path& file, const std::vector<std::string>& names, int rank, Index most) {
  const CrashMessage crash(file);
  std::vector<Dataset> datasets;
  std::string at;
  try {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // the library's own messages stay off the terminal
    const Id hdf5(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose, "cannot be read as HDF5");
    at = fmt::format("dataset {}: ", names[0]);
    const std::string group = rank == kTableRank ? find_group(hdf5.get(), names) : "";
    for (const std::string& name : names) {
      at = fmt::format("dataset {}: ", name);
      datasets.push_back(read_dataset(hdf5.get(), group + name, rank, most));
    }
  } catch (const std::runtime_error& error) {
    throw InputError(file.string(), at + error.what());
  }
  return datasets;
}

constexpr const char* kNotLaidOut = "HDF5 refuses to lay a file out";

off_t add_dataset(hid_t file, const DatasetLayout& layout) {
  const auto length = static_cast<hsize_t>(layout.size);
  const hid_t type = layout.is_text ? H5T_NATIVE_UCHAR : H5T_NATIVE_DOUBLE;
  const Id space(H5Screate_simple(1, &length, nullptr), H5Sclose, kNotLaidOut);
  const Id creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, kNotLaidOut);
  H5Pset_obj_track_times(creation.get(), false);  // the same numbers, the same bytes
  H5Pset_alloc_time(creation.get(), H5D_ALLOC_TIME_EARLY);
  H5Pset_fill_time(creation.get(), H5D_FILL_TIME_NEVER);
  const Id dataset(H5Dcreate2(file, layout.name.c_str(), type, space.get(), H5P_DEFAULT, creation.get(), H5P_DEFAULT),
                   H5Dclose, kNotLaidOut);
  return layout.size > 0 ? static_cast<off_t>(H5Dget_offset(dataset.get())) : 0;
}

/// HDF5 lays the file out and writes only names: values are holes.
std::vector<off_t> lay_out(const path& file, const std::vector<DatasetLayout>& datasets) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // the library's own messages stay off the terminal
  const Id access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, kNotLaidOut);
  H5Pset_file_locking(access.get(), false, true);  // it is locked already
  const Id laid_out(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.get()), H5Fclose, kNotLaidOut);
  std::vector<off_t> offsets;
  for (const DatasetLayout& dataset : datasets) offsets.push_back(add_dataset(laid_out.get(), dataset));
  if (H5Fflush(laid_out.get(), H5F_SCOPE_LOCAL) < 0) throw std::system_error(EIO, std::generic_category());
  return offsets;
}

constexpr Hdf5Library kLibrary{.read = read, .lay_out = lay_out};

}  // namespace

extern "C" [[gnu::visibility("default")]] const Hdf5Library* slipstick_hdf5() { return &kLibrary; }

}  // namespace slipstick::solver
