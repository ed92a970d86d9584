#include "mapper/core/loop_closure/join_rule.hpp"

#include <algorithm>

#include "lcmtypes/base/argument_check.hpp"
#include "mapper/core/loop_closure/common_view.hpp"

namespace kintsugi::mapper {

void JoinRule::Config::validate() const {
  check_range("min_views", min_views, 1, 1000);
  check_range("min_common_share", min_common_share, 0.0, 1.0);
  check_range("min_borne_out_share", min_borne_out_share, 0.0, 1.0);
  check_range("max_compared", max_compared, 1, 1000);
}

JoinRule::JoinRule(const Config& config, const LoopVerifier& verifier)
    : config_((config.validate(), config)), verifier_(verifier) {}

bool JoinRule::holds(const std::vector<Loop>& loops, const KeyframeGraph& graph,
                     const Keyframes& keyframes, const DepthNoise& noise) const {
  if (num_views(loops, graph, keyframes) < config_.min_views) return false;
  const Loop& best = *std::ranges::min_element(loops, {}, &Loop::sigma_m);
  const std::vector<Loop> would_see = expected(best, graph, keyframes);
  const std::size_t count =
      std::min(would_see.size(), static_cast<std::size_t>(config_.max_compared));
  if (count == 0) return false;
  std::size_t num_seen = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Loop& pair = would_see[i * would_see.size() / count];  // spread over all
    const auto match = verifier_.match_expected(*keyframes[pair.later], *keyframes[pair.earlier],
                                                pair.X_EL, noise);
    if (!match) continue;
    const Loop seen{pair.later, pair.earlier, match->X_EL, match->information_L, match->sigma_m};
    num_seen += graph.are_rivals(best, seen) ? 0 : 1;
  }
  return static_cast<double>(num_seen) >= config_.min_borne_out_share * static_cast<double>(count);
}

/// Counts loops whose later keyframe has little in common with those counted before.
int JoinRule::num_views(const std::vector<Loop>& loops, const KeyframeGraph& graph,
                        const Keyframes& keyframes) const {
  std::vector<int> views;
  for (const Loop& loop : loops) {
    const auto is_like = [&](int view) {
      const Pose X_VL = graph.X_WK(view).inverse(Eigen::Isometry) * graph.X_WK(loop.later);
      return common_share(*keyframes[loop.later], *keyframes[view], X_VL) >=
             config_.min_common_share;
    };
    if (std::ranges::none_of(views, is_like)) views.push_back(loop.later);
  }
  return static_cast<int>(views.size());
}

/// If the loop is right: the keyframes of the later part that see surface which keyframes of the
/// earlier part see, with the one that sees most of it.
std::vector<Loop> JoinRule::expected(const Loop& loop, const KeyframeGraph& graph,
                                     const Keyframes& keyframes) const {
  const Pose motion_W =
      graph.X_WK(loop.earlier) * loop.X_EL * graph.X_WK(loop.later).inverse(Eigen::Isometry);
  std::vector<Loop> pairs;
  for (int later = 0; later < graph.size(); ++later) {
    if (graph.part_of(later) != graph.part_of(loop.later)) continue;
    Loop pair;
    double most = 0.0;
    for (int earlier = 0; earlier < graph.size(); ++earlier) {
      if (graph.part_of(earlier) != graph.part_of(loop.earlier)) continue;
      const Pose X_EL = graph.X_WK(earlier).inverse(Eigen::Isometry) * motion_W * graph.X_WK(later);
      const double share = common_share(*keyframes[later], *keyframes[earlier], X_EL);
      if (share <= most) continue;
      most = share;
      pair = {.later = later, .earlier = earlier, .X_EL = X_EL};
    }
    if (most >= config_.min_common_share) pairs.push_back(pair);
  }
  return pairs;
}

}  // namespace kintsugi::mapper
