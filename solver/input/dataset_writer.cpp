#include "solver/input/dataset_writer.hpp"

#include <fmt/core.h>
#include <hdf5.h>

#include <algorithm>
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

/// The bytes of an HDF5 file, made in memory: a disk that is full is no matter of the library's, which keeps
/// what it could not write and crashes over it when the process ends.
std::vector<char> hdf5_image(const std::vector<Column>& columns, const std::vector<NamedText>& texts) {
  std::size_t size = std::size_t{1} << 16;      // beside the values, for names and their tree
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // the library's own messages stay off the terminal
  for (const Column& column : columns)
    size += static_cast<std::size_t>(column.values.size()) * sizeof(double);
  for (const NamedText& text : texts) size += text.text.size();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_fapl_core(access, size, false);
  const Handle file(H5Fcreate("fields", H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose);
  for (const Column& column : columns) {
    add_dataset(file, column.name, H5T_NATIVE_DOUBLE, column.values.data(),
                static_cast<std::size_t>(column.values.size()));
  }
  for (const NamedText& text : texts) {
    add_dataset(file, text.name, H5T_NATIVE_UCHAR, text.text.data(), text.text.size());
  }
  H5Fflush(file, H5F_SCOPE_LOCAL);
  std::vector<char> image(
      static_cast<std::size_t>(std::max<ssize_t>(H5Fget_file_image(file, nullptr, 0), 0)));
  if (image.empty() || H5Fget_file_image(file, image.data(), image.size()) < 0) {
    throw std::runtime_error("HDF5 gives no image of a file in memory");
  }
  return image;
}

}  // namespace

void write_datasets(const std::filesystem::path& file, const std::vector<Column>& columns,
                    const std::vector<NamedText>& texts) {
  const std::vector<char> image = hdf5_image(columns, texts);
  write_whole_file(file, {image.data(), image.size()});
}

}  // namespace slipstick::solver
