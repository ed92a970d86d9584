#pragma once
// The map of a guest, another mapper on the bus, as a part of this one.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "mapper/core/loop_closure/loop_closure.hpp"
#include "mapper/core/slices/guest_patch.hpp"

namespace kintsugi::mapper {

/// Takes the messages of one session of a guest, in any order, and puts its keyframes into the loop
/// closure of this map. Its patches move with them. What has not got its predecessor or its
/// keyframe yet waits.
///
/// Each part of the guest's map becomes a part of this one, until loops join them. The guest's own
/// corrections are not taken: its loops are found here, too.
class GuestMap {
 public:
  /// @param resolution_m voxel size of this map
  explicit GuestMap(double resolution_m) : resolution_m_(resolution_m) {}

  void add(KeyframeMessage keyframe);
  /// Slices that are no patches of the guest's own camera are left out.
  void add(CloudSlice slice);

  /// Adds keyframes to `loops` in the guest's order, while less than `max_waiting` wait there to be
  /// compared. Returns the patches whose keyframe is there, each in its newest revision.
  std::vector<GuestPatch> take_in(LoopClosure& loops, std::int64_t utime, std::size_t max_waiting);

  int num_keyframes() const { return static_cast<int>(number_here_.size()); }
  /// Why nothing of the guest is taken; empty: it is.
  const std::string& problem() const { return problem_; }

 private:
  void add_next(LoopClosure& loops, std::int64_t utime);
  Pose X_UG(int part_of_guest) const;
  std::optional<int> here(int number) const;

  const double resolution_m_;
  std::string problem_;
  std::map<int, KeyframeMessage> waiting_keyframes_;  ///< by the number of the one before
  int last_ = -1;                                     ///< number of the last one that was added
  std::map<int, int> number_here_;                    ///< of keyframes, by the guest's number
  std::map<int, int> part_here_;                      ///< in which they begin, by the guest's part
  std::map<int, int> part_of_;  ///< the guest's part, by its keyframe's number
  std::map<std::int32_t, CloudSlice> waiting_patches_;    ///< by id, the newest revision
  std::map<std::int32_t, std::int32_t> newest_revision_;  ///< by id
};

}  // namespace kintsugi::mapper
