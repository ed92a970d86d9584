#pragma once
// What is published of objects: detections of those in a library, and changes between two maps.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "lcmtypes/geometry.hpp"

namespace kintsugi {

inline constexpr std::size_t kMaxObjectNameBytes = 64;
/// Of one object; with it a message fits one datagram.
inline constexpr std::size_t kMaxObjectSegments = 1024;

/// A name of an object is also that of its folder in a library: letters, digits, - and _, 1 to 64
/// of them.
constexpr bool is_object_name(std::string_view name) {
  const auto is_allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
           c == '_';
  };
  return !name.empty() && name.size() <= kMaxObjectNameBytes &&
         std::ranges::all_of(name, is_allowed);
}

enum class DetectionEvent : std::int8_t {
  kFound = 0,      ///< the object seems to be there
  kConfirmed = 1,  ///< it is there
  kMoved = 2,      ///< it is there, at another pose than before
  kGone = 3,       ///< it is no longer there
};

/// The last event of one detection of a known object, and what is known of it. A detector sends it
/// at the event, and again about once a second, with the same `event_number`: a late listener
/// learns it so, and what was lost is mended.
struct ObjectDetection {
  std::int64_t utime = 0;           ///< device time of the newest slice looked at, microseconds
  std::int64_t session = 0;         ///< of the detector; > 0
  std::int64_t map_session = 0;     ///< of the mapper; > 0
  std::string map_name;             ///< of the mapper
  std::int32_t detection = 0;       ///< its number in the session, 1 .. num_detections
  std::int32_t num_detections = 0;  ///< in the session so far
  /// Of its last event: ascending in the session over the events of all detections, from 1.
  std::int64_t event_number = 0;
  DetectionEvent event = DetectionEvent::kFound;
  std::string name;                        ///< of the object in the library; is_object_name()
  Pose X_WO = Pose::Identity();            ///< when gone, the last known pose
  float score = 0.0F;                      ///< 0 to 1
  float box_min_O[3] = {};                 ///< of the model, metres
  float box_max_O[3] = {};                 ///< at least box_min_O
  std::int32_t points = 0;                 ///< map points that the model explains
  std::vector<std::uint32_t> segment_ids;  ///< of which it consists, ascending
};

enum class ChangeKind : std::int8_t {
  kNew = 0,
  kGone = 1,
  kMoved = 2,      ///< the same object, at another pose
  kWithdrawn = 3,  ///< what was reported is no longer so
};

/// One change of the running map, whose frame is W, against an earlier map of the same place. It is
/// repeated as ObjectDetection is.
struct ChangeReport {
  std::int64_t utime = 0;        ///< device time of the newest slice looked at, microseconds
  std::int64_t session = 0;      ///< of kintsugi-diff; > 0
  std::int64_t map_session = 0;  ///< of the mapper of the running map; > 0
  std::string map_name;          ///< of that mapper
  std::string before;            ///< name of the earlier map
  std::int32_t change = 0;       ///< its number in the session, 1 .. num_changes
  std::int32_t num_changes = 0;  ///< in the session so far
  /// Of its last event: ascending in the session over the events of all changes, from 1.
  std::int64_t event_number = 0;
  ChangeKind kind = ChangeKind::kNew;
  float score = 0.0F;  ///< 0 to 1
  /// kMoved: a point of the object at p_W in the earlier map, aligned, is now at motion_W p_W.
  /// Otherwise the identity.
  Pose motion_W = Pose::Identity();
  float box_min_W[3] = {};  ///< of the object: where it is, or if gone where it was; metres
  float box_max_W[3] = {};  ///< at least box_min_W
  std::int32_t points = 0;  ///< of the object
  std::vector<std::uint32_t> segment_ids;  ///< of the running map, ascending; kGone: none
};

}  // namespace kintsugi
