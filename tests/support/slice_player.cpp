// slice_player: stands in for a mapper. Publishes a generated map of any size, as slices of one
// session, through the mapper's own stream and store, and answers resend requests.

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

#include "lcmtypes/base/process_memory.hpp"
#include "lcmtypes/base/stop_signal.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "mapper/session/session_store.hpp"
#include "mapper/session/stored_stream.hpp"
#include "tests/support/bus_program.hpp"
#include "tests/support/corrected_map.hpp"
#include "tests/support/played_map.hpp"

namespace kintsugi::testing {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

constexpr std::size_t kMaxQueuedBytes = 32U << 20U;  // as in the mapper

struct Options {
  std::string url;
  PlayedMap::Config map;
  std::int64_t batch = 0;
  int corrections = 0;
  double speed = 1.0;
  double seconds = 0.0;
  double linger_s = 2.0;
  double rate_MB_per_s = 10.0;
  std::string store;
  std::string report;
};

void add_flags(CLI::App& app, Options& options) {
  app.add_option("--lcm-url", options.url, "The bus; empty: LCM's default");
  app.add_option("--points", options.map.num_points, "Size of the map")->capture_default_str();
  app.add_option("--slice-points", options.map.slice_points, "Size of a slice, at least")
      ->capture_default_str();
  app.add_option("--most-points", options.map.most_points,
                 "Cuts slices, so that none has more points; 0: does not")
      ->capture_default_str();
  app.add_option("--rooms", options.map.num_rooms, "How many the map goes through")
      ->capture_default_str();
  app.add_option("--seed", options.map.seed, "Decides the map")->capture_default_str();
  app.add_option("--session", options.map.session, "Number of the session")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--map-name", options.map.map_name, "Name of the map")->capture_default_str();
  app.add_option("--speed", options.speed,
                 "Times the normal rate, which is 0.8 slices a second; 0: as fast as can be sent")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--batch", options.batch,
                 "The slices are patches that stay in the volume, so many in a batch; a correction "
                 "supersedes those that wait to be sent. 0: slices that have left")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--corrections", options.corrections,
                 "So many corrections move the whole map (needs --batch). Then nothing supersedes "
                 "anything, so that a player that was killed can go on with --store")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  app.add_option("--seconds", options.seconds,
                 "Goes on for so long: when all but the final slice is published, the slices come "
                 "again, corrected")
      ->capture_default_str();
  app.add_option("--linger", options.linger_s,
                 "Stays to answer until nobody has asked for so many seconds; negative: until it "
                 "is told to stop")
      ->capture_default_str();
  app.add_option("--rate", options.rate_MB_per_s, "Of the stream at most, MB a second")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  app.add_option("--store", options.store,
                 "The log of the session, which goes on where an earlier run was killed; empty: a "
                 "temporary file");
  app.add_option("--report", options.report, "Writes at the end what it did (JSON)");
}

class SlicePlayer {
 public:
  explicit SlicePlayer(const Options& options)
      : options_(options),
        map_(options.map),
        bus_(options.url),
        log_(log_config(options)),
        stream_(bus_, channels::kCloudSlice, options.map.session, stream_config(options, bus_),
                &open_stream(log_, options.map.session)) {
    stream_.subscribe(bus_);
  }

  void run() {
    const BusThread answering(bus_);
    start_ = Clock::now();
    play();
    finished_ = true;
    stream_.flush();
    linger();
    publish_status();
    report();
  }

 private:
  static mapper::SessionStore::Config log_config(const Options& options) {
    mapper::SessionStore::Config config;
    config.path = options.store;
    config.resume = std::filesystem::exists(options.store);
    return config;
  }

  static StreamPublisher::Config stream_config(const Options& options, const Bus& bus) {
    StreamPublisher::Config config;
    config.rate_bytes_per_s = 1e6 * options.rate_MB_per_s;
    config.max_chunk_bytes = bus.max_message_bytes();
    config.map_name = options.map.map_name;
    return config;
  }

  /// Chunks after a gap in the log, and those of a message that was cut off, are sent anew.
  static mapper::StoredStream& open_stream(mapper::SessionStore& log, std::int64_t session) {
    mapper::StoredStream& stream = log.stream(channels::kCloudSlice, session);
    if (log.sessions().empty()) {
      log.begin_session(session, {{"device", "slice_player"}});
    } else {
      stream.index().truncate_at_gap();
    }
    return stream;
  }

  double elapsed_s() const { return Seconds(Clock::now() - start_).count(); }

  void play() {
    if (options_.corrections > 0) return play_corrections();
    const std::int32_t last = map_.num_slices() - 1;
    for (std::int32_t id = 0; id < last; ++id) publish(id, 0);
    for (std::int32_t revision = 1; elapsed_s() < options_.seconds; ++revision) {
      for (std::int32_t id = 0; id < last && elapsed_s() < options_.seconds; ++id) {
        if (stop_requested()) break;
        publish(id, revision);
      }
      if (stop_requested() || last == 0) break;
    }
    publish(last, 0);
  }

  void play_corrections() {
    const CorrectedMap corrected(map_, {.num_corrections = options_.corrections,
                                        .batch_patches = static_cast<int>(options_.batch)});
    for (std::size_t step = 0; step < corrected.num_steps(); ++step) {
      wait_until_due();
      CloudSlice slice = corrected.slice(step);
      if (slice.kind == SliceKind::kCorrection) ++corrections_;
      count(slice);
      stream_.publish(std::move(slice));
      publish_status_when_due();
    }
  }

  /// Until the next slice is due. After a stop signal the rest of the map is published at once.
  void wait_until_due() {
    if (options_.speed > 0.0) {
      const double due_s = static_cast<double>(slices_) / (options_.speed * kNormalSlicesPerSecond);
      while (elapsed_s() < due_s && !stop_requested()) rest();
    }
    while (stream_.queued_bytes() > kMaxQueuedBytes) rest();
  }

  void count(const CloudSlice& slice) {
    points_ += static_cast<std::int64_t>(slice.points_W.size());
    ++slices_;
    most_queued_bytes_ = std::max(most_queued_bytes_, stream_.queued_bytes());
  }

  void publish(std::int32_t id, std::int32_t revision) {
    wait_until_due();
    CloudSlice slice = map_.slice(id, revision);
    count(slice);
    revision_sum_ += revision > 0 ? 1 : 0;
    if (slice.kind == SliceKind::kFinal) slice.revision_sum = revision_sum_;
    if (options_.batch > 0 && slice.kind != SliceKind::kFinal) {
      slice.kind = SliceKind::kPatch;
      slice.in_volume = true;
      // The last patch of the map ends its batch, so that none waits for the final slice.
      slice.ends_batch = slices_ % options_.batch == 0 || id + 2 == map_.num_slices();
      stream_.publish_patch(std::move(slice), true);
    } else {
      stream_.publish(std::move(slice));
    }
    publish_status_when_due();
  }

  void linger() {
    lingering_ = true;
    const auto asked_lately = [this] {
      return options_.linger_s < 0.0 || stream_.time_since_request_s() < options_.linger_s;
    };
    const Clock::time_point begin = Clock::now();
    while (!stop_requested() &&
           (asked_lately() || Seconds(Clock::now() - begin).count() < options_.linger_s)) {
      rest();
    }
  }

  void rest() {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
    log_.retry();
    publish_status_when_due();
  }

  void publish_status_when_due() {
    if (Clock::now() < next_status_) return;
    next_status_ = Clock::now() + std::chrono::milliseconds(250);
    publish_status();
  }

  void publish_status() {
    const StreamPublisherCounts counts = stream_.counts();
    const mapper::BufferedLog::Report store = log_.report();
    MapperStatus status;
    status.utime = wall_clock_us();
    status.session = options_.map.session;
    status.map_name = options_.map.map_name;
    status.device = "slice_player";
    status.state = TrackingState::kGiven;
    status.finished = finished_;
    status.lingering = lingering_;
    status.corrections = corrections_;
    status.slices_published = slices_;
    status.points_published = points_;
    status.chunks_published = stream_.chunks_published();
    status.chunks_resent = counts.chunks_resent;
    status.requests_received = counts.requests_received;
    status.memory_bytes = process_memory().resident_bytes;
    status.queue_bytes = static_cast<std::int64_t>(stream_.queued_bytes());
    status.store_bytes = store.size_bytes;
    status.store_waiting_bytes = store.waiting_bytes;
    status.store_lost_chunks = store.lost_chunks;
    status.store_problem = store.problem;
    report_refused(status);
    bus_.publish(channels::kMapperStatus, status);
  }

  void report() const {
    const StreamPublisherCounts counts = stream_.counts();
    const nlohmann::json done = {{"slices", slices_},
                                 {"points", points_},
                                 {"chunks", counts.chunks_sent},
                                 {"bytes", counts.bytes_sent},
                                 {"chunks_resent", counts.chunks_resent},
                                 {"bytes_resent", counts.bytes_resent},
                                 {"requests_received", counts.requests_received},
                                 {"requests_bad", counts.requests_bad},
                                 {"most_queued_bytes", most_queued_bytes_},
                                 {"seconds", elapsed_s()}};
    give_report(done, options_.report);
  }

  const Options options_;
  const PlayedMap map_;
  Bus bus_;
  mapper::SessionStore log_;
  StreamPublisher stream_;
  Clock::time_point start_;
  Clock::time_point next_status_;
  std::int64_t slices_ = 0;        // published, revisions too
  std::int64_t corrections_ = 0;   // of the map
  std::int64_t revision_sum_ = 0;  // of the newest revisions
  std::int64_t points_ = 0;
  std::size_t most_queued_bytes_ = 0;
  bool finished_ = false;
  bool lingering_ = false;
};

void play(const Options& options) {
  if (options.corrections > 0 && options.batch == 0) {
    throw std::invalid_argument("--corrections needs --batch");
  }
  SlicePlayer(options).run();
}

}  // namespace
}  // namespace kintsugi::testing

int main(int argc, char** argv) {
  using namespace kintsugi::testing;
  return run_bus_program<Options>(
      argc, argv, "Publishes a generated map as a mapper does, and answers resend requests.",
      add_flags, play);
}
