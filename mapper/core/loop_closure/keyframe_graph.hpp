#pragma once
// The keyframes of a map, the motions between them, and the loops that were found.

#include <optional>
#include <utility>
#include <vector>

#include "mapper/core/loop_closure/keyframe_tree.hpp"
#include "mapper/core/loop_closure/loop.hpp"
#include "mapper/core/pose_graph/pose_graph.hpp"

namespace kintsugi::mapper {

/// On the way to where a part of the map begins the camera was not tracked.
struct UnseenWay {
  int before = 0;           ///< the camera's last keyframe before it
  double distance_m = 0.0;  ///< how far the camera may have gone since then
};

/// Where keyframes are, according to tracking and loops.
///
/// U is the uncorrected map, in which the camera is tracked; W the corrected one, the same at
/// first.
///
/// A keyframe to which the camera was not tracked from another one begins a part of the map
/// (origin_of_part()). Parts are joined by loops between them. Those of guests, other mappers whose
/// keyframes are here, too, are parts like others, of another camera.
///
/// A loop in one part counts only when it is confirmed: when another loop, from another later
/// keyframe, agrees with it. For that both later keyframes must have been near each other on the
/// camera's way, and both earlier ones, too, so that the poses between them are as precise as
/// tracking in one volume; then the way from one later keyframe to the other over both loops is
/// where tracking has it, but for the uncertainty of the loops. Loops that lead farther than
/// tracking can drift are refused.
///
/// The way between two keyframes is that on which they are tracked from each other, and not how far
/// the camera has gone meanwhile: one that goes its round for the hundredth time is tracked in the
/// surface of the first.
///
/// Between two parts there is no such bound, only that on how far the camera can have gone while it
/// was lost. There agreeing loops are only proposed, if they are more than twice as many as those
/// that would put the parts elsewhere; JoinRule decides.
class KeyframeGraph {
 public:
  struct Config {
    /// Keyframes are near each other when the way between them is not longer than this: what one
    /// saw was still in the volume at the other.
    double near_m = 5.0;
    double max_drift_share = 0.02;  ///< of tracking, see Tracker
    double voxel_m = 4.5 / 512;
    PoseGraphConfig optimizer;

    /// @throws std::invalid_argument naming field, value and bound
    void validate() const;
  };

  /// @throws std::invalid_argument if the configuration is not valid
  explicit KeyframeGraph(const Config& config);

  /// Adds keyframe number size(). `from` is the keyframe from which the camera came, by a way of
  /// `way_m`; it is corrected with that until loops say more. Without one it begins a part, to
  /// which the camera came by an unseen way; without that, too, another camera did, which may be
  /// anywhere.
  /// @throws std::invalid_argument when there is no keyframe `from`, or none before the unseen way
  void add(const Pose& X_UK, std::optional<int> from, double way_m,
           std::optional<UnseenWay> unseen = {});

  /// Adds a motion that was tracked; X_FT is taken from the poses in U.
  /// @throws std::invalid_argument when a keyframe does not exist, or both are the same
  void add_tracked(int from, int to, const Matrix6d& information_T);

  /// Two keyframes, as a loop between them is to have them: of different parts, the one in the
  /// later part is the later one.
  std::pair<int, int> later_and_earlier(int a, int b) const;

  /// Takes a loop, and returns how many are confirmed by it, itself among them: 0, 2 or more, or 1
  /// when it agrees with confirmed ones. A loop between two parts confirms none.
  int offer(const Loop& loop);

  /// Takes a view that two places share. Confirmed loops between them are from now on as it has
  /// them, and it is one more: without that the motions that were tracked would pull the places
  /// apart again, and surface that is observed for hours moves by centimetres. Returns whether
  /// there are any such loops.
  bool renew(const SharedView& view);

  /// After a loop between two parts was offered: the loops that agree with it, itself among them,
  /// if they are to be preferred to those that do not; else none. Of a loop in one part none.
  std::vector<Loop> agreeing_to_join(const Loop& loop) const;

  /// Confirms loops between two parts: moves the later part to where the most certain of them puts
  /// it.
  void join(const std::vector<Loop>& loops);

  /// Whether two loops between the same parts put them to places too far from each other for both
  /// to be right.
  bool are_rivals(const Loop& a, const Loop& b) const;

  /// Moves the keyframes to where motions and confirmed loops want them. Loops that are
  /// contradicted are removed first, one after the other, the worst one first.
  /// @returns the largest distance that a keyframe moved, metres
  double optimize();

  int size() const { return static_cast<int>(nodes_.size()); }
  const Pose& X_UK(int number) const { return nodes_[number].X_UK; }
  const Pose& X_WK(int number) const { return X_WK_[number]; }
  const std::vector<Pose>& poses_W() const { return X_WK_; }
  /// The part of the map in which a keyframe is: of parts that are joined the first one.
  int part_of(int number) const { return parts_[nodes_[number].part].joined; }
  std::vector<int> parts() const;                                ///< part_of() each keyframe
  const std::vector<Loop>& loops() const { return confirmed_; }  ///< confirmed
  int num_contradicted() const { return num_contradicted_; }     ///< so far

 private:
  struct Node {
    Pose X_UK;
    int part;  ///< in which it was tracked
  };
  struct Part {
    int first;  ///< keyframe
    std::optional<UnseenWay> unseen;
    int joined;  ///< the first of the parts that it is joined with, or itself
  };

  void check_number(int number) const;
  double way_m(int a, int b) const;
  bool is_plausible(const Loop& loop) const;
  bool is_reachable(const Loop& loop) const;
  void move_part(const Loop& loop);
  double uncertainty_m(const Loop& a, const Loop& b, const Pose& X_LaLb) const;
  bool agree(const Loop& a, const Loop& b) const;
  PoseGraph pose_graph() const;

  Config config_;
  std::vector<Node> nodes_;
  KeyframeTree ways_;  ///< a tree for each part
  std::vector<Part> parts_;
  std::vector<Pose> X_WK_;
  std::vector<PoseEdge> tracked_;
  std::vector<Loop> confirmed_;
  std::vector<Loop> pending_;
  int num_contradicted_ = 0;
};

}  // namespace kintsugi::mapper
