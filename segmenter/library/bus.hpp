#pragma once
// Kintsugi::bus: follows a map and its segments while they are built, or reads them from a log.

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

struct MapClientOptions {
  std::string url{};       ///< of the bus; empty: LCM_DEFAULT_URL, or multicast on this host
  std::string map_name{};  ///< empty: the map of the first segment update that is received
  /// Also receive the points of the map. Without them there are segments, updates and poses only.
  bool with_points = true;
  /// File of the key with which messages and logs are signed; empty: KINTSUGI_BUS_KEY, or none.
  std::string bus_key{};
  /// open_log(), read_log(): read the log whether or not it is signed, and verify nothing.
  bool trust_log = false;
};

/// What one MapClient::wait() has received.
struct MapChanges {
  std::vector<SegmentUpdate>
      updates;  ///< of the segmenter, in the order in which they are complete
  /// That came, changed, moved or have other labels; ascending. After a newer session of the mapper
  /// has come: all pieces of that.
  std::vector<std::int32_t> pieces;
  std::vector<CameraPose> poses;  ///< of the mapper of the map

  [[nodiscard]] bool is_empty() const { return updates.empty() && pieces.empty() && poses.empty(); }
};

/// Where a segment came from.
struct SegmentBirth {
  std::int32_t slice_id = 0;             ///< with which it came
  std::uint32_t parent_id = kNoSegment;  ///< it was split off this; kNoSegment: it was new surface
};

/// One map as its mapper and segmenter publish it: the pieces (slices) with their points where all
/// corrections have put them, the segment of each point, the table of segments, the camera.
///
/// On the bus, what was lost or sent before is requested again, so the map is whole after a while,
/// whenever the client starts. Nothing is handled but in wait(), which is to be called regularly.
/// A newer session of the mapper replaces the map. One thread at a time may use an object.
class [[gnu::visibility("default")]] MapClient {
 public:
  using Seconds = std::chrono::duration<double>;

  /// Connects to the bus.
  /// @throws std::runtime_error when the bus cannot be opened or the key cannot be read, with what
  ///   to do about it
  static MapClient connect(const MapClientOptions& options = {});
  /// Opens an LCM log; wait() reads on in it. MapClientOptions::url is not used.
  /// @throws std::runtime_error when the file cannot be read, is empty or is not an LCM log; when
  ///   there is a key and it is not signed with it, or it is signed and there is no key
  static MapClient open_log(const std::filesystem::path& path,
                            const MapClientOptions& options = {});
  ~MapClient();
  MapClient(MapClient && other) noexcept;
  MapClient& operator=(MapClient&& other) noexcept;

  /// Returns as soon as something has changed, or after `timeout` with nothing; with a timeout of 0
  /// it takes what has arrived, from a log the next message.
  /// @throws std::runtime_error when the connection is lost, std::invalid_argument when the timeout
  ///   is negative or no number
  MapChanges wait(Seconds timeout);
  /// Of a log: it is read to its end or first damage. On the bus: the map is complete, and nothing
  /// is missing or what is missing is not sent any more.
  [[nodiscard]] bool has_ended() const;
  /// Of a log: where and how it is damaged; empty: it is not.
  [[nodiscard]] std::string damage() const;
  /// What is missing: segments, points or corrections, as text for a person; empty: nothing.
  [[nodiscard]] std::string problem() const;
  /// How many messages were refused as invalid, and why the last was; empty: none.
  [[nodiscard]] std::string dropped() const;

  /// The mapper has sent its final slice: the camera adds nothing any more.
  [[nodiscard]] bool is_mapped() const;
  /// The final slice and all others are segmented.
  [[nodiscard]] bool is_complete() const;
  /// Names, sessions and counts of the map: the newest update without labels, runs, events and
  /// statistics; nullptr: none was received.
  [[nodiscard]] const SegmentUpdate* newest_update() const;
  /// Voxel size of the map, metres; 0: no slice of it has come.
  [[nodiscard]] float resolution_m() const;
  /// Every segment, by ascending id.
  [[nodiscard]] std::vector<SegmentStatistics> segments() const;
  /// Nothing: no such segment was ever heard of, or it came before this client.
  [[nodiscard]] std::optional<SegmentBirth> birth(std::uint32_t segment_id) const;

  /// The pieces that have been received, ascending; also those that have no points by now.
  [[nodiscard]] std::vector<std::int32_t> pieces() const;
  /// The points of a piece where it is now. A vector never changes: after a change of the piece
  /// there is another one.
  /// @throws std::invalid_argument when there is no such piece
  [[nodiscard]] std::shared_ptr<const std::vector<CloudPoint>> points_W(std::int32_t piece) const;
  /// The segment of each of these points; kNoSegment also as long as the piece is not segmented.
  /// @throws std::invalid_argument when there is no such piece
  [[nodiscard]] std::vector<std::uint32_t> labels(std::int32_t piece) const;

  /// The newest pose of the camera of the map; nothing: none was received, or no slice or update
  /// has told yet which map it is.
  [[nodiscard]] const std::optional<CameraPose>& camera() const;
  /// The known objects that `kintsugi-objects detect` has found and that are not gone, by ascending
  /// number. It repeats each about once a second: who has just connected may not know all.
  [[nodiscard]] std::vector<ObjectDetection> objects() const;

  /// Asks the segmenters on the bus. An empty map_name asks for the map that is followed.
  /// `meanwhile` is called every 0.1 s or more often while it waits; what it throws ends the wait.
  /// @throws std::runtime_error when nobody answers within `timeout` or the map is from a log,
  ///   std::invalid_argument for a query that is out of bounds and as wait()
  SegmentAnswer ask(SegmentQuery query, Seconds timeout = Seconds(5.0),
                    const std::function<void()>& meanwhile = {});

 private:
  class Implementation;
  explicit MapClient(std::unique_ptr<Implementation> implementation);

  std::unique_ptr<Implementation> implementation_;
};

/// Reads a whole log, up to its end or first damage.
/// @throws std::runtime_error as MapClient::open_log()
[[gnu::visibility("default")]] MapClient read_log(const std::filesystem::path& path,
                                                  const MapClientOptions& options = {});

}  // namespace kintsugi
