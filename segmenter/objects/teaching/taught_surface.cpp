#include "segmenter/objects/teaching/taught_surface.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "segmenter/core/points/admission.hpp"
#include "segmenter/preprocess/nearest_neighbours.hpp"

namespace kintsugi::segmenter {
namespace {

/// "the nearest ids are 10 and 13".
std::string neighbours_text(const std::set<std::uint32_t>& ids, std::uint32_t id) {
  const auto after = ids.upper_bound(id);
  std::string text;
  if (after != ids.begin()) text = std::to_string(*std::prev(after));
  if (after != ids.end()) text += (text.empty() ? "" : " and ") + std::to_string(*after);
  return text.empty() ? "it has none" : "the nearest ids are " + text;
}

void check_ids(const ObservedMap& map, const std::vector<std::uint32_t>& ids) {
  if (ids.empty()) throw std::runtime_error("no segments are named");
  std::set<std::uint32_t> known(map.segment_ids.begin(), map.segment_ids.end());
  known.erase(0);
  for (const std::uint32_t id : ids) {
    if (known.contains(id)) continue;
    throw std::runtime_error(map.source + ": there is no segment " + std::to_string(id) +
                             " among its " + std::to_string(known.size()) + "; " +
                             neighbours_text(known, id));
  }
}

std::vector<std::uint32_t> segments_mostly_in(const ObservedMap& map,
                                              const std::vector<std::uint32_t>& indices) {
  std::map<std::uint32_t, std::int64_t> balance;  // of points inside over points outside
  for (const std::uint32_t i : indices) balance[map.segment_ids[i]] += 2;
  for (const std::uint32_t id : map.segment_ids) {
    const auto found = balance.find(id);
    if (found != balance.end()) --found->second;
  }
  std::vector<std::uint32_t> ids;
  for (const auto& [id, points] : balance) {
    if (id != 0 && points > 0) ids.push_back(id);
  }
  return ids;
}

}  // namespace

TaughtSurface surface_of_segments(const ObservedMap& map, std::vector<std::uint32_t> ids) {
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  check_ids(map, ids);
  TaughtSurface surface;
  for (std::size_t i = 0; i < map.segment_ids.size(); ++i) {
    if (std::binary_search(ids.begin(), ids.end(), map.segment_ids[i])) {
      surface.indices.push_back(static_cast<std::uint32_t>(i));
    }
  }
  surface.segment_ids = std::move(ids);
  return surface;
}

TaughtSurface surface_at(const ObservedMap& map, std::span<const CloudPoint> points_W) {
  TaughtSurface surface;
  if (points_W.empty()) return surface;
  std::vector<CloudPoint> queries;
  std::vector<std::uint32_t> candidates;
  for (std::size_t i = 0; i < map.points_W.size(); ++i) {
    if (reason_to_reject_position(map.points_W[i]).has_value()) continue;
    queries.push_back(map.points_W[i]);
    candidates.push_back(static_cast<std::uint32_t>(i));
  }
  NearestNeighbours::Result nearest;
  NearestNeighbours(points_W).find(queries, 1, nearest);
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (nearest.squared_distances[i] < map.resolution_m * map.resolution_m) {
      surface.indices.push_back(candidates[i]);
    }
  }
  surface.segment_ids = segments_mostly_in(map, surface.indices);
  return surface;
}

std::vector<CloudPoint> points_of(const ObservedMap& map, const TaughtSurface& surface) {
  std::vector<CloudPoint> points_W;
  points_W.reserve(surface.indices.size());
  for (const std::uint32_t i : surface.indices) points_W.push_back(map.points_W[i]);
  return points_W;
}

}  // namespace kintsugi::segmenter
