#include "solver/model/memory.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#ifdef __GLIBC__
#include <malloc.h>
#include <sys/mman.h>
#include <sys/resource.h>

#include <bit>
#include <cstdint>
#include <cstdlib>
#endif

namespace slipstick::solver {
namespace {

namespace fs = std::filesystem;

/// The number behind a word that begins a line ("inactive_file 4096", "MemAvailable: 12 kB"), or infinity.
double number_behind(const fs::path& file, const std::string& word) {
  std::ifstream stream(file);
  std::string found;
  double number = 0.0;
  while (stream >> found) {
    if (found == word && stream >> number) return number;
    stream.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return INFINITY;
}

/// The number that a file holds; infinity where it holds a word, "max", or is missing.
double number_in(const fs::path& file) {
  std::ifstream stream(file);
  double number = 0.0;
  return stream >> number ? number : INFINITY;
}

/// The names that two versions of control groups have for the same.
struct GroupFiles {
  const char* limit;
  const char* used;
  const char* dropped;  ///< in memory.stat: copies of files, which give way
};
constexpr GroupFiles kVersion1{"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"};
constexpr GroupFiles kVersion2{"memory.max", "memory.current", "inactive_file"};

/// Bytes that a group and the groups around it leave free. A container sees the folders of the groups around
/// it, not the one of its own group.
double left_by_groups(const fs::path& mount, fs::path group, const GroupFiles& files) {
  double least = INFINITY;
  for (;; group = group.parent_path()) {
    const fs::path folder = mount / group.relative_path();
    const double limit = number_in(folder / files.limit);
    const double used = number_in(folder / files.used);
    const double dropped = number_behind(folder / "memory.stat", files.dropped);
    if (std::isfinite(limit) && std::isfinite(used)) {
      least = std::min(least, limit - used + (std::isfinite(dropped) ? dropped : 0.0));
    }
    if (!group.has_relative_path()) return least;
  }
}

}  // namespace

double available_memory(const fs::path& root) {
  constexpr double kKilobyte = 1024.0;
  double least = kKilobyte * number_behind(root / "proc/meminfo", "MemAvailable:");
  std::ifstream groups(root / "proc/self/cgroup");  // lines "4:memory:/path", and "0::/path" of version 2
  for (std::string line; std::getline(groups, line);) {
    const auto first = line.find(':');
    const auto second = line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const fs::path group = line.substr(second + 1);
    const fs::path mount = root / "sys/fs/cgroup";
    if (controllers == ",,") least = std::min(least, left_by_groups(mount, group, kVersion2));
    if (controllers.find(",memory,") != std::string::npos) {
      least = std::min(least, left_by_groups(mount / "memory", group, kVersion1));
    }
  }
  return std::max(least, 0.0);
}

void prepare_heap() {
#ifdef __GLIBC__
  constexpr int kLargestInHeap = 16 << 20;
  constexpr std::uintptr_t kHeap = 512 << 20;
  constexpr std::uintptr_t kPage = 2 << 20;
  mallopt(M_TRIM_THRESHOLD, -1);  // the heap never shrinks
  const auto is_unlimited = [](auto resource) {
    rlimit limit{};
    return getrlimit(resource, &limit) == 0 && limit.rlim_cur == RLIM_INFINITY;
  };
  if (is_unlimited(RLIMIT_AS) && is_unlimited(RLIMIT_DATA)) {
    mallopt(M_MMAP_MAX, 0);
    if (void* heap = std::malloc(kHeap)) {
      const auto start = (std::bit_cast<std::uintptr_t>(heap) + kPage - 1) & ~(kPage - 1);
      madvise(std::bit_cast<void*>(start), kHeap - kPage, MADV_HUGEPAGE);
      std::free(heap);
    }
    mallopt(M_MMAP_MAX, std::numeric_limits<int>::max());
  }
  mallopt(M_MMAP_THRESHOLD, kLargestInHeap);
#endif
}

std::string bytes_text(double bytes) {
  return bytes < 0x1p30 ? fmt::format("{:.3g} MiB", bytes / 0x1p20) : fmt::format("{:.3g} GiB", bytes / 0x1p30);
}

double memory_within(std::optional<double> limit) { return limit ? *limit : available_memory(); }

}  // namespace slipstick::solver
