#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace kintsugi::mapper {

/// From which keyframe the camera came to which. Keyframes to which it came from elsewhere are
/// roots of trees of their own.
class KeyframeTree {
 public:
  /// Adds keyframe number size(), `distance_m` from that from which the camera came to it; without
  /// one no way leads to it, and it is the root of a tree of its own.
  void add(std::optional<int> from, double distance_m);

  /// Whether a keyframe is this one, or the camera's way to it from this one was not longer than
  /// `reach_m`; by number. Of one that is not there yet: none.
  std::vector<bool> within(int keyframe, double reach_m) const;

  /// Length of the way between two keyframes; infinite where no way leads from one to the other.
  double way_m(int a, int b) const;
  /// The same; from one tree to another the shortest way over these joins, pairs of keyframes that
  /// saw the same surface.
  double way_m(int a, int b, std::span<const std::pair<int, int>> joins) const;
  /// The same to all keyframes, by number.
  std::vector<double> ways_m(int from, std::span<const std::pair<int, int>> joins) const;

  /// The keyframe from which the camera came to this one; itself for one without.
  int from(int keyframe) const { return nodes_[keyframe].from; }
  int size() const { return static_cast<int>(nodes_.size()); }

 private:
  struct Node {
    int from = 0;
    double distance_m = 0.0;
    int level = 0;  ///< steps from it to the root
    int root = 0;
    std::vector<int> to;
  };

  std::vector<double> least_ways_m(int from, std::span<const std::pair<int, int>> joins,
                                   std::optional<int> until = {}) const;

  std::vector<Node> nodes_;
};

}  // namespace kintsugi::mapper
