#include "segmenter/preprocess/normal_orientation.hpp"

#include <cmath>
#include <numeric>
#include <tuple>

#include <tbb/parallel_sort.h>

namespace kintsugi::segmenter {
namespace {

struct Edge {
  float cost;
  std::uint32_t a;
  std::uint32_t b;

  bool operator<(const Edge& other) const {
    return std::tie(cost, a, b) < std::tie(other.cost, other.a, other.b);
  }
};

float normal_product(const CloudPoint& a, const CloudPoint& b) {
  return a.nx * b.nx + a.ny * b.ny + a.nz * b.nz;
}

bool has_normal(const CloudPoint& p) { return normal_product(p, p) > 0.0F; }

// Union-find in which each vertex knows whether it is flipped against its root.
class SignedForest {
 public:
  explicit SignedForest(std::size_t size) : parent_(size), flipped_(size, 0) {
    std::iota(parent_.begin(), parent_.end(), 0U);
  }

  struct Place {
    std::uint32_t root;
    bool flipped;
  };

  Place find(std::uint32_t vertex) {
    bool flipped = false;
    while (parent_[vertex] != vertex) {
      const std::uint32_t parent = parent_[vertex];
      flipped_[vertex] ^= flipped_[parent];  // path halving: a root is never flipped
      parent_[vertex] = parent_[parent];
      flipped ^= flipped_[vertex] != 0;
      vertex = parent_[vertex];
    }
    return {vertex, flipped};
  }

  // Joins the trees of a and b, when they are two, so that a is flipped against b iff `opposite`.
  void unite(std::uint32_t a, std::uint32_t b, bool opposite) {
    const Place place_a = find(a);
    const Place place_b = find(b);
    if (place_a.root == place_b.root) {
      return;
    }
    parent_[place_a.root] = place_b.root;
    flipped_[place_a.root] = (place_a.flipped != place_b.flipped) != opposite ? 1 : 0;
  }

 private:
  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> flipped_;  // against the parent
};

std::vector<Edge> sorted_edges(std::span<const CloudPoint> points_W, const NeighbourGraph& graph) {
  std::vector<Edge> edges;
  edges.reserve(points_W.size() * NeighbourGraph::kDegree / 2);
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    if (!has_normal(points_W[i])) {
      continue;
    }
    const auto a = static_cast<std::uint32_t>(i);
    for (const std::uint32_t b : graph.neighbours_of(i)) {
      const auto back = graph.neighbours_of(b);
      const bool is_listed_twice = std::find(back.begin(), back.end(), a) != back.end();
      if (b != a && has_normal(points_W[b]) && (a < b || !is_listed_twice)) {
        edges.push_back({1.0F - std::abs(normal_product(points_W[a], points_W[b])), a, b});
      }
    }
  }
  tbb::parallel_sort(edges.begin(), edges.end());
  return edges;
}

bool faces(const CloudPoint& p, const Eigen::Vector3d& viewpoint_W) {
  const Eigen::Vector3d p_W(p.x, p.y, p.z);
  return Eigen::Vector3d(p.nx, p.ny, p.nz).dot(viewpoint_W - p_W) > 0.0;
}

}  // namespace

void orient_normals(std::span<CloudPoint> points_W, const NeighbourGraph& graph,
                    const Eigen::Vector3d& viewpoint_W) {
  SignedForest forest(points_W.size());
  for (const Edge& edge : sorted_edges(points_W, graph)) {  // Kruskal
    forest.unite(edge.a, edge.b, normal_product(points_W[edge.a], points_W[edge.b]) < 0.0F);
  }

  std::vector<std::int64_t> votes(points_W.size(), 0);  // of each tree, at its root, to flip it
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    const auto place = forest.find(static_cast<std::uint32_t>(i));
    votes[place.root] += faces(points_W[i], viewpoint_W) == place.flipped ? 1 : -1;
  }
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    const auto place = forest.find(static_cast<std::uint32_t>(i));
    if (has_normal(points_W[i]) && place.flipped != (votes[place.root] > 0)) {
      CloudPoint& p = points_W[i];
      p.nx = -p.nx;
      p.ny = -p.ny;
      p.nz = -p.nz;
    }
  }
}

}  // namespace kintsugi::segmenter
