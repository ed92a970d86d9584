#pragma once
// Answers queries about segments while segmentation continues.

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/process/camera_views.hpp"
#include "segmenter/process/view_recorder.hpp"
#include "segmenter/query/map_excerpt.hpp"
#include "segmenter/session/session_maps.hpp"

namespace kintsugi::segmenter {

/// Takes segment queries from the bus and answers them one after the other.
///
/// The segmenting thread only copies, between two runs of the engine: for a query about a point, a
/// pixel or few segments what describes these (MapExcerpt), for another query the whole map, and
/// that only when it has changed since the copy for the previous one. Everything else happens in a
/// thread of its own, on one core and with low priority: allocating memory for a whole copy (which
/// takes longer than the copying), searching it, describing segments, sending. The memory is kept
/// for a few seconds.
///
/// Few queries are queued, and each only once, however often it is repeated; a client that gets no
/// answer repeats its query.
class QueryResponder {
 public:
  using Clock = std::chrono::steady_clock;

  /// How many views one answer holds: 3.5 MB, which a third of a second is enough to send.
  static constexpr std::size_t kMaxViews = 200;

  /// @param bus must outlive this; null: answers nothing
  /// @param session of this segmenter
  /// @param on_work called from any thread when serve() should be called soon
  /// @param on_view called with each view that is received; may be empty
  /// @param recorded what queries for views are answered from; must outlive this; null: no views
  QueryResponder(Bus* bus, std::int64_t session, std::function<void()> on_work,
                 std::function<void(const CameraView&)> on_view = {},
                 const ViewRecorder* recorded = nullptr);
  /// Waits until the current answer is sent.
  ~QueryResponder();
  QueryResponder(const QueryResponder&) = delete;
  QueryResponder& operator=(const QueryResponder&) = delete;

  /// From now on bus.handle() receives queries and views; this must outlive that.
  void subscribe(Bus& bus);

  /// Begins to answer the next query unless one is being answered. To be called between two changes
  /// by the thread that changes the maps.
  void serve(const SessionMaps& maps);

  // From any thread:
  std::int64_t messages_bad() const { return num_bad_ + views_.messages_bad(); }
  /// Waits until serve() has something to do, at most so long.
  void wait_for_work(std::chrono::milliseconds timeout);
  /// Since the last query, or since the start.
  double time_since_query_s() const;

 private:
  struct Copy {
    MapSnapshot map;
    std::int64_t version = -1;  ///< of the map when it was copied
  };

  void take(const SegmentQuery& query);
  std::optional<SegmentQuery> next_query();
  bool has_work() const;  // with the lock held
  bool has_room_for(const SegmentMap& map) const;
  void make_room(std::size_t num_points);
  void take_room(std::size_t num_points);
  void update_copy(const SegmentMap& map);
  void prepare(const SegmentMap& map, const SegmentQuery& query);
  void begin(const SegmentQuery& query);
  SegmentAnswer current_answer(const SegmentQuery& query) const;
  std::vector<std::uint8_t> recorded_views(const SegmentQuery& query) const;
  void drop(const SegmentQuery& query);
  void run();
  template <class MakeAnswer>
  void publish(const MakeAnswer& make_answer);

  Bus* bus_;
  std::int64_t session_;
  std::function<void()> on_work_;
  CameraViews views_;
  const ViewRecorder* recorded_;
  // The next two are used by the thread while it is busy, else by serve():
  std::unique_ptr<Copy> copy_;
  MapExcerpt excerpt_;
  std::unique_ptr<StreamPublisher> stream_;  // used by the thread; made for the first answer
  std::atomic<std::int64_t> num_bad_{0};

  mutable std::mutex mutex_;          // guards what follows
  std::condition_variable changed_;   // for the thread
  std::condition_variable has_come_;  // for wait_for_work()
  std::deque<SegmentQuery> waiting_;
  std::optional<SegmentQuery> current_;  // being answered: the thread is busy
  std::size_t room_points_ = 0;          // > 0: the thread is busy allocating memory for so many
  Clock::time_point last_query_ = Clock::now();
  bool is_ending_ = false;
  std::thread thread_;  // last: it uses the rest
};

}  // namespace kintsugi::segmenter
