#pragma once
// The guests of a map: other mappers whose maps are parts of it.

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "mapper/core/guests/guest_map.hpp"

namespace kintsugi::mapper {

/// What is known of a guest, for people.
struct GuestReport {
  std::int64_t session = 0;
  std::string map_name;
  int keyframes = 0;    ///< that are in this map
  std::string problem;  ///< why nothing of it is taken; empty: it is
};

/// Gives each session of a guest a GuestMap.
class Guests {
 public:
  /// @param resolution_m voxel size of this map
  explicit Guests(double resolution_m) : resolution_m_(resolution_m) {}

  void add(KeyframeMessage keyframe);
  /// Slices of a session without keyframes are left out.
  void add(CloudSlice slice);

  /// GuestMap::take_in() of all guests, in the order of their sessions.
  std::vector<GuestPatch> take_in(LoopClosure& loops, std::int64_t utime, std::size_t max_waiting);

  /// By session.
  std::vector<GuestReport> reports() const;
  std::int64_t num_patches() const { return num_patches_; }  ///< taken in, all revisions

 private:
  struct Guest {
    std::string map_name;
    GuestMap map;
  };

  const double resolution_m_;
  std::map<std::int64_t, Guest> guests_;  ///< by session
  std::int64_t num_patches_ = 0;
};

}  // namespace kintsugi::mapper
