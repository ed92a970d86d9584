#pragma once
// Answers to what people ask about segments, while the map goes on.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/process/session_maps.hpp"

namespace kintsugi::segmenter {

/// Takes segment queries from the bus and answers them one after the other.
///
/// The working thread gives no more than a copy of the map, between two slices, and only when the
/// map is not the one that was copied for the query before. Getting memory for the copy, which
/// takes most of its time, looking at it, describing segments and sending is done by a thread of
/// its own, on one core and with low priority. The memory is kept for some time.
///
/// Queries that wait are few and each waits once, however often it is asked again: who gets no
/// answer asks later.
class QueryResponder {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param bus must outlive this; null: answers nothing
  /// @param session of this segmenter
  QueryResponder(Bus* bus, std::int64_t session);
  /// Sends the answer that is being made.
  ~QueryResponder();
  QueryResponder(const QueryResponder&) = delete;
  QueryResponder& operator=(const QueryResponder&) = delete;

  /// From now on bus.handle() takes queries; this must outlive that.
  void subscribe(Bus& bus);

  /// Begins with the next query unless one is being answered. For the thread that changes the maps,
  /// between two changes.
  void serve(const SessionMaps& maps);

  // From any thread:
  std::int64_t messages_bad() const { return num_bad_; }
  /// Since somebody last asked, or since the start.
  double time_since_query_s() const;

 private:
  struct Copy {
    MapSnapshot map;
    std::int64_t version = -1;  ///< of the map when it was copied
    Clock::time_point last_used;
  };

  void take(const SegmentQuery& query);
  std::optional<SegmentQuery> next_query();
  bool has_room_for(const SegmentMap& map) const;
  void make_room(std::size_t num_points);
  void update_copy(const SegmentMap& map);
  void begin(const SegmentQuery& query);
  void drop(const SegmentQuery& query);
  void run();
  template <class MakeAnswer>
  void publish(const MakeAnswer& make_answer);

  Bus* bus_;
  std::int64_t session_;
  std::unique_ptr<Copy> copy_;               // of the thread while it is busy, else of serve()
  std::unique_ptr<StreamPublisher> stream_;  // of the thread; since the first answer
  std::atomic<std::int64_t> num_bad_{0};

  mutable std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::deque<SegmentQuery> waiting_;
  std::optional<SegmentQuery> current_;  // being answered: the thread is busy
  std::size_t room_points_ = 0;          // > 0: it is busy making room for so many
  Clock::time_point last_query_ = Clock::now();
  bool is_ending_ = false;
  std::thread thread_;  // last: it uses the rest
};

}  // namespace kintsugi::segmenter
