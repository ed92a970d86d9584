#pragma once
// Loop closure on a thread of its own.

#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <variant>
#include <vector>

#include "mapper/core/loop_closure/join_rule.hpp"
#include "mapper/core/loop_closure/keyframe_graph.hpp"
#include "mapper/core/loop_closure/loop_verifier.hpp"
#include "mapper/core/relocalization/keyframe_map.hpp"

namespace kintsugi::mapper {

/// A new keyframe, to be compared with those that the volume does not hold any more.
struct NewKeyframe {
  int number = 0;
  std::shared_ptr<const Keyframe> keyframe;
  /// The keyframe from which the camera was tracked to this one; none: it begins a part of the map.
  std::optional<int> from;
  double way_m = 0.0;                    ///< length of the camera's way from that
  std::optional<UnseenWay> unseen = {};  ///< to that; none: the first part of a camera
  Matrix6d information;                  ///< of its pose in the volume, see Registration
  std::vector<int> similar;              ///< keyframes that look alike, released ones only
  std::vector<bool> is_released;         ///< by number: whether its surface has left the volume
  DepthNoise noise;                      ///< of the camera, now
};

/// Where the keyframes are after loops were closed.
struct MapCorrection {
  std::vector<Pose> X_WK;         ///< of all keyframes up to the newest that was known
  std::vector<int> parts;         ///< in which they are, see KeyframeGraph::part_of()
  std::vector<Loop> loops;        ///< all that are confirmed
  int num_contradicted = 0;       ///< loops that were given up, so far
  double largest_motion_m = 0.0;  ///< of a keyframe, since the correction before
};

/// Compares each new keyframe with earlier ones that the volume does not hold any more, and
/// corrects the poses of all when loops are confirmed.
///
/// A keyframe is held by the one from which it was tracked, and by the oldest and the nearest of
/// those in the volume that see the same: as long as the volume holds a surface, tracking against
/// it does not drift.
///
/// Candidates are keyframes that look alike, and those that would see the same surface if tracking
/// had not drifted. The best few matches of a keyframe count.
///
/// The thread has a low priority. Corrections come out at a fixed time after the keyframe that
/// brought them, in device time, so that they do not depend on how fast the thread is; the caller
/// waits for one that is late.
class LoopCloser {
 public:
  struct Config {
    LoopVerifier::Config verifier;
    KeyframeGraph::Config graph;
    JoinRule::Config join;
    double delay_s = 0.5;     ///< from a keyframe to the correction that it brings, device time
    int max_by_position = 3;  ///< candidates that would see the same
    int max_matches = 2;  ///< of a keyframe in its part; with other parts all count, as rivals do
    /// Two keyframes that were tracked in the same volume and have at least this share of their
    /// surface in common hold each other: half of it, as with the next keyframe on a path.
    double min_common_share = 0.5;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::invalid_argument if the configuration is not valid
  explicit LoopCloser(const Config& config);
  ~LoopCloser();
  LoopCloser(const LoopCloser&) = delete;
  LoopCloser& operator=(const LoopCloser&) = delete;

  /// Keyframes come in the order of their numbers, from 0.
  void add(NewKeyframe added, std::int64_t utime);

  /// Loops between both places are as this view has them, see KeyframeGraph::renew(). Its keyframes
  /// have been added before.
  void add(SharedView view, std::int64_t utime);

  /// The newest correction that is due at this time; waits for it.
  /// @throws what the thread threw
  std::optional<MapCorrection> take_due(std::int64_t utime);

  /// The newest correction, after all keyframes; waits for it.
  /// @throws as take_due()
  std::optional<MapCorrection> drain();

  /// Time spent so far, milliseconds.
  double busy_ms() const;

  /// How many keyframes wait, or are being compared.
  std::size_t num_queued() const;

 private:
  struct Job {
    std::variant<NewKeyframe, SharedView> added;
    std::int64_t due_utime = 0;
  };

  void run();
  bool work_on(const NewKeyframe& added);
  bool work_on(const SharedView& view) { return graph_.renew(view); }
  MapCorrection correction();
  void append(Job job);
  int join(const std::vector<Loop>& loops, const DepthNoise& noise);
  void add_tracked(const NewKeyframe& added);
  std::vector<int> candidates_for(const NewKeyframe& added) const;
  double common_share(int later, int earlier, const Pose& X_EL) const;
  std::vector<Loop> matches_of(const NewKeyframe& added) const;

  const Config config_;
  const LoopVerifier verifier_;
  const JoinRule join_rule_;
  // Used by thread_ only:
  KeyframeGraph graph_;
  std::vector<std::shared_ptr<const Keyframe>> keyframes_;

  mutable std::mutex mutex_;
  std::condition_variable work_;  ///< signals that a job was queued, or stop_
  std::condition_variable done_;  ///< signals that a job ended, or failed
  std::deque<Job> queue_;         ///< the front is being worked on
  std::deque<std::pair<std::int64_t, MapCorrection>> finished_;  ///< by the time at which it is due
  std::exception_ptr failure_;
  double busy_ms_ = 0.0;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace kintsugi::mapper
