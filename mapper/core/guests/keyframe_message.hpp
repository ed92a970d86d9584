#pragma once
// Keyframes in the form in which they go to another mapper.

#include <memory>
#include <optional>

#include "lcmtypes/messages.hpp"
#include "mapper/core/loop_closure/loop_closer.hpp"

namespace kintsugi::mapper {

/// A keyframe of this mapper. `previous` is the number of the one sent before it, `part` the part
/// in which it was tracked. Session and names are set by the publisher.
KeyframeMessage keyframe_message(const NewKeyframe& added, std::optional<int> previous, int part,
                                 std::int64_t utime, double resolution_m);

/// The keyframe that a message describes, where the guest has it: X_WC is its X_UK. Nothing if its
/// images are too small to be compared with others, or larger than those of any mapper.
std::shared_ptr<Keyframe> keyframe_of(const KeyframeMessage& message);

}  // namespace kintsugi::mapper
