#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <set>
#include <vector>

#include "segmenter/core/exact/edge_key.hpp"
#include "segmenter/core/exact/join_rule.hpp"

namespace kintsugi::segmenter::exact::testing {

/// Algorithm 1, one edge at a time, with the component of each point in a plain list.
class SlowSegmentation {
 public:
  SlowSegmentation(std::size_t num_points, const JoinRule& rule)
      : rule_(rule), labels_(num_points), weights_(num_points, 0.0F), sizes_(num_points, 1) {
    std::iota(labels_.begin(), labels_.end(), 0);
  }

  /// Lines 7-11; tells whether it joins.
  bool take(const EdgeKey& key) {
    const PointIndex a = labels_[key.a];
    const PointIndex b = labels_[key.b];
    if (a == b || !is_alive(key.a, key) || !is_alive(key.b, key)) return false;
    std::replace(labels_.begin(), labels_.end(), b, a);
    sizes_[a] += sizes_[b];
    weights_[a] = key.weight();
    return true;
  }
  std::set<EdgeKey> take_all(const std::set<EdgeKey>& edges) {
    std::set<EdgeKey> joined;
    for (const EdgeKey& key : edges) {
      if (take(key)) joined.insert(key);
    }
    return joined;
  }

  bool are_one(PointIndex x, PointIndex y) const { return labels_[x] == labels_[y]; }
  std::uint32_t size(PointIndex x) const { return sizes_[labels_[x]]; }
  /// Of the last join; 0: none.
  float weight(PointIndex x) const { return weights_[labels_[x]]; }
  double theta(PointIndex x) const { return rule_.theta(weight(x), size(x)); }
  bool is_alive(PointIndex x, const EdgeKey& key) const { return key.weight() < theta(x); }

 private:
  JoinRule rule_;
  std::vector<PointIndex> labels_;
  std::vector<float> weights_;        ///< by label
  std::vector<std::uint32_t> sizes_;  ///< by label
};

}  // namespace kintsugi::segmenter::exact::testing
