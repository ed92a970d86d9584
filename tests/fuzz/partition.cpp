#include "tests/fuzz/partition.hpp"

#include "segmenter/core/batch/batch_engine.hpp"
#include "segmenter/core/parameters/engine_config.hpp"

namespace kintsugi::segmenter::fuzz {

Partition batch_partition(std::span<const CloudPoint> points_W, const EngineConfig& config) {
  PointCloud cloud;
  cloud.add_slice(0, points_W);
  BatchEngine engine(cloud, config);
  engine.update(cloud.take_change());
  std::vector<PointIndex> all(cloud.size());
  for (PointIndex i = 0; i < cloud.size(); ++i) all[i] = i;
  return partition_of(engine, engine.unmerged_components(), all);
}

BatchPartitions batch_partitions(const PointCloud& cloud, std::span<const PointIndex> live,
                                 const EngineConfig& config) {
  BatchEngine engine(cloud, config);
  engine.update(cloud.everything());
  return {partition_of(engine, engine.unmerged_components(), live),
          partition_of(engine, engine.components(), live)};
}

Partition partition_of(const SegmentationEngine& engine, std::span<const ComponentId> components,
                       std::span<const PointIndex> live) {
  constexpr PointIndex kNone = UINT32_MAX;
  std::vector<PointIndex> smallest(components.size(), kNone);
  Partition partition;
  for (PointIndex k = 0; k < live.size(); ++k) {
    const ComponentId component = components[live[k]];
    PointIndex& label = smallest[component];
    if (label == kNone) label = k;
    partition.labels.push_back(label);
    partition.thetas.push_back(label == k ? engine.theta(component) : partition.thetas[label]);
  }
  return partition;
}

}  // namespace kintsugi::segmenter::fuzz
