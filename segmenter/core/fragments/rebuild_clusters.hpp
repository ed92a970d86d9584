#pragma once

#include <vector>

#include "segmenter/core/fragments/base_components.hpp"
#include "segmenter/core/fragments/clusters.hpp"
#include "segmenter/core/parameters/engine_config.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {

/// Finds all clusters by the fragment step over all points; `rows` are those, or null. Returns for
/// each point of the cloud a point of the component that its segment is named after; unspecified
/// for points that are gone.
std::vector<PointIndex> rebuild_clusters(const PointCloud& cloud, const EngineConfig& config,
                                         const BaseComponents& components, Clusters& clusters,
                                         const PointRows* rows);

}  // namespace kintsugi::segmenter
