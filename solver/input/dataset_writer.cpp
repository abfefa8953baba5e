#include "solver/input/dataset_writer.hpp"

#include <fmt/core.h>
#include <hdf5.h>

#include <stdexcept>

#include "solver/input/whole_file.hpp"

namespace slipstick::solver {
namespace {

/// A handle of the library.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id_ < 0) throw std::runtime_error("HDF5 refuses to make a file in memory");
  }
  ~Handle() { close_(id_); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void add_dataset(hid_t file, const std::string& name, hid_t type, const void* values, std::size_t size) {
  const auto length = static_cast<hsize_t>(size);
  const Handle space(H5Screate_simple(1, &length, nullptr), H5Sclose);
  const Handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);  // the same numbers, the same bytes
  const Handle dataset(H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT),
                       H5Dclose);
  if (H5Dwrite(dataset, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) < 0) {
    throw std::runtime_error(fmt::format("dataset {}: HDF5 cannot write it", name));
  }
}

constexpr std::size_t kNames = std::size_t{1} << 16;  ///< bytes of a file beside values: names and their tree

/// Makes an HDF5 file of about so many bytes in memory and writes it from there: a disk that is full is no
/// matter of the library's, which keeps what it could not write and crashes over it when the process ends.
void write_hdf5(const std::filesystem::path& path, std::size_t size,
                const std::function<void(hid_t file)>& add_datasets) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // the library's own messages stay off the terminal
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, kNames + size, false);
  const Handle file(H5Fcreate("fields", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  add_datasets(file);
  H5Fflush(file, H5F_SCOPE_LOCAL);
  const ssize_t bytes = H5Fget_file_image(file, nullptr, 0);
  void* place = nullptr;  // of the pointer to the bytes
  if (bytes <= 0 || H5Fget_vfd_handle(file, access, &place) < 0 || place == nullptr) {
    throw std::runtime_error("HDF5 gives no image of a file in memory");
  }
  write_whole_file(path, {*static_cast<char**>(place), static_cast<std::size_t>(bytes)});
}

std::size_t bytes_of(Index values) { return static_cast<std::size_t>(values) * sizeof(double); }

}  // namespace

void write_datasets(const std::filesystem::path& file, const std::vector<Column>& columns,
                    const std::vector<NamedText>& texts) {
  std::size_t size = 0;
  for (const Column& column : columns) size += bytes_of(column.values.size());
  for (const NamedText& text : texts) size += text.text.size();
  write_hdf5(file, size, [&](hid_t to) {
    for (const Column& column : columns) {
      add_dataset(to, column.name, H5T_NATIVE_DOUBLE, column.values.data(),
                  static_cast<std::size_t>(column.values.size()));
    }
    for (const NamedText& text : texts) {
      add_dataset(to, text.name, H5T_NATIVE_UCHAR, text.text.data(), text.text.size());
    }
  });
}

void write_datasets(const std::filesystem::path& file, const std::vector<LongDataset>& datasets) {
  std::size_t size = 0;
  for (const LongDataset& dataset : datasets) size += bytes_of(dataset.size);
  write_hdf5(file, size, [&](hid_t to) {
    for (const LongDataset& dataset : datasets) {
      Eigen::ArrayXd values(dataset.size);
      dataset.write(values.data());
      add_dataset(to, dataset.name, H5T_NATIVE_DOUBLE, values.data(), static_cast<std::size_t>(dataset.size));
    }
  });
}

}  // namespace slipstick::solver
