#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

#include "convergence/results/result_parts.hpp"
#include "convergence/system/machine.hpp"

namespace slipstick::convergence {

/// Finished results on disk, one file each, so that an interrupted command computes none twice. A result
/// counts as finished if the same program computed it from the same cache key, which holds everything that it
/// depends on, and if its file is unchanged. Several processes may share a folder: they keep equal results.
class ResultCache {
 public:
  /// program: the executable that computes, by its content: a copy on another machine is the same one. Throws
  /// InputError for a folder that cannot be made.
  explicit ResultCache(std::filesystem::path folder, const std::filesystem::path& program = own_program());

  /// The result of a name (its file's name without ending), if it is on disk. beside: a file that belongs to
  /// the result, and must be unchanged since; empty: none.
  std::optional<Json> find(const std::string& name, const std::string& cache_key,
                           const std::filesystem::path& beside = {}) const;

  /// Throws InputError if the result cannot be written.
  void keep(const std::string& name, const std::string& cache_key, const Json& result,
            const std::filesystem::path& beside = {}) const;

 private:
  std::filesystem::path file(const std::string& name) const { return folder_ / (name + ".json"); }

  std::filesystem::path folder_;
  std::string program_;  ///< identifies the executable
};

/// A non-cryptographic checksum: Fowler, Noll and Vo's hash (FNV-1a, 64 bits). of_before: the checksum of the
/// preceding bytes.
std::uint64_t checksum(std::string_view bytes, std::uint64_t of_before = 14695981039346656037ULL);

/// A checksum of eight bytes at once; it differs from checksum() of the bytes.
std::uint64_t checksum_of_word(std::uint64_t word, std::uint64_t of_before);

/// A file by its content, the same for every copy of it.
std::string file_identity(const std::filesystem::path& file);

}  // namespace slipstick::convergence
