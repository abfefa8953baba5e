#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "solver/input/field_file.hpp"

namespace slipstick::solver {

/// A text under a name.
struct NamedText {
  std::string name;
  std::string text;
};

/// Numbers under a name, worked out when they are written: write() fills in `size` of them.
struct LongDataset {
  std::string name;
  Index size;
  std::function<void(double* values)> write;
};

/// Writes an HDF5 file of 1-D datasets, each of its own length: numbers, and texts as their bytes. It is
/// written as write_whole_file() does, and the same content gives the same bytes. Throws InputError where it
/// cannot be written.
void write_datasets(const std::filesystem::path& file, const std::vector<Column>& columns,
                    const std::vector<NamedText>& texts = {});
/// Likewise, holding one of them at a time beside the file.
void write_datasets(const std::filesystem::path& file, const std::vector<LongDataset>& datasets);

}  // namespace slipstick::solver
