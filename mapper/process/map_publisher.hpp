#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/bus/bus.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/messages.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "mapper/core/frame/rgbd_frame.hpp"
#include "mapper/process/options.hpp"
#include "mapper/session/session_store.hpp"

namespace kintsugi::mapper {

/// Everything the mapper says on the bus, and in its log before that; and the answers to those who
/// missed something. The bulk streams are paced and drop nothing: who publishes faster than they
/// flow looks at has_room() and waits.
///
/// Of a session that goes on, the slices must be published again from the first one: what the log
/// has is compared with it and not sent. Sessions that ended earlier in the log are served too.
class MapPublisher {
 public:
  struct Config {
    std::string lcm_url;  ///< empty: LCM's default
    std::string map_name;
    std::int64_t session = 0;
    bool publish_frames = false;
    int jpeg_quality = 90;           ///< of published frames
    StreamPublisher::Config stream;  ///< chunks are as large as the bus takes them
    double max_queue_s = 3.2;        ///< per stream, at its rate; no room above this
  };

  /// @throws std::runtime_error when the bus cannot be opened, with the cure
  MapPublisher(const Config& config, SessionStore& store);

  void publish_slices(std::vector<CloudSlice> slices);
  void publish_pose(CameraPose pose);
  void publish_status(MapperStatus status);
  /// Does nothing unless frames are to be published.
  void publish_frame(const RgbdFrame& frame);

  /// The queues are short enough for more. After a failure of the bus they stay long: the next
  /// publish_...() throws it.
  bool has_room() const;

  /// What waits to be sent.
  std::size_t queued_bytes() const;

  /// Waits until everything is sent. @throws std::runtime_error when sending failed, or when a
  ///   slice of a session that goes on differs from what the log has
  void flush();

  /// Since somebody asked for something again, seconds.
  double time_since_request_s() const;

  std::int64_t slices_published() const { return slices_published_; }
  std::int64_t points_published() const { return points_published_; }
  std::int64_t chunks_published() const { return slice_stream_->chunks_published(); }

 private:
  using Stream = std::unique_ptr<StreamPublisher>;

  StreamPublisher::Config stream_config(const std::string& map_name) const;
  void serve_earlier_sessions();
  template <SmallMessage Message>
  void publish(const std::string& channel, const Message& message);

  Config config_;
  SessionStore& store_;
  Bus bus_;
  Stream slice_stream_;
  Stream frame_stream_;                   ///< null: frames are not published
  std::vector<Stream> earlier_sessions_;  ///< only served
  std::int64_t slices_published_ = 0;
  std::int64_t points_published_ = 0;
  std::optional<BusThread> bus_thread_;  ///< last: stops before the rest goes
};

/// What the options ask for.
MapPublisher::Config publisher_config(const Options& options, std::int64_t session);

}  // namespace kintsugi::mapper
