#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "segmenter/core/exact/join_history.hpp"
#include "segmenter/core/exact/join_rule.hpp"
#include "segmenter/core/exact/tree_edges.hpp"
#include "segmenter/core/exact/vertex.hpp"

namespace kintsugi::segmenter::exact::testing {

/// Compares what the vertices store of the joins of a host with its definition.
class HistoryCheck {
 public:
  HistoryCheck(const Vertices& vertices, const TreeEdges& edges, const JoinRule& rule)
      : vertices_(vertices), edges_(edges), rule_(rule) {}

  /// Returns the depth of the tree.
  std::size_t expect_sound(PointIndex host) const {
    const Subtree all = expect_sound_subtree(vertices_[host].history);
    expect_joins_in_order(host, all.children);
    const std::uint32_t last_weight_bits =
        all.children.empty() ? 0 : vertices_[all.children.back()].weight_bits;
    EXPECT_EQ(vertices_[host].last_weight_bits, last_weight_bits) << "of host " << host;
    return all.depth;
  }

 private:
  struct Subtree {
    std::vector<PointIndex> children;  ///< in order
    std::size_t depth = 0;
  };

  Subtree expect_sound_subtree(PointIndex t) const {
    if (t == kNone) return {};
    const Vertex& v = vertices_[t];
    Subtree tree = expect_sound_subtree(v.left);
    const Subtree right = expect_sound_subtree(v.right);
    tree.depth = 1 + std::max(tree.depth, right.depth);
    tree.children.push_back(t);
    tree.children.insert(tree.children.end(), right.children.begin(), right.children.end());
    std::int64_t gained = 0;
    std::int64_t slack = INT64_MAX;
    for (const PointIndex child : tree.children) {
      gained += vertices_[child].size;
      slack = std::min(slack, vertices_[child].capacity - gained);
    }
    EXPECT_EQ(v.sum, gained) << "below " << t;
    EXPECT_EQ(v.slack, slack) << "below " << t;
    return tree;
  }

  void expect_joins_in_order(PointIndex host, const std::vector<PointIndex>& children) const {
    for (std::size_t k = 0; k < children.size(); ++k) {
      const PointIndex child = children[k];
      const EdgeKey key = edges_.key(vertices_[child].edge);
      EXPECT_EQ(vertices_.host(child), host) << "of child " << child;
      EXPECT_EQ(vertices_[child].weight_bits, key.weight_bits) << "of child " << child;
      EXPECT_EQ(vertices_.absorption(child).weight_bits, key.weight_bits) << "of child " << child;
      const bool is_last = k + 1 == children.size();
      if (!is_last) {
        EXPECT_LT(key, edges_.key(vertices_[children[k + 1]].edge)) << "of child " << child;
      }
      const PointIndex next = is_last ? host : children[k + 1];
      const bool is_end = is_last && vertices_.is_root(host);
      EXPECT_EQ(vertices_[child].capacity, is_end ? JoinRule::kUnbounded : capacity(child, next))
          << "of child " << child;
    }
  }

  /// Points that the host may gain up to `child` and still be alive at what `next` does.
  std::int32_t capacity(PointIndex child, PointIndex next) const {
    const auto weight = [&](PointIndex x) { return edges_.key(vertices_[x].edge).weight(); };
    return rule_.capacity(weight(child), weight(next)) - 1;
  }

  const Vertices& vertices_;
  const TreeEdges& edges_;
  JoinRule rule_;
};

}  // namespace kintsugi::segmenter::exact::testing
