#include "segmenter/evaluation/live/live_evaluation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <unordered_map>

#include "segmenter/query/measured_point.hpp"

namespace kintsugi::segmenter {
namespace {

constexpr double kBehind_m = 0.1;
constexpr double kRayRadius_vox = 2.0;  // the default of kintsugi-query --ray
constexpr double kMaxRange_m = 10.0;    // of rays; longer than rooms are
// A plane through the middle of a region has one point a squared voxel there. With less than a
// quarter of them a region has the rim of a surface, and whether it is seen is chance.
constexpr double kMinFilling = 0.25;

/// The smallest value that at least this share of the values does not exceed.
std::optional<double> quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nullopt;
  const double rank = std::ceil(share * static_cast<double>(values.size()));
  const auto place = static_cast<std::ptrdiff_t>(std::max(rank, 1.0)) - 1;
  std::nth_element(values.begin(), values.begin() + place, values.end());
  return values[static_cast<std::size_t>(place)];
}

void count(const std::optional<SegmentPoint>& answer, const MeasuredPoint& measured,
           double radius_m, QueryCounts& counts) {
  ++counts.num_asked;
  if (!answer) return;
  ++counts.num_answered;
  counts.num_wrong += (answer->point_W - measured.point_W()).norm() > radius_m ? 1 : 0;
  const double along_m = (answer->point_W - measured.ray.origin_W).dot(measured.ray.direction_W);
  counts.num_behind += along_m - measured.distance_m > kBehind_m ? 1 : 0;
}

}  // namespace

LiveEvaluation::LiveEvaluation(const LiveConfig& config)
    : config_(config),
      map_(config.radius_m, config.region_m),
      sights_(config.radius_m, config.min_frames) {}

void LiveEvaluation::add(const CameraView& view, double now_s) {
  if (num_views_++ == 0) first_s_ = now_s;
  last_s_ = now_s;
  map_.settle(now_s);
  if (!is_located(view.state)) {
    ++counts_.num_lost;
    return;
  }
  sights_.add(view, now_s);
  if (now_s - first_s_ < config_.skip_s) return;
  const std::vector<MeasuredPoint> measured = measured_points(view);
  ++counts_.num_views;
  if (const auto share = covered_share(map_, measured, config_.radius_m)) {
    covered_.push_back(*share);
  }
  look_at_centre(view);
  ask_pixels(view);
}

void LiveEvaluation::look_at_centre(const CameraView& view) {
  const auto measured =
      measured_point(view, 0.5 * (view.intrinsics.width - 1), 0.5 * (view.intrinsics.height - 1));
  if (!measured) return;
  ++counts_.num_centre;
  if (const auto answer = answer_pixel(map_, *measured, config_.radius_m)) {
    centres_.push_back(*answer);
  }
}

void LiveEvaluation::ask_pixels(const CameraView& view) {
  const auto pixel_of = [&](int i, int size) { return (i + 0.5) * size / config_.grid - 0.5; };
  const double pixel_radius = pixel_radius_m(map_.resolution_m());
  for (int j = 0; j < config_.grid; ++j) {
    for (int i = 0; i < config_.grid; ++i) {
      const auto measured = measured_point(view, pixel_of(i, view.intrinsics.width),
                                           pixel_of(j, view.intrinsics.height));
      if (!measured) continue;
      count(answer_pixel(map_, *measured, pixel_radius), *measured, pixel_radius, counts_.pixel);
      count(answer_ray(map_, measured->ray, kRayRadius_vox * map_.resolution_m(), kMaxRange_m),
            *measured, pixel_radius, counts_.ray);
    }
  }
}

LiveReport LiveEvaluation::report() {
  map_.settle(last_s_);
  LiveReport report = counts_;
  report.duration_s = last_s_ - first_s_;
  if (!covered_.empty()) {
    const double sum = std::accumulate(covered_.begin(), covered_.end(), 0.0);
    report.covered_mean = sum / static_cast<double>(covered_.size());
    report.covered_worst_tenth = quantile(covered_, 0.1);
  }
  report.revisions_sent = map_.revisions_sent();
  report.points_sent = map_.points_sent();
  report.num_points = map_.num_points();
  report_centre(report);
  report_delays(report);
  report_regions(report);
  return report;
}

// Right: where the point was that was answered, the final map has the same segment, or the one into
// which it was merged.
void LiveEvaluation::report_centre(LiveReport& report) const {
  report.num_centre_covered = std::ssize(centres_);
  for (const SegmentPoint& centre : centres_) {
    const auto final_point = nearest_label(map_, centre.point_W, config_.radius_m);
    const bool is_right =
        final_point && final_point->segment_id == map_.heirs().last_heir(centre.segment_id);
    report.num_centre_right += is_right ? 1 : 0;
  }
}

// Of one point in each region of surface in the final map, the one nearest to its middle.
void LiveEvaluation::report_delays(LiveReport& report) const {
  struct Sample {
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
    double distance_m = std::numeric_limits<double>::infinity();  ///< from the middle
  };
  std::unordered_map<CellKey, Sample, CellKeyHash> samples;
  map_.for_each_point([&](const Eigen::Vector3d& p_W) {
    const Eigen::Vector3d in_region = (p_W / config_.region_m).array() - 0.5;
    const double distance_m =
        config_.region_m * (in_region.array() - in_region.array().round()).matrix().norm();
    Sample& sample = samples[cell_at(p_W, config_.region_m)];
    if (distance_m < sample.distance_m) sample = {p_W, distance_m};
  });
  std::vector<double> delays_s;
  for (const auto& [region, sample] : samples) {
    const Eigen::Vector3d& p_W = sample.p_W;
    const auto seen_s = sights_.seen_s(p_W);
    const auto label_s = map_.first_labels().label_s(p_W);
    if (seen_s && label_s) delays_s.push_back(std::max(0.0, *label_s - *seen_s));
  }
  report.num_delays = std::ssize(delays_s);
  report.delay_median_s = quantile(delays_s, 0.5);
  report.delay_p99_s = quantile(delays_s, 0.99);
}

void LiveEvaluation::report_regions(LiveReport& report) const {
  const double side_vox = config_.region_m / std::max(map_.resolution_m(), 1e-6F);
  const double min_points = kMinFilling * side_vox * side_vox;
  std::set<std::uint32_t> segments;
  for (const auto& [key, region] : map_.regions().regions()) {
    for (const auto& [id, num] : region.counts) segments.insert(id);
    if (region.num_points() == 0 || region.num_points() < min_points) continue;
    ++report.num_regions;
    report.num_changes += region.num_changes;
    report.num_unchanged += region.num_changes == 0 ? 1 : 0;
  }
  report.num_segments = std::ssize(segments);
  report.num_changes_by_merge = map_.regions().num_changes_by_merge();
  report.num_handovers = map_.regions().num_handovers();
}

}  // namespace kintsugi::segmenter
