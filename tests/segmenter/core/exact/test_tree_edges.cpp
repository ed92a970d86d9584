#include <map>
#include <set>
#include <utility>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/core/exact/tree_edges.hpp"
#include "tests/fuzz/random.hpp"

namespace kintsugi::segmenter::exact {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

using Linked = std::pair<TreeEdgeId, PointIndex>;  // edge, other end

class TreeEdgesTest : public ::testing::Test {
 protected:
  static constexpr PointIndex kNumVertices = 12;

  TreeEdgesTest() { vertices_.resize(kNumVertices); }

  std::vector<Linked> linked_at(PointIndex x) const {
    std::vector<Linked> found;
    edges_.for_each_linked(x, [&](TreeEdgeId id, PointIndex other) {
      found.push_back({id, other});
    });
    return found;
  }

  Vertices vertices_;
  TreeEdges edges_{vertices_};
};

TEST_F(TreeEdgesTest, AnAddedEdgeHasItsKeyNoOwnerAndIsNotLinked) {
  const EdgeKey key = EdgeKey::of(0.5F, 7, 3);
  const TreeEdgeId id = edges_.add(key);
  EXPECT_EQ(edges_.key(id), key);
  EXPECT_EQ(edges_.owner(id), kNone);
  EXPECT_FALSE(edges_.is_linked(id));
  EXPECT_THAT(linked_at(3), IsEmpty());
}

TEST_F(TreeEdgesTest, ALinkedEdgeIsFoundAtBothEnds) {
  const TreeEdgeId id = edges_.add(EdgeKey::of(0.5F, 7, 3));
  edges_.link(id);
  EXPECT_TRUE(edges_.is_linked(id));
  EXPECT_THAT(linked_at(3), ElementsAre(Linked(id, 7)));
  EXPECT_THAT(linked_at(7), ElementsAre(Linked(id, 3)));
  edges_.unlink(id);
  EXPECT_FALSE(edges_.is_linked(id));
  EXPECT_THAT(linked_at(3), IsEmpty());
  EXPECT_THAT(linked_at(7), IsEmpty());
}

TEST_F(TreeEdgesTest, IsLinkedAlsoAsTheLastOfItsLists) {
  // The end of a list differs from "in no list".
  const TreeEdgeId first = edges_.add(EdgeKey::of(0.5F, 0, 1));
  const TreeEdgeId second = edges_.add(EdgeKey::of(0.5F, 1, 2));
  edges_.link(first);
  edges_.link(second);
  edges_.unlink(second);
  EXPECT_TRUE(edges_.is_linked(first));
  edges_.link(second);
  edges_.unlink(first);
  EXPECT_TRUE(edges_.is_linked(second));
  EXPECT_THAT(linked_at(1), ElementsAre(Linked(second, 2)));
}

TEST_F(TreeEdgesTest, IdsOfReleasedEdgesAreUsedAgainWithoutTheirPast) {
  const TreeEdgeId first = edges_.add(EdgeKey::of(0.5F, 0, 1));
  const TreeEdgeId second = edges_.add(EdgeKey::of(0.6F, 1, 2));
  edges_.set_owner(first, 1);
  edges_.link(first);
  edges_.unlink(first);
  edges_.release(first);
  edges_.release(second);
  const EdgeKey key = EdgeKey::of(0.7F, 4, 5);
  const TreeEdgeId third = edges_.add(key);
  const TreeEdgeId fourth = edges_.add(key);
  EXPECT_THAT((std::vector{third, fourth}), UnorderedElementsAre(first, second));
  for (const TreeEdgeId id : {third, fourth}) {
    EXPECT_EQ(edges_.key(id), key);
    EXPECT_EQ(edges_.owner(id), kNone);
    EXPECT_FALSE(edges_.is_linked(id));
  }
}

TEST_F(TreeEdgesTest, AgainstASetOfEdgesPerVertex) {
  struct Known {
    EdgeKey key;
    PointIndex owner = kNone;
    bool is_linked = false;
  };
  std::map<TreeEdgeId, Known> known;
  fuzz::Random random(1);
  std::size_t most_known = 0;
  TreeEdgeId largest_id = 0;
  for (int step = 0; step < 20'000; ++step) {
    const bool grows = step / 500 % 2 == 0;
    if (known.empty() || random.chance(grows ? 0.4 : 0.1)) {
      const auto a = static_cast<PointIndex>(random.below(kNumVertices - 1));
      const auto b = static_cast<PointIndex>(random.between(a + 1, kNumVertices - 1));
      const EdgeKey key = EdgeKey::of(static_cast<float>(random.unit()), a, b);
      const TreeEdgeId id = edges_.add(key);
      ASSERT_FALSE(known.contains(id));
      known[id] = {key};
      largest_id = std::max(largest_id, id);
    } else {
      auto at = std::next(known.begin(), static_cast<std::ptrdiff_t>(random.below(known.size())));
      auto& [id, edge] = *at;
      if (random.chance(0.3)) {
        edge.owner = random.chance(0.5) ? edge.key.a : edge.key.b;
        edges_.set_owner(id, edge.owner);
      } else if (!edge.is_linked && random.chance(0.6)) {
        edges_.link(id);
        edge.is_linked = true;
      } else {
        if (edge.is_linked) edges_.unlink(id);
        edge.is_linked = false;
        if (random.chance(grows ? 0.2 : 0.8)) {
          edges_.release(id);
          known.erase(at);
        }
      }
    }
    most_known = std::max(most_known, known.size());

    std::vector<std::set<Linked>> expected(kNumVertices);
    for (const auto& [id, edge] : known) {
      ASSERT_EQ(edges_.key(id), edge.key);
      ASSERT_EQ(edges_.owner(id), edge.owner);
      ASSERT_EQ(edges_.is_linked(id), edge.is_linked);
      if (!edge.is_linked) continue;
      expected[edge.key.a].insert({id, edge.key.b});
      expected[edge.key.b].insert({id, edge.key.a});
    }
    const auto at = static_cast<PointIndex>(random.below(kNumVertices));
    ASSERT_THAT(linked_at(at), ::testing::UnorderedElementsAreArray(expected[at]));
  }
  EXPECT_GT(most_known, 20U);
  EXPECT_LT(largest_id, most_known);  // no more ids than there ever were edges at once
}

}  // namespace
}  // namespace kintsugi::segmenter::exact
