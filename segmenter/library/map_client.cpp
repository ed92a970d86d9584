#include <algorithm>
#include <stdexcept>
#include <utility>

#include "lcmtypes/base/deadline.hpp"
#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/log/whole_log_reader.hpp"
#include "lcmtypes/signing/process_key.hpp"
#include "segmenter/library/bus.hpp"
#include "segmenter/library/map_follower.hpp"
#include "segmenter/tools/query/query_client.hpp"

namespace kintsugi {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr milliseconds kTickPeriod(20);
/// How long has_ended() waits for points that the segmenter has and this client has not: their
/// mapper may have ended.
constexpr double kPatience_s = 5.0;
/// So many messages wait() takes after the first change, before it hands out what there is.
constexpr int kMaxMessages = 10'000;

}  // namespace

class MapClient::Implementation {
 public:
  explicit Implementation(const MapClientOptions& options)
      : options_(options), follower_(options) {}

  void connect() {
    bus_.emplace(options_.url, MessageTrust{.key = bus_key(options_.bus_key)});
    follower_.subscribe(*bus_);
  }
  void open(const std::filesystem::path& path) {
    log_.emplace(path, MessageTrust{bus_key(options_.bus_key), options_.trust_log});
  }

  MapChanges wait(Seconds timeout) {
    if (log_) {
      read_on(timeout);
    } else {
      receive(timeout);
    }
    return follower_.take_changes();
  }

  bool has_ended() const {
    if (log_) return log_ended_;
    return follower_.segments().has_ended() && follower_.has_slices() &&
           (follower_.pieces().num_without_points() == 0 || patient_until_s_ < clock_.now_s());
  }
  std::string damage() const { return log_ ? log_->damage().value_or("") : ""; }

  SegmentAnswer ask(SegmentQuery query, Seconds timeout, const std::function<void()>& meanwhile) {
    if (log_) throw std::runtime_error("a log cannot answer queries");
    const SegmentUpdate* const newest = follower_.segments().table().newest();
    if (query.map_name.empty()) {
      query.map_name = newest != nullptr ? newest->map_name : options_.map_name;
    }
    if (!queries_) {
      queries_ = std::make_unique<segmenter::QueryClient>(options_.url, bus_key(options_.bus_key));
    }
    return queries_->ask(std::move(query), timeout, meanwhile);
  }

  const segmenter::MapFollower& follower() const { return follower_; }

 private:
  void read_on(Seconds timeout) {
    const auto end = deadline_after(timeout);
    do {
      const auto event = log_->next();
      if (!event) {
        log_ended_ = true;
        return;
      }
      log_time_s_ = std::max(log_time_s_, 1e-6 * static_cast<double>(event->utime));
      follower_.handle(event->channel, event->data, log_time_s_);
    } while (!follower_.has_changes() && Clock::now() < end);
  }

  void receive(Seconds timeout) {
    const auto end = deadline_after(timeout);
    do {
      const auto left = std::chrono::ceil<milliseconds>(end - Clock::now());
      bus_->handle(std::clamp(left, milliseconds(0), kTickPeriod));
      request_missing();
    } while (!follower_.has_changes() && Clock::now() < end);
    if (follower_.has_changes()) patient_until_s_ = clock_.now_s() + kPatience_s;
    for (int i = 0; i < kMaxMessages && bus_->handle(milliseconds(0)); ++i) request_missing();
  }

  void request_missing() {
    const double now_s = clock_.now_s();
    if (now_s < next_request_s_) return;
    next_request_s_ = now_s + std::chrono::duration<double>(kTickPeriod).count();
    follower_.ask(*bus_, now_s);
  }

  const MapClientOptions options_;
  segmenter::MapFollower follower_;
  std::optional<Bus> bus_;  // after follower_, which it calls
  std::optional<WholeLogReader> log_;
  bool log_ended_ = false;
  double log_time_s_ = 0.0;
  mutable PatientClock clock_;
  double patient_until_s_ = 0.0;
  double next_request_s_ = 0.0;
  std::unique_ptr<segmenter::QueryClient> queries_;
};

MapClient::MapClient(std::unique_ptr<Implementation> implementation)
    : implementation_(std::move(implementation)) {}
MapClient::~MapClient() = default;
MapClient::MapClient(MapClient&& other) noexcept = default;
MapClient& MapClient::operator=(MapClient&& other) noexcept = default;

MapClient MapClient::connect(const MapClientOptions& options) {
  auto implementation = std::make_unique<Implementation>(options);
  implementation->connect();
  return MapClient(std::move(implementation));
}

MapClient MapClient::open_log(const std::filesystem::path& path, const MapClientOptions& options) {
  auto implementation = std::make_unique<Implementation>(options);
  implementation->open(path);
  return MapClient(std::move(implementation));
}

MapChanges MapClient::wait(Seconds timeout) { return implementation_->wait(timeout); }
bool MapClient::has_ended() const { return implementation_->has_ended(); }
std::string MapClient::damage() const { return implementation_->damage(); }
std::string MapClient::problem() const { return implementation_->follower().problem(); }
std::string MapClient::dropped() const { return implementation_->follower().dropped(); }

bool MapClient::is_mapped() const { return implementation_->follower().pieces().has_final(); }

bool MapClient::is_complete() const {
  return implementation_->follower().segments().table().is_final();
}
const SegmentUpdate* MapClient::newest_update() const {
  return implementation_->follower().segments().table().newest();
}
float MapClient::resolution_m() const { return implementation_->follower().resolution_m(); }
std::vector<SegmentStatistics> MapClient::segments() const {
  std::vector<SegmentStatistics> segments;
  for (const auto& [id, segment] : implementation_->follower().segments().table().segments()) {
    segments.push_back(segment.statistics);
  }
  return segments;
}
std::optional<SegmentBirth> MapClient::birth(std::uint32_t segment_id) const {
  const SegmentTable::Origin* const origin =
      implementation_->follower().segments().table().origin(segment_id);
  if (origin == nullptr) return std::nullopt;
  return SegmentBirth{origin->slice_id, origin->parent_id};
}

std::vector<std::int32_t> MapClient::pieces() const {
  return implementation_->follower().pieces().ids();
}
std::shared_ptr<const std::vector<CloudPoint>> MapClient::points_W(std::int32_t piece) const {
  return implementation_->follower().pieces().points_W(piece);
}
std::vector<std::uint32_t> MapClient::labels(std::int32_t piece) const {
  return implementation_->follower().pieces().labels(piece);
}
const std::optional<CameraPose>& MapClient::camera() const {
  return implementation_->follower().camera();
}
std::vector<ObjectDetection> MapClient::objects() const {
  return implementation_->follower().objects();
}
SegmentAnswer MapClient::ask(SegmentQuery query, Seconds timeout,
                             const std::function<void()>& meanwhile) {
  return implementation_->ask(std::move(query), timeout, meanwhile);
}

MapClient read_log(const std::filesystem::path& path, const MapClientOptions& options) {
  MapClient client = MapClient::open_log(path, options);
  while (!client.has_ended()) client.wait(MapClient::Seconds(1.0));
  return client;
}

}  // namespace kintsugi
