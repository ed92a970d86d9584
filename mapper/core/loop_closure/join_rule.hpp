#pragma once

#include <memory>
#include <vector>

#include "mapper/core/loop_closure/keyframe_graph.hpp"
#include "mapper/core/loop_closure/loop_verifier.hpp"

namespace kintsugi::mapper {

/// Whether loops show that two parts of the map are one.
///
/// No drift bounds what may be found, and buildings repeat: a corridor looks the same from door to
/// door, and its loops agree with each other. So the loops must come from views that have little in
/// common, and be borne out by the others: of the keyframes that would see surface of the other
/// part, half must.
class JoinRule {
 public:
  using Keyframes = std::vector<std::shared_ptr<const Keyframe>>;

  struct Config {
    int min_views = 2;  ///< that have less than `min_common_share` of their surface in common
    double min_common_share = 0.5;
    double min_borne_out_share = 0.5;
    int max_compared = 16;  ///< keyframes; a registration takes some hundredths of a second

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// `verifier` outlives this object.
  /// @throws std::invalid_argument if the configuration is not valid
  JoinRule(const Config& config, const LoopVerifier& verifier);

  /// @param loops that agree, between the same two parts
  /// @param keyframes by number
  bool holds(const std::vector<Loop>& loops, const KeyframeGraph& graph, const Keyframes& keyframes,
             const DepthNoise& noise) const;

 private:
  int num_views(const std::vector<Loop>& loops, const KeyframeGraph& graph,
                const Keyframes& keyframes) const;
  std::vector<Loop> expected(const Loop& loop, const KeyframeGraph& graph,
                             const Keyframes& keyframes) const;

  Config config_;
  const LoopVerifier& verifier_;
};

}  // namespace kintsugi::mapper
