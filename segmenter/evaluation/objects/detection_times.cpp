#include "segmenter/evaluation/objects/detection_times.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <map>
#include <stdexcept>
#include <utility>

#include <nlohmann/json.hpp>
#include <spdlog/fmt/fmt.h>

#include "lcmtypes/base/json_text.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/log/whole_log_reader.hpp"
#include "lcmtypes/object_messages.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi::segmenter {
namespace {

/// Where it is told again within this it stands where it was: a detector refines poses as the map
/// grows.
constexpr double kSamePlace = 0.25;  // of the largest side of its box
constexpr double kWhole = 0.9;       // of its points

double seconds(std::int64_t us) { return 1e-6 * static_cast<double>(us); }

double largest_side_m(const ObjectDetection& message) {
  double side_m = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    side_m = std::max<double>(side_m, message.box_max_O[axis] - message.box_min_O[axis]);
  }
  return side_m;
}

/// The detections of one run of a detector.
struct Told {
  ObjectDetection last;
  double since_s = 0.0;
};
using ToldById = std::map<std::int32_t, Told>;

void take(ObjectDetection message, double now_s, ToldById& told) {
  const auto [entry, is_new] = told.try_emplace(message.detection);
  Told& known = entry->second;
  const bool was_there = !is_new && known.last.event != DetectionEvent::kGone;
  const double apart_m = (message.X_WO.translation() - known.last.X_WO.translation()).norm();
  if (!was_there || apart_m > kSamePlace * largest_side_m(message)) known.since_s = now_s;
  known.last = std::move(message);
}

ToldById read_told(const std::filesystem::path& path, DetectionTimes& result) {
  ToldById told;
  std::int64_t session = 0;
  std::int64_t num_bad = 0;
  WholeLogReader log(path);
  while (const auto event = log.next()) {
    if (event->channel != channels::kObjectDetection) continue;
    try {
      auto message = decode<ObjectDetection>(event->data);
      if (message.session < session) continue;
      if (message.session > session) told.clear();
      session = message.session;
      take(std::move(message), seconds(event->utime), told);
    } catch (const DecodeError&) {
      ++num_bad;
    }
  }
  if (num_bad > 0) {
    result.remarks.push_back(
        fmt::format("{} messages on {} could not be used", num_bad, channels::kObjectDetection));
  }
  return told;
}

/// What patches have brought into the box of one object.
class BoxContents {
 public:
  explicit BoxContents(const ObjectDetection& message)
      : X_OW_(message.X_WO.inverse().cast<float>()) {
    for (int axis = 0; axis < 3; ++axis) {
      low_[axis] = message.box_min_O[axis];
      high_[axis] = message.box_max_O[axis];
    }
  }

  void take(const CloudSlice& slice, const std::vector<CloudPoint>& points_W, double now_s) {
    Part part;
    for (std::size_t i = 0; i < points_W.size(); ++i) {
      const CloudPoint& p_W = points_W[i];
      const Eigen::Vector3f p_O = X_OW_ * Eigen::Vector3f(p_W.x, p_W.y, p_W.z);
      const float margin_m = slice.resolution_m;
      if (((p_O.array() < low_.array() - margin_m) || (p_O.array() > high_.array() + margin_m))
              .any()) {
        continue;
      }
      part.add(slice.points_W[i]);
    }
    Part& before = parts_[slice.id];
    if (part == before) return;
    count_ += part.count - before.count;
    before = part;
    counts_.emplace_back(now_s, count_);
  }

  /// 0 when no patch had points there.
  double last_change_s() const { return counts_.empty() ? 0.0 : counts_.back().first; }

  double whole_s() const {
    double since_s = last_change_s();
    for (auto change = counts_.rbegin(); change != counts_.rend(); ++change) {
      if (static_cast<double>(change->second) < kWhole * static_cast<double>(count_)) break;
      since_s = change->first;
    }
    return since_s;
  }

 private:
  /// Of one patch: as many points, and the same in all probability.
  struct Part {
    std::int64_t count = 0;
    std::uint64_t hash = 14695981039346656037U;  // FNV-1a

    void add(const CloudPoint& p) {
      ++count;
      for (const float coordinate : {p.x, p.y, p.z}) {
        hash = (hash ^ std::bit_cast<std::uint32_t>(coordinate)) * 1099511628211U;
      }
    }
    bool operator==(const Part&) const = default;
  };

  Eigen::Isometry3f X_OW_;
  Eigen::Vector3f low_;
  Eigen::Vector3f high_;
  std::map<std::int32_t, Part> parts_;  // by slice
  std::int64_t count_ = 0;
  std::vector<std::pair<double, std::int64_t>> counts_;  // after each change
};

std::optional<double> cpu_share_of(ByteView message) {
  try {
    return decode<DetectorStatus>(message).cpu_share;
  } catch (const DecodeError&) {
    return std::nullopt;
  }
}

std::vector<BoxContents> read_contents(const std::filesystem::path& path,
                                       const std::vector<Told>& told, DetectionTimes& result) {
  std::vector<BoxContents> contents;
  contents.reserve(told.size());
  for (const Told& each : told) contents.emplace_back(each.last);
  if (contents.empty()) return contents;
  const std::int64_t session = told.front().last.map_session;
  PatchMotions motions;
  double now_s = 0.0;
  std::optional<double> cpu_share;
  StreamSubscriber<CloudSlice> slices(channels::kCloudSlice, [&](const CloudSlice& slice) {
    if (slice.session != session) return;
    result.cpu_share = cpu_share;
    if (slice.superseded) return;
    motions.learn(slice);
    const std::vector<CloudPoint> points_W = moved(slice.points_W, motions.place_of(slice).X_WP);
    for (BoxContents& box : contents) box.take(slice, points_W, now_s);
  });
  WholeLogReader log(path);
  while (const auto event = log.next()) {
    now_s = seconds(event->utime);
    slices.handle(event->channel, event->data);
    if (event->channel == channels::kDetectorStatus) cpu_share = cpu_share_of(event->data);
  }
  if (log.damage()) result.remarks.push_back(*log.damage());
  if (const auto missing = slices.counts().chunks_missing; missing > 0) {
    result.remarks.push_back(
        fmt::format("{} chunks of {} are missing in the log", missing, channels::kCloudSlice));
  }
  return contents;
}

template <class Delay>
std::optional<double> quantile_of(const std::vector<DetectionTime>& detections, double share,
                                  const Delay& delay) {
  if (detections.empty()) return std::nullopt;
  std::vector<double> values;
  values.reserve(detections.size());
  for (const DetectionTime& each : detections) values.push_back(delay(each));
  std::ranges::sort(values);
  const auto rank =
      static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size())));
  return values[static_cast<std::size_t>(std::max<std::ptrdiff_t>(rank, 1) - 1)];
}

}  // namespace

double DetectionTime::delay_s() const { return std::max(told_s - last_patch_s, 0.0); }

double DetectionTime::delay_of_whole_s() const { return std::max(told_s - whole_s, 0.0); }

std::optional<double> DetectionTimes::delay_s(double quantile) const {
  return quantile_of(detections, quantile, [](const auto& each) { return each.delay_s(); });
}

std::optional<double> DetectionTimes::delay_of_whole_s(double quantile) const {
  return quantile_of(detections, quantile,
                     [](const auto& each) { return each.delay_of_whole_s(); });
}

DetectionTimes read_detection_times(const std::filesystem::path& path) {
  DetectionTimes result{.source = path.string(), .detections = {}, .cpu_share = {}, .remarks = {}};
  const ToldById by_id = read_told(path, result);
  if (by_id.empty()) {
    throw std::runtime_error(path.string() + ": holds no detected object (" +
                             channels::kObjectDetection + ")");
  }
  std::vector<Told> told;
  for (const auto& [id, each] : by_id) {
    if (each.last.event != DetectionEvent::kGone) told.push_back(each);
  }
  const std::vector<BoxContents> contents = read_contents(path, told, result);
  for (std::size_t i = 0; i < told.size(); ++i) {
    result.detections.push_back({.detection = told[i].last.detection,
                                 .name = told[i].last.name,
                                 .told_s = told[i].since_s,
                                 .last_patch_s = contents[i].last_change_s(),
                                 .whole_s = contents[i].whole_s()});
  }
  result.is_whole = result.remarks.empty();
  return result;
}

std::string to_text(const DetectionTimes& times) {
  std::string text = "from the last patch, s  from nine tenths of it, s  object\n";
  for (const DetectionTime& each : times.detections) {
    text += fmt::format("{:>22.2f}  {:>25.2f}  {} ({})\n", each.delay_s(), each.delay_of_whole_s(),
                        each.name, each.detection);
  }
  for (const auto& [share, title] : {std::pair(0.5, "median"), std::pair(0.99, "99 %")}) {
    if (times.detections.empty()) break;
    text += fmt::format("{:>22.2f}  {:>25.2f}  {}\n", *times.delay_s(share),
                        *times.delay_of_whole_s(share), title);
  }
  if (times.cpu_share) {
    text += fmt::format("the detector used {:.1f} % of a core\n", 100 * *times.cpu_share);
  }
  return text;
}

std::string to_json(const DetectionTimes& times) {
  using Json = nlohmann::ordered_json;
  const auto json = [](std::optional<double> value) {
    return value ? Json(*value) : Json(nullptr);
  };
  Json list = Json::array();
  for (const DetectionTime& each : times.detections) {
    list.push_back({{"detection", each.detection},
                    {"name", each.name},
                    {"told_s", each.told_s},
                    {"last_patch_s", each.last_patch_s},
                    {"whole_s", each.whole_s},
                    {"delay_s", each.delay_s()},
                    {"delay_of_whole_s", each.delay_of_whole_s()}});
  }
  const Json root{{"log", times.source},
                  {"is_whole", times.is_whole},
                  {"remarks", times.remarks},
                  {"delay_median_s", json(times.delay_s(0.5))},
                  {"delay_p99_s", json(times.delay_s(0.99))},
                  {"delay_of_whole_median_s", json(times.delay_of_whole_s(0.5))},
                  {"delay_of_whole_p99_s", json(times.delay_of_whole_s(0.99))},
                  {"cpu_share", json(times.cpu_share)},
                  {"detections", list}};
  return json_text(root, 1) + "\n";
}

}  // namespace kintsugi::segmenter
