#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
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

/// Publishes the messages of the mapper on the bus, after storing them in its log, and answers
/// requests for lost chunks. Slices, keyframes and frames are sent at a limited rate and never
/// dropped, except views and revisions of patches that a newer one supersedes: the caller waits
/// while has_room() is false.
///
/// In a resumed session all slices must be published again from the first one: those in the log are
/// compared with it and not sent. Requests for the other sessions in the log are answered, too.
class MapPublisher {
 public:
  /// What was published of slices.
  struct Published {
    std::int64_t slices = 0;
    std::int64_t points = 0;
    std::int64_t chunks = 0;
  };
  struct Config {
    std::string lcm_url;  ///< empty: LCM's default
    std::string map_name;
    std::string join;  ///< name of the map of another mapper, for which keyframes are published
    std::int64_t session = 0;
    bool publish_frames = false;
    /// A patch that waits is not sent when a newer revision follows; what is sent then depends on
    /// the time that sending takes.
    bool supersede_patches = false;
    int jpeg_quality = 90;  ///< of published frames
    StreamPublisher::Config
        stream;                ///< its chunk size is replaced by the largest that the bus takes
    double max_queue_s = 3.2;  ///< limit for has_room(): queued bytes of a stream over its rate
  };

  /// @throws std::runtime_error when the bus cannot be opened, with a remedy
  MapPublisher(const Config& config, SessionStore& store);

  void publish_slices(std::vector<CloudSlice> slices);
  void publish_pose(CameraPose pose);
  /// Does nothing unless another map is joined.
  void publish_keyframe(KeyframeMessage keyframe);
  /// Left out when the view before still waits.
  void publish_view(CameraView view);
  void publish_status(MapperStatus status);
  /// Does nothing unless frames are to be published.
  void publish_frame(const RgbdFrame& frame);

  /// Whether the queues are short enough for more. After a failure of the bus they stay long; the
  /// next publish_...() throws the error.
  bool has_room() const;

  /// Bytes that wait to be sent.
  std::size_t queued_bytes() const { return queued_slice_bytes() + queued_frame_bytes(); }

  /// Waits until everything is sent.
  /// @throws std::runtime_error when sending failed, or when a slice of a resumed session differs
  ///   from the one in the log
  void flush();

  /// Time since the last request for a resend, seconds.
  double time_since_request_s() const;

  Published published() const;

 private:
  using Stream = std::unique_ptr<StreamPublisher>;

  StreamPublisher::Config stream_config(const std::string& map_name) const;
  StreamPublisher& slice_stream(std::int64_t session, const std::string& map_name);
  void serve_stored_sessions();
  void answer(const ResendRequest& request);
  std::size_t queued_slice_bytes() const;
  std::size_t queued_frame_bytes() const;
  template <SmallMessage Message>
  void publish(const std::string& channel, const Message& message);

  Config config_;
  SessionStore& store_;
  Bus bus_;
  std::mutex mutex_;                              ///< guards slice_streams_ while it grows
  std::map<std::int64_t, Stream> slice_streams_;  ///< by session: of this run, and in the log
  StreamPublisher& slice_stream_;                 ///< of this run; the others only resend
  Stream keyframe_stream_;                        ///< null: no other map is joined
  Stream frame_stream_;                           ///< null: frames are not published
  StreamPublisher view_stream_;
  std::int64_t slices_published_ = 0;
  std::int64_t points_published_ = 0;
  std::optional<BusThread>
      bus_thread_;  ///< last: stops before the members that it uses are destroyed
};

/// The configuration for these options.
MapPublisher::Config publisher_config(const Options& options, std::int64_t session);

}  // namespace kintsugi::mapper
