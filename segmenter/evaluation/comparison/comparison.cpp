#include "segmenter/evaluation/comparison/comparison.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/base/stopwatch.hpp"
#include "segmenter/core/make_engine.hpp"
#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/core/points/point_cloud.hpp"

namespace kintsugi::segmenter {
namespace {

using Labels = std::vector<std::uint32_t>;

/// The final map: its points in order of slice and index, with their true instances.
class KnownMap {
 public:
  KnownMap(const RecordedSession& session, const Truth& truth, const ComparisonConfig& config)
      : quality_(config.quality), objects_(truth.objects()) {
    for (const CloudSlice* slice : session.newest_slices()) {
      cloud_.add_slice(slice->id, slice->points_W);
    }
    const double resolution_m = session.resolution_m();
    instances_ = instances_at(cloud_.points_W(), truth, config.match_distance_vox * resolution_m);
    quality_.boundary = {.radius_m = config.boundary_radius_vox * resolution_m,
                         .tolerance_m = config.boundary_tolerance_vox * resolution_m};
  }

  const PointCloud& cloud() const { return cloud_; }

  /// @param given the segment_id of the points of each slice, rejected ones included
  Labels accepted(const std::vector<Labels>& given) const {
    Labels labels;
    for (std::size_t s = 0; s < given.size(); ++s) {
      const SliceRecord& slice = cloud_.slices()[s];
      for (PointIndex k = 0; k < slice.count; ++k) {
        labels.push_back(given[s][static_cast<std::size_t>(slice.index_of(k))]);
      }
    }
    return labels;
  }

  /// Segments with the parameters of `result` and sets its time and quality.
  void segment(ComparedResult& result) const {
    const CloudChange everything = cloud_.everything();
    const Stopwatch watch;
    const auto engine = make_engine("batch", cloud_, result.variant.engine);
    engine->update(everything);
    result.segmentation_ms = watch.elapsed_ms();
    Labels labels(engine->components().begin(), engine->components().end());
    for (std::uint32_t& label : labels) ++label;  // above kNoSegment
    assess(labels, result);
  }

  void assess(const Labels& labels, ComparedResult& result) const {
    result.quality = assess_quality(cloud_.points_W(), instances_, labels, objects_, quality_);
    if (result.quality.num_points == 0) {
      throw std::runtime_error(
          "no point of the map is within reach of the truth: do the two share "
          "a frame?");
    }
  }

 private:
  PointCloud cloud_;
  Labels instances_;
  QualityConfig quality_;
  std::set<std::uint32_t> objects_;
};

ParameterSet variant_of(const std::string& name, const ComparisonConfig& config) {
  if (name == kGivenLabels) return {.name = name, .engine = {}, .parameter = ""};
  return {
      .name = name, .engine = name == kGivenEngine ? config.engine : preset(name), .parameter = ""};
}

}  // namespace

void ComparisonConfig::validate() const {
  require(!presets.empty(), "presets is empty, must name at least one");
  for (const std::string& name : presets) {
    require(std::ranges::count(presets, name) == 1,
            std::string("presets names '").append(name).append("' twice"));
    if (name != kGivenLabels && name != kGivenEngine) preset(name);  // throws
  }
  engine.validate();
  require(match_distance_vox > 0.0, "match_distance_vox", match_distance_vox, "> 0");
  QualityConfig in_voxels = quality;
  in_voxels.boundary = {.radius_m = boundary_radius_vox, .tolerance_m = boundary_tolerance_vox};
  in_voxels.validate();
}

Comparison compare_parameters(const RecordedSession& session, const Truth& truth,
                              const ComparisonConfig& config, const OnComparedResult& on_result) {
  config.validate();
  const bool wants_labels = std::ranges::count(config.presets, kGivenLabels) > 0;
  require(!wants_labels || !session.segment_ids.empty(),
          "presets names 'labels', but " + session.source + " has no segment_id");
  Comparison comparison;
  comparison.config = config;
  comparison.source = session.source;
  comparison.truth_source = truth.source;
  comparison.resolution_m = session.resolution_m();
  comparison.instances = truth.instances;
  comparison.remarks = session.remarks;
  const KnownMap map(session, truth, config);
  comparison.num_points = map.cloud().num_live();
  comparison.num_rejected = map.cloud().num_rejected();

  const auto sweep = config.sweep ? sweep_around(preset("objects")) : std::vector<ParameterSet>{};
  const std::size_t num_results = config.presets.size() + sweep.size();
  const auto add = [&](ParameterSet variant, std::vector<ComparedResult>& results) {
    ComparedResult& result = results.emplace_back();
    result.variant = std::move(variant);
    result.variant.engine.resolution_m = comparison.resolution_m;
    if (result.variant.name == kGivenLabels) {
      map.assess(map.accepted(session.segment_ids), result);
    } else {
      map.segment(result);
    }
    if (on_result) on_result(result, num_results);
  };
  for (const std::string& name : config.presets) add(variant_of(name, config), comparison.presets);
  for (const ParameterSet& variant : sweep) add(variant, comparison.sweep);
  return comparison;
}

}  // namespace kintsugi::segmenter
