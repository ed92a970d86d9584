#include "mapper/output/cloud_reader.hpp"

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/whole_log_reader.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::size_t kRecordBytes = 31;

[[noreturn]] void fail(const std::filesystem::path& path, const std::string& what) {
  throw std::runtime_error(path.string() + ": " + what);
}

std::optional<std::int64_t> parse_count(std::string_view text) {
  std::int64_t count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return count;
}

/// Checks the header line by line. @return the number of points
std::int64_t read_header(std::istream& in, const std::filesystem::path& path) {
  std::int64_t count = -1;
  const std::string kElement = "element vertex ";
  for (const std::string expected :
       {"ply", "format binary_little_endian 1.0", kElement.c_str(), "property float x",
        "property float y", "property float z", "property float nx", "property float ny",
        "property float nz", "property uchar red", "property uchar green", "property uchar blue",
        "property float weight", "end_header"}) {
    std::string line;
    std::getline(in, line);
    if (expected == kElement && line.rfind(kElement, 0) == 0) {
      count = parse_count(std::string_view(line).substr(kElement.size())).value_or(-1);
    } else if (line != expected) {
      fail(path, "has " + line.substr(0, 60) + " in its header, expected " + expected);
    }
  }
  return count;
}

CloudPoint unpack(const char* record) {
  CloudPoint p;
  const auto take = [&record](auto& value) {
    std::memcpy(&value, record, sizeof value);
    record += sizeof value;
  };
  for (float* value : {&p.x, &p.y, &p.z, &p.nx, &p.ny, &p.nz}) take(*value);
  for (std::uint8_t* value : {&p.red, &p.green, &p.blue}) take(*value);
  take(p.weight);
  return p;
}

std::vector<CloudPoint> read_ply(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) fail(path, std::strerror(errno));
  const std::int64_t count = read_header(in, path);
  const auto body = static_cast<std::int64_t>(in.tellg());
  if (body < 0) fail(path, "ends with its header");  // without the end of the last line
  const auto size = static_cast<std::int64_t>(std::filesystem::file_size(path)) - body;
  if (count < 0 || size / static_cast<std::int64_t>(kRecordBytes) != count ||
      size % static_cast<std::int64_t>(kRecordBytes) != 0) {
    fail(path, "says " + std::to_string(count) + " points of " + std::to_string(kRecordBytes) +
                   " bytes, has " + std::to_string(size) + " bytes of them");
  }
  std::vector<CloudPoint> points;
  points.reserve(static_cast<std::size_t>(count));
  char record[kRecordBytes];
  while (in.read(record, sizeof record)) points.push_back(unpack(record));
  return points;
}

std::vector<CloudPoint> read_log(const std::filesystem::path& path) {
  std::map<std::int64_t, std::map<std::int32_t, CloudSlice>> sessions;
  std::int64_t last_session = 0;
  StreamSubscriber<CloudSlice> subscriber(channels::kCloudSlice, [&](CloudSlice slice) {
    last_session = slice.session;
    CloudSlice& known = sessions[slice.session][slice.id];
    if (slice.revision >= known.revision) known = std::move(slice);
  });
  WholeLogReader log(path);
  while (const auto event = log.next()) subscriber.handle(event->channel, event->data);
  if (log.damage()) throw std::runtime_error(*log.damage());
  if (sessions.empty())
    fail(path, std::string("has no slices of a map (") + channels::kCloudSlice + ")");
  std::vector<CloudSlice*> slices;
  for (auto& [id, slice] : sessions[last_session]) slices.push_back(&slice);
  apply_corrections(slices);
  std::vector<CloudPoint> points;
  for (const auto& [id, slice] : sessions[last_session]) {
    points.insert(points.end(), slice.points_W.begin(), slice.points_W.end());
  }
  return points;
}

}  // namespace

std::vector<CloudPoint> read_cloud(const std::filesystem::path& path) {
  constexpr float kMax_m = 1e5F;  // as far as a volume goes (TsdfVolume)
  std::vector<CloudPoint> points = path.extension() == ".ply" ? read_ply(path) : read_log(path);
  for (const CloudPoint& p : points) {
    const bool is_place =
        std::abs(p.x) <= kMax_m && std::abs(p.y) <= kMax_m && std::abs(p.z) <= kMax_m;
    if (!is_place) {
      fail(path, "point " + std::to_string(&p - points.data()) +
                     " has coordinates that are not finite, or beyond 100 km");
    }
  }
  return points;
}

}  // namespace kintsugi::mapper
