#include "tests/bench/map_generator_file.hpp"

#include <array>
#include <fstream>
#include <map>
#include <stdexcept>
#include <string>

#include "segmenter/io/ply/ply_reader.hpp"

namespace kintsugi::segmenter::bench {
namespace {

template <typename T>
std::vector<T> read_values(std::ifstream& in, std::size_t count,
                           const std::filesystem::path& file) {
  std::vector<T> values(count);
  const auto bytes = static_cast<std::streamsize>(count * sizeof(T));
  if (!in.read(reinterpret_cast<char*>(values.data()), bytes)) {
    throw std::runtime_error(file.string() + ": ends early, expected " + std::to_string(count) +
                             " more values of " + std::to_string(sizeof(T)) + " bytes");
  }
  return values;
}

Slices read_bin(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(file.string() + ": cannot be read");
  const std::uint64_t num_slices = read_values<std::uint64_t>(in, 1, file)[0];
  if (num_slices > std::filesystem::file_size(file) / sizeof(std::uint64_t)) {
    throw std::runtime_error(file.string() + ": cannot hold " + std::to_string(num_slices) +
                             " slices");
  }
  const auto first = read_values<std::uint64_t>(in, num_slices + 1, file);
  if (first.back() > std::filesystem::file_size(file) / (6 * sizeof(float))) {
    throw std::runtime_error(file.string() + ": cannot hold " + std::to_string(first.back()) +
                             " points");
  }
  Slices slices(num_slices);
  for (std::size_t s = 0; s < num_slices; ++s) {
    if (first[s + 1] < first[s]) throw std::runtime_error(file.string() + ": slices overlap");
    for (const auto& p : read_values<std::array<float, 6>>(in, first[s + 1] - first[s], file)) {
      slices[s].push_back(
          {.x = p[0], .y = p[1], .z = p[2], .nx = p[3], .ny = p[4], .nz = p[5], .weight = 1.0F});
    }
  }
  return slices;
}

Slices read_cloud(const std::filesystem::path& file) {
  const PlyCloud cloud = read_ply(file);
  if (!cloud.has_normals) throw std::runtime_error(file.string() + ": has no normals");
  std::map<std::int32_t, std::vector<CloudPoint>> by_id;
  for (std::size_t k = 0; k < cloud.points_W.size(); ++k) {
    by_id[cloud.slice_ids.empty() ? 0 : cloud.slice_ids[k]].push_back(cloud.points_W[k]);
  }
  Slices slices;
  for (auto& [id, points_W] : by_id) slices.push_back(std::move(points_W));
  return slices;
}

}  // namespace

Slices read_map(const std::filesystem::path& file) {
  return file.extension() == ".bin" ? read_bin(file) : read_cloud(file);
}

std::vector<CloudPoint> all_points(const Slices& slices) {
  std::vector<CloudPoint> points_W;
  for (const auto& slice : slices) points_W.insert(points_W.end(), slice.begin(), slice.end());
  return points_W;
}

}  // namespace kintsugi::segmenter::bench
