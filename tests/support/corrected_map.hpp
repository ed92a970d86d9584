#pragma once
// A generated map in patches, with corrections that move all of it, as a mapper that closes loops
// publishes it.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "tests/support/played_map.hpp"

namespace kintsugi::testing {

/// The slices of one session in the order in which they are sent. The corrections are spread
/// evenly: the last one comes when all patches are there. Each moves all patches so far, but the
/// first, and the more the later they came, as a loop does that is closed. After each, the patches
/// of the batch before it come again, in a higher revision and at their new poses.
class CorrectedMap {
 public:
  struct Config {
    int num_corrections = 0;  ///< at most one for each batch
    int batch_patches = 10;   ///< of a batch, >= 1
  };

  /// `map` must outlive this and have at least two slices, of which the last is the final one.
  CorrectedMap(const PlayedMap& map, const Config& config);

  std::size_t num_steps() const { return steps_.size(); }
  CloudSlice slice(std::size_t step) const;

 private:
  struct Step {
    std::int32_t id = 0;
    std::int32_t patch = 0;  ///< the slice of the map; of a correction: how many patches are there
    std::int32_t revision = 0;
    std::int32_t correction = 0;  ///< the number of corrections so far
    std::int64_t batch = 0;
    SliceKind kind = SliceKind::kPatch;
    bool ends_batch = false;
  };

  void send(std::int32_t first_patch, std::int32_t end_patch);
  void correct(std::int32_t num_patches);
  CloudSlice correction(const Step& step) const;
  PatchPose pose_of(std::int32_t patch, std::int32_t correction) const;

  const PlayedMap& map_;
  std::vector<std::int32_t> ids_;        ///< of each patch; kNoId: not sent yet
  std::vector<std::int32_t> revisions_;  ///< of each patch, the newest
  std::vector<Step> steps_;
  std::int32_t next_id_ = 0;
  std::int32_t num_corrections_ = 0;
  std::int64_t num_batches_ = 0;
};

}  // namespace kintsugi::testing
