#include "convergence/stresses/stress_volume.hpp"

#include <fmt/ranges.h>
#include <sys/types.h>

#include <algorithm>
#include <bit>
#include <cstdint>

#include "solver/input/input_error.hpp"

namespace slipstick::convergence {
namespace {

using solver::Index;

template <typename Values>
void print_coordinates(std::FILE* stream, const char* name, const Values& values) {
  fmt::print(stream, "<DataArray type=\"Float64\" Name=\"{}\" format=\"ascii\">{:.17g}</DataArray>\n", name,
             fmt::join(values, " "));
}

/// All but the stresses, which follow: of each name its size in bytes, and the values.
void print_header(std::FILE* stream, const solver::Grid& grid, const std::vector<double>& ascending,
                  std::uint64_t bytes) {
  const std::string extent = fmt::format("0 {} 0 {} 0 {}", grid.n1 - 1, grid.n2 - 1, ascending.size() - 1);
  fmt::print(stream,
             "<?xml version=\"1.0\"?>\n<VTKFile type=\"RectilinearGrid\" version=\"1.0\" byte_order=\"{}\" "
             "header_type=\"UInt64\">\n<RectilinearGrid WholeExtent=\"{}\">\n<Piece Extent=\"{}\">\n<PointData>\n",
             std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian", extent, extent);
  for (std::size_t a = 0; a < kStressNames.size(); ++a) {
    fmt::print(stream, "<DataArray type=\"Float32\" Name=\"{}\" format=\"appended\" offset=\"{}\"/>\n", kStressNames[a],
               a * (sizeof bytes + bytes));
  }
  std::vector<double> x1;
  std::vector<double> x2;
  for (Index i = 0; i < grid.n1; ++i) x1.push_back(grid.x1(i));
  for (Index j = 0; j < grid.n2; ++j) x2.push_back(grid.x2(j));
  fmt::print(stream, "</PointData>\n<Coordinates>\n");
  print_coordinates(stream, "x1", x1);
  print_coordinates(stream, "x2", x2);
  print_coordinates(stream, "x3", ascending);
  fmt::print(stream, "</Coordinates>\n</Piece>\n</RectilinearGrid>\n<AppendedData encoding=\"raw\">\n_");
}

}  // namespace

void write_stress_volume(std::FILE* stream, const std::string& file, const solver::Grid& grid,
                         const std::vector<double>& depths,
                         const std::function<solver::StressPlane(double depth)>& plane) {
  std::vector<double> ascending = depths;
  std::ranges::sort(ascending);
  const auto cells = static_cast<std::uint64_t>(grid.cells());
  const std::uint64_t bytes = cells * depths.size() * sizeof(float);
  print_header(stream, grid, ascending, bytes);
  const auto start = static_cast<std::uint64_t>(ftello(stream));
  const auto put = [&](std::uint64_t place, const void* data, std::size_t size) {
    if (fseeko(stream, static_cast<off_t>(start + place), SEEK_SET) != 0)
      throw solver::InputError("--stresses " + file, "allowed for a volume: a file, no pipe");
    std::fwrite(data, 1, size, stream);
  };
  for (std::size_t a = 0; a < kStressNames.size(); ++a) put(a * (sizeof bytes + bytes), &bytes, sizeof bytes);
  for (const double depth : depths) {
    const auto number = static_cast<std::uint64_t>(std::ranges::lower_bound(ascending, depth) - ascending.begin());
    const solver::StressPlane at = plane(depth);
    for (std::size_t a = 0; a < kStressNames.size(); ++a) {
      const Eigen::ArrayXd stress = a < at.stress.size() ? at.stress[a] : solver::von_mises(at.stress);
      // VTK's x runs fastest, this project's x2 does.
      const Eigen::ArrayXXf by_x1 =
          Eigen::Map<const Eigen::ArrayXXd>(stress.data(), grid.n2, grid.n1).transpose().cast<float>();
      put(a * (sizeof bytes + bytes) + sizeof bytes + number * cells * sizeof(float), by_x1.data(),
          cells * sizeof(float));
    }
  }
  put(kStressNames.size() * (sizeof bytes + bytes), "\n", 1);
  fmt::print(stream, "</AppendedData>\n</VTKFile>\n");
}

}  // namespace slipstick::convergence
