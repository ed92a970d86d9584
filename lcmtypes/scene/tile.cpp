#include "lcmtypes/scene/tile.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <numeric>
#include <unordered_map>

namespace kintsugi::scene {
namespace {

static_assert(std::endian::native == std::endian::little, "blocks are little-endian");

constexpr float kSteps = 65535.0F;
constexpr std::uint32_t kMagic = 0x314C544B;  // "KTL1"

void put_position(const CloudPoint& point_P, const TilePoints& tile, std::uint8_t* record) {
  const Eigen::Vector3f p_P(point_P.x, point_P.y, point_P.z);
  for (int axis = 0; axis < 3; ++axis, record += sizeof(std::uint16_t)) {
    const float size = tile.box_size_P[axis];
    const float share = size > 0.0F ? (p_P[axis] - tile.box_min_P[axis]) / size : 0.0F;
    // Not clamp(): that keeps a value that is not a number.
    const float bounded = share > 0.0F ? std::min(share, 1.0F) : 0.0F;
    const auto q = static_cast<std::uint16_t>(std::lround(bounded * kSteps));
    std::memcpy(record, &q, sizeof(q));
  }
}

/// The octahedral map: the sphere unfolded to a square of 255 x 255 steps.
void put_normal(const CloudPoint& point, std::uint8_t* record) {
  Eigen::Vector3f n(point.nx, point.ny, point.nz);
  const float length = n.lpNorm<1>();
  if (!(length > 0.5F && length < 4.0F)) {
    record[0] = record[1] = 255;
    return;
  }
  n /= length;
  float u = n.x();
  float v = n.y();
  if (n.z() < 0.0F) {
    u = std::copysign(1.0F - std::abs(n.y()), n.x());
    v = std::copysign(1.0F - std::abs(n.x()), n.y());
  }
  record[0] = static_cast<std::uint8_t>(std::lround((u + 1.0F) * 127.0F));
  record[1] = static_cast<std::uint8_t>(std::lround((v + 1.0F) * 127.0F));
}

Eigen::AlignedBox3f box_of(std::span<const CloudPoint> points_P) {
  Eigen::AlignedBox3f box_P;
  for (const CloudPoint& point : points_P) {
    const Eigen::Vector3f p_P(point.x, point.y, point.z);
    if (p_P.allFinite()) box_P.extend(p_P);
  }
  if (box_P.isEmpty()) box_P.extend(Eigen::Vector3f::Zero());
  return box_P;
}

template <class Value>
void append(std::string& out, const Value* values, std::size_t count) {
  if (count > 0) out.append(reinterpret_cast<const char*>(values), count * sizeof(Value));
}

void fill_up(std::string& out, std::size_t begin) {
  while ((out.size() - begin) % 4 != 0) out.push_back('\0');
}

}  // namespace

TileOrder::TileOrder(std::uint32_t count) : count_(std::max(count, 1U)) {
  constexpr double kGoldenRatio = 0.618033988749895;
  step_ = std::max<std::uint64_t>(
      1, static_cast<std::uint64_t>(std::lround(kGoldenRatio * static_cast<double>(count_))));
  while (std::gcd(step_, count_) != 1) ++step_;
}

Eigen::Vector3f TilePoints::position_P(std::uint32_t i) const {
  std::uint16_t q[3];
  std::memcpy(q, &records[i * kPointBytes], sizeof(q));
  const Eigen::Vector3f share(static_cast<float>(q[0]), static_cast<float>(q[1]),
                              static_cast<float>(q[2]));
  return box_min_P + (share / kSteps).cwiseProduct(box_size_P);
}

std::uint32_t TileLabels::label(std::uint32_t i) const {
  std::uint32_t index = 0;
  std::memcpy(&index, &indices[std::size_t{i} * index_bytes], index_bytes);
  return table[index];
}

TilePoints make_points(std::span<const CloudPoint> points_P, std::uint32_t revision) {
  TilePoints tile;
  tile.revision = revision;
  tile.count = static_cast<std::uint32_t>(points_P.size());
  const Eigen::AlignedBox3f box_P = box_of(points_P);
  tile.box_min_P = box_P.min();
  tile.box_size_P = box_P.sizes();
  tile.records.resize(points_P.size() * kPointBytes);
  const TileOrder order(tile.count);
  for (std::uint32_t i = 0; i < tile.count; ++i) {
    const CloudPoint& point = points_P[order(i)];
    std::uint8_t* const record = &tile.records[i * kPointBytes];
    put_position(point, tile, record);
    put_normal(point, record + 6);
    record[8] = point.red;
    record[9] = point.green;
    record[10] = point.blue;
  }
  return tile;
}

TileLabels make_labels(std::span<const std::uint32_t> segment_ids, std::uint32_t revision) {
  TileLabels tile;
  tile.revision = revision;
  const auto count = static_cast<std::uint32_t>(segment_ids.size());
  std::unordered_map<std::uint32_t, std::uint32_t> index_of;
  std::vector<std::uint32_t> indices(count);
  const TileOrder order(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t id = segment_ids[order(i)];
    const auto [entry, is_new] =
        index_of.try_emplace(id, static_cast<std::uint32_t>(tile.table.size()));
    if (is_new) tile.table.push_back(id);
    indices[i] = entry->second;
  }
  tile.index_bytes = tile.table.size() <= 256 ? 1 : tile.table.size() <= 65536 ? 2 : 4;
  tile.indices.resize(std::size_t{count} * tile.index_bytes);
  for (std::uint32_t i = 0; i < count; ++i) {
    std::memcpy(&tile.indices[std::size_t{i} * tile.index_bytes], &indices[i], tile.index_bytes);
  }
  return tile;
}

void append_block(const Tile& tile, std::uint32_t first, std::uint32_t count, bool with_points,
                  std::string& out) {
  const TilePoints& points = *tile.points;
  const TileLabels& labels = *tile.labels;
  first = std::min(first, points.count);
  count = std::min(count, points.count - first);
  const std::size_t begin = out.size();
  const std::uint32_t header[] = {kMagic,
                                  tile.id,
                                  points.revision,
                                  labels.revision,
                                  first,
                                  count,
                                  points.count,
                                  static_cast<std::uint32_t>(labels.table.size()),
                                  labels.index_bytes,
                                  with_points ? 1U : 0U};
  append(out, header, std::size(header));
  append(out, points.box_min_P.data(), 3);
  append(out, points.box_size_P.data(), 3);
  append(out, labels.table.data(), labels.table.size());
  const std::size_t index_bytes = labels.index_bytes;
  append(out, labels.indices.data() + first * index_bytes, count * index_bytes);
  fill_up(out, begin);
  if (!with_points) return;
  append(out, points.records.data() + first * kPointBytes, count * kPointBytes);
  fill_up(out, begin);
}

}  // namespace kintsugi::scene
