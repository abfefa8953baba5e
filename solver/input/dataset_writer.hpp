#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "solver/input/field_file.hpp"

namespace slipstick::solver {

/// A text under a name.
struct NamedText {
  std::string name;
  std::string text;
};

/// Writes an HDF5 file of 1-D datasets, each of its own length: numbers, and texts as their bytes. It is
/// written as write_whole_file() does, and the same content gives the same bytes. Throws InputError where it
/// cannot be written.
void write_datasets(const std::filesystem::path& file, const std::vector<Column>& columns,
                    const std::vector<NamedText>& texts = {});

}  // namespace slipstick::solver
