#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/core/exact/component_names.hpp"

namespace kintsugi::segmenter::exact::testing {

/// Names of components against the forest, update after update.
class NamesCheck {
 public:
  NamesCheck(const Vertices& vertices, const JoinForest& forest, const ComponentNames& names)
      : vertices_(vertices), forest_(forest), names_(names) {}

  /// To be called after each update; points that came are new, even at a place used before.
  void expect(const std::vector<PointIndex>& added) {
    const std::span<const ComponentId> of_points = names_.of_points();
    ASSERT_EQ(of_points.size(), vertices_.size());
    std::map<ComponentId, PointIndex> roots;
    std::map<PointIndex, ComponentId> names;
    for (PointIndex x = 0; x < of_points.size(); ++x) {
      if (vertices_[x].is_gone) {
        EXPECT_EQ(of_points[x], kNoComponent) << "of " << x << ", which is gone";
        continue;
      }
      const PointIndex root = forest_.root(x);
      ASSERT_LT(of_points[x], of_points.size());
      EXPECT_EQ(roots.try_emplace(of_points[x], root).first->second, root) << "of " << x;
      EXPECT_EQ(names.try_emplace(root, of_points[x]).first->second, of_points[x]) << "of " << x;
      EXPECT_EQ(names_.root(of_points[x]), root) << "of " << x;
    }
    before_.resize(of_points.size(), kNoComponent);
    for (const PointIndex x : added) before_[x] = kNoComponent;
    expect_majorities_keep_names();
    expect_changed();
    before_.assign(of_points.begin(), of_points.end());
  }

 private:
  /// Where most points of a component had one name, and it has most of the points of that name, it
  /// keeps it.
  void expect_majorities_keep_names() const {
    std::map<ComponentId, int> num_before;
    std::map<ComponentId, int> num_now;
    std::map<std::pair<ComponentId, ComponentId>, int> num_shared;
    for (PointIndex x = 0; x < before_.size(); ++x) {
      const PointIndex name = names_.of_points()[x];
      ++num_before[before_[x]];
      ++num_now[name];
      ++num_shared[{before_[x], name}];
    }
    for (const auto& [names, num_points] : num_shared) {
      const auto [old_name, name] = names;
      if (old_name == kNoComponent || name == kNoComponent) continue;
      if (2 * num_points > num_before[old_name] && 2 * num_points > num_now[name]) {
        EXPECT_EQ(name, old_name);
      }
    }
  }

  void expect_changed() const {
    const std::span<const ComponentId> of_points = names_.of_points();
    std::vector<PointIndex> expected;
    for (PointIndex x = 0; x < of_points.size(); ++x) {
      if (!vertices_[x].is_gone && of_points[x] != before_[x]) expected.push_back(x);
    }
    const std::vector<PointIndex> changed(names_.changed().begin(), names_.changed().end());
    EXPECT_EQ(changed, expected);
  }

  const Vertices& vertices_;
  const JoinForest& forest_;
  const ComponentNames& names_;
  std::vector<ComponentId> before_;
};

}  // namespace kintsugi::segmenter::exact::testing
