#include "segmenter/evaluation/paper/theta_history.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

#include "segmenter/core/batch/felzenszwalb.hpp"
#include "segmenter/core/batch/segment_forest.hpp"
#include "segmenter/core/graph/build_graph.hpp"
#include "segmenter/core/graph/make_neighbour_index.hpp"
#include "segmenter/core/graph/neighbour_index.hpp"
#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr std::int32_t kNone = -1;

/// A piece of a segment: a single point, or what a join made of two pieces.
struct Piece {
  double theta = 0.0;
  std::int64_t num_points = 1;
  std::int32_t larger = kNone;  // of the two
};

/// The tree of joins of a cloud, as join_segments() reports them.
class JoinTree {
 public:
  JoinTree(const SegmentForest& forest, double threshold)
      : forest_(forest),
        pieces_(forest.size(), Piece{threshold, 1, kNone}),
        piece_of_(forest.size()) {
    std::iota(piece_of_.begin(), piece_of_.end(), 0);
  }

  void joined(const Edge& /*edge*/, PointIndex host, PointIndex guest) {
    const std::int32_t a = std::min(piece_of_[host], piece_of_[guest]);
    const std::int32_t b = std::max(piece_of_[host], piece_of_[guest]);
    piece_of_[host] = static_cast<std::int32_t>(pieces_.size());
    pieces_.push_back({forest_.theta_at(host), pieces_[a].num_points + pieces_[b].num_points,
                       pieces_[b].num_points > pieces_[a].num_points ? b : a});
  }
  void rejected(const Edge& /*edge*/) {}

  ThetaHistory history_of(PointIndex point) const {
    ThetaHistory history;
    for (std::int32_t i = piece_of_[forest_.root(point)]; i != kNone; i = pieces_[i].larger) {
      history.theta.push_back(pieces_[i].theta);
      history.num_points.push_back(pieces_[i].num_points);
    }
    std::reverse(history.theta.begin(), history.theta.end());
    std::reverse(history.num_points.begin(), history.num_points.end());
    return history;
  }

 private:
  const SegmentForest& forest_;
  std::vector<Piece> pieces_;           // the points, then one for each join
  std::vector<std::int32_t> piece_of_;  // the last one, by root
};

}  // namespace

std::vector<ThetaHistory> theta_histories(const PointCloud& cloud,
                                          std::span<const std::uint32_t> labels,
                                          std::span<const std::uint32_t> segments,
                                          const EngineConfig& config) {
  assert(labels.size() == cloud.size());
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> label_of;  // of each of them
  for (PointIndex i = 0; i < cloud.size(); ++i) {
    if (std::find(segments.begin(), segments.end(), labels[i]) == segments.end()) continue;
    points_W.push_back(cloud[i]);
    label_of.push_back(labels[i]);
  }
  PointCloud part;
  part.add_slice(0, points_W);
  const auto index = make_neighbour_index(config.neighbour_search, part, config.radius_m());
  index->insert(part.take_change().added);
  std::vector<Edge> edges = build_graph(part, *index, config.edge_weight(), config.max_weight());
  std::erase_if(edges, [&](const Edge& edge) { return label_of[edge.i] != label_of[edge.j]; });

  SegmentForest forest(config.threshold, config.scale);
  forest.grow(part.size());
  JoinTree tree(forest, config.threshold);
  join_segments(edges, forest, tree);
  std::vector<ThetaHistory> histories;
  for (const std::uint32_t segment : segments) {
    const auto member = std::find(label_of.begin(), label_of.end(), segment);
    assert(member != label_of.end());
    histories.push_back(tree.history_of(static_cast<PointIndex>(member - label_of.begin())));
    histories.back().label = segment;
  }
  return histories;
}

}  // namespace kintsugi::segmenter
