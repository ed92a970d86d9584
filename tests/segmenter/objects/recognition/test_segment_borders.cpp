#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <random>
#include <vector>

#include <gmock/gmock.h>

#include "segmenter/description/adjacency_graph.hpp"
#include "segmenter/objects/recognition/segment_borders.hpp"

namespace kintsugi::segmenter {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr float kRadius_m = 0.02F;
constexpr float kBlock_m = 0.1F;

struct Piece {
  std::vector<CloudPoint> points_W;
  std::vector<std::uint32_t> ids;
};

CloudPoint point(float x, float y, float z) {
  CloudPoint p{};
  p.x = x;
  p.y = y;
  p.z = z;
  return p;
}

/// Points in a cube, each of some segment, or of none (0).
Piece random_piece(std::mt19937& random, std::size_t num_points, float low, float high,
                   std::uint32_t num_segments) {
  std::uniform_real_distribution<float> place(low, high);
  std::uniform_int_distribution<std::uint32_t> id(0, num_segments);
  Piece piece;
  for (std::size_t i = 0; i < num_points; ++i) {
    piece.points_W.push_back(point(place(random), place(random), place(random)));
    piece.ids.push_back(id(random));
  }
  return piece;
}

class Borders : public ::testing::Test {
 protected:
  void set(std::int32_t id, const Piece& piece) {
    pieces_[id] = piece;
    borders_.forget(map_.set_piece(
        id, std::make_shared<const std::vector<CloudPoint>>(piece.points_W), piece.ids));
  }

  /// As all points together tell.
  [[nodiscard]] std::vector<SegmentNeighbour> expected(std::uint32_t segment) const {
    std::vector<CloudPoint> points_W;
    std::vector<std::uint32_t> ids;
    for (const auto& [number, piece] : pieces_) {
      points_W.insert(points_W.end(), piece.points_W.begin(), piece.points_W.end());
      ids.insert(ids.end(), piece.ids.begin(), piece.ids.end());
    }
    std::vector<SegmentNeighbour> neighbours;
    for (const AdjacencyEdge& edge :
         adjacency_graph({points_W, ids, /*voxel_size_m=*/kRadius_m / 2, kRadius_m}).edges) {
      if (edge.a == segment) neighbours.push_back({edge.b, edge.num_pairs});
      if (edge.b == segment) neighbours.push_back({edge.a, edge.num_pairs});
    }
    std::ranges::sort(neighbours, {}, &SegmentNeighbour::segment_id);
    return neighbours;
  }

  LabelledMap map_{kBlock_m};
  SegmentBorders borders_{map_, kRadius_m};
  std::map<std::int32_t, Piece> pieces_;
};

TEST_F(Borders, AreThoseOfTheWholeCloudWhateverChanges) {
  constexpr std::uint32_t kSegments = 6;
  std::mt19937 random(1);
  std::bernoulli_distribution is_relabelled(0.5);
  for (int change = 0; change < 40; ++change) {
    const std::int32_t id = change % 4;
    const float low = -0.2F + 0.05F * static_cast<float>(id);
    const bool keeps_points = pieces_.contains(id) && is_relabelled(random);
    Piece piece = random_piece(random, 400, low, low + 0.25F, kSegments);
    if (keeps_points) piece.points_W = pieces_.at(id).points_W;
    set(id, piece);
    std::size_t num_found = 0;
    for (std::uint32_t segment = 1; segment <= kSegments; ++segment) {
      if (segment % 3 == static_cast<std::uint32_t>(change) % 3) continue;  // kept from before
      EXPECT_EQ(borders_.neighbours_of(segment), expected(segment)) << change << ", " << segment;
      num_found += borders_.neighbours_of(segment).size();
    }
    EXPECT_GT(num_found, 0);
  }
}

TEST_F(Borders, OfASegmentThatDidNotChangeItself) {
  set(1, {{point(0.095F, 0, 0)}, {1}});
  EXPECT_THAT(borders_.neighbours_of(1), IsEmpty());
  set(2, {{point(0.105F, 0, 0)}, {2}});  // in the next block
  EXPECT_THAT(borders_.neighbours_of(1), ElementsAre(SegmentNeighbour{2, 1}));
  EXPECT_THAT(borders_.neighbours_of(2), ElementsAre(SegmentNeighbour{1, 1}));
  set(2, {{point(0.105F, 0, 0)}, {3}});
  EXPECT_THAT(borders_.neighbours_of(1), ElementsAre(SegmentNeighbour{3, 1}));
  EXPECT_THAT(borders_.neighbours_of(2), IsEmpty());
  set(2, {});
  EXPECT_THAT(borders_.neighbours_of(1), IsEmpty());
}

}  // namespace
}  // namespace kintsugi::segmenter
