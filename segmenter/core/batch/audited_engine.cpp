#include "segmenter/core/batch/audited_engine.hpp"

#include <iomanip>
#include <limits>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace kintsugi::segmenter {
namespace {

/// A segment by its first point and its theta.
std::string describe(const PointCloud& cloud, PointIndex label, double theta) {
  if (label == kNoComponent) return "in no segment";
  const PointId first = cloud.id_of(label);
  std::ostringstream text;
  text << "in the segment of point " << first.index << " of slice " << first.slice_id << ", theta "
       << std::setprecision(std::numeric_limits<double>::max_digits10) << theta;
  return text.str();
}

}  // namespace

AuditedEngine::AuditedEngine(std::unique_ptr<SegmentationEngine> engine, const PointCloud& cloud,
                             const EngineConfig& config)
    : engine_(std::move(engine)), cloud_(cloud), reference_(cloud, config) {}

RunStatistics AuditedEngine::update(const CloudChange& change) {
  const RunStatistics statistics = engine_->update(change);
  reference_.update(change);
  ++num_updates_;
  compare(engine_->unmerged_components(), reference_.unmerged_components());
  compare(engine_->components(), reference_.components());
  return statistics;
}

void AuditedEngine::compare(std::span<const ComponentId> components,
                            std::span<const ComponentId> expected) const {
  const std::vector<PointIndex> labels = canonical_labels(components);
  const std::vector<PointIndex> expected_labels = canonical_labels(expected);
  for (PointIndex i = 0; i < cloud_.size(); ++i) {
    const auto theta_of = [](const SegmentationEngine& engine, ComponentId component) {
      return component == kNoComponent ? 0.0 : engine.theta(component);
    };
    const double theta = theta_of(*engine_, components[i]);
    const double expected_theta = theta_of(reference_, expected[i]);
    if (labels[i] == expected_labels[i] && theta == expected_theta) continue;
    const PointId id = cloud_.id_of(i);
    throw AuditError("audit: after update " + std::to_string(num_updates_) + " point " +
                     std::to_string(id.index) + " of slice " + std::to_string(id.slice_id) +
                     " is " + describe(cloud_, labels[i], theta) + "; with batch it is " +
                     describe(cloud_, expected_labels[i], expected_theta));
  }
}

}  // namespace kintsugi::segmenter
