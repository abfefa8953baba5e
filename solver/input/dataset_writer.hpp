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

/// Numbers under a name, worked out when they are written. Each rank has a part of them, in pieces.
struct LongDataset {
  std::string name;
  Index size;    ///< of the parts of all ranks
  Index first;   ///< of this rank's part
  Index pieces;  ///< of this rank's part
  std::function<std::vector<double>(Index number)> piece;
};

/// Writes an HDF5 file of 1-D datasets, each of its own length: numbers, and texts as their bytes. It is
/// written as write_whole_file() does, and the same content gives the same bytes. Throws InputError where it
/// cannot be written.
void write_datasets(const std::filesystem::path& file, const std::vector<Column>& columns,
                    const std::vector<NamedText>& texts = {});
/// Writes long datasets piece by piece. All ranks call it and write their parts into one file on a shared
/// file system. If any rank cannot write, the first rank throws.
void write_datasets(const std::filesystem::path& file, const std::vector<LongDataset>& datasets,
                    const Ranks& ranks = {});

}  // namespace slipstick::solver
