#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "segmenter/core/batch/segment_forest.hpp"
#include "segmenter/core/engine/incremental_engine.hpp"
#include "segmenter/core/graph/edge.hpp"
#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter {

/// alpha(c) = 1 - beta^c (Eq. 4): the share of discrepant edges above which round c votes to
/// segment an old segment again.
double vote_threshold(double beta, int c);

/// Mode `voting`: the paper's incremental segmentation, Algorithms 2-5. An update segments the set
/// D of new points. As long as the result disagrees with old segments at the border of D, the vote
/// adds such segments to D, and D is segmented again.
///
/// The paper's map only grows. Here points can also be removed: what is left of their segments is
/// then in D from the first round on.
class VotingEngine final : public IncrementalEngine {
 public:
  VotingEngine(const PointCloud& cloud, const EngineConfig& config);

  RunStatistics update(const CloudChange& change) override;
  void resume(const CloudChange& everything, std::span<const ComponentId> components,
              std::span<const double> thetas) override;
  std::span<const ComponentId> components() const override { return components_; }
  std::span<const PointIndex> changed() const override { return changed_; }
  double theta(ComponentId component) const override;
  const NeighbourIndex& neighbour_index() const override { return *index_; }
  PointIndex point_of(ComponentId component) const override { return component; }
  std::size_t bytes() const override;

 private:
  std::vector<PointIndex> remove_points(std::span<const PointIndex> removed);
  void add_points(std::span<const PointIndex> added);
  void add_to_D(std::span<const PointIndex> points);
  void extend_graph(std::span<const PointIndex> added);
  std::int64_t segment_graph();
  std::vector<PointIndex> vote(int c);
  void append_segment(PointIndex representative, std::vector<PointIndex>& points) const;
  void commit();
  bool is_in_D(PointIndex i) const { return round_added_[i] >= first_round_; }

  const PointCloud& cloud_;
  EngineConfig config_;
  std::unique_ptr<NeighbourIndex> index_;

  // The partition S. While D is segmented, only forest_ changes.
  SegmentForest forest_;
  std::vector<ComponentId> components_;
  std::vector<PointIndex> next_;               ///< the next point of the segment, in a circle
  std::vector<PointIndex> representative_at_;  ///< by root in forest_
  std::vector<PointIndex> changed_;

  // The update: D and its graph. Rounds are numbered over all updates, so nothing has to be
  // cleared.
  std::vector<PointIndex> D_;
  std::vector<Edge> inner_edges_;   ///< both ends in D, undirected, i < j
  std::vector<Edge> border_edges_;  ///< i in D, j in D^B, weight from i to j
  std::uint32_t first_round_ = 1;   ///< of this update
  std::uint32_t round_ = 1;
  std::vector<std::uint32_t> round_added_;  ///< by point: the round in which it was added to D last
  std::vector<std::uint32_t>
      round_discrepant_;  ///< by point: the round in which it was in D^Delta last

  struct Ballot {
    std::uint32_t num_edges = 0;             ///< from D to the segment
    std::uint32_t num_discrepant_edges = 0;  ///< of these, to points in D^Delta
  };
  std::vector<Ballot> ballots_;  ///< by representative; zero outside vote()
};

}  // namespace kintsugi::segmenter
