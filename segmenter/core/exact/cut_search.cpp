#include "segmenter/core/exact/cut_search.hpp"

#include <cassert>

namespace kintsugi::segmenter::exact {
namespace {

// To take back a join costs about as much as to explore a point. A future of n points has about
// one join for every 8 of them.
constexpr std::uint32_t kFuturePointsPerJoin = 8;

}  // namespace

const std::vector<PointIndex>& CutSearch::reconcile(PointIndex u, PointIndex v,
                                                    const EdgeKey& time) {
  to_explore_.clear();
  PointIndex main_u = main_point(u);
  PointIndex main_v = main_point(v);
  if (main_u != kNone && main_v != kNone &&
      forest_.representative_after(main_u, time) != forest_.representative_after(main_v, time)) {
    explore_smaller(main_u, main_v, time);
  }
  const PointIndex main = main_u != kNone ? main_u : main_v;
  if (is_explored(u)) families_[find_family(u)].main = main;
  if (is_explored(v)) families_[find_family(v)].main = main;
  if (is_explored(u) && is_explored(v)) families_[find_family(u)].parent = find_family(v);
  return to_explore_;
}

void CutSearch::finish() {
  for (const PointIndex x : explored_) vertices_[x].family = 0;
  explored_.clear();
  families_.resize(1);
}

/// Explores the unexplored points of one of the two old components. The main point of the other
/// becomes the main point of both.
void CutSearch::explore_smaller(PointIndex& main_u, PointIndex& main_v, const EdgeKey& time) {
  const Search& smaller = search_smaller(main_u, main_v, time);
  PointIndex& kept = &smaller == &sides_[0] ? main_v : main_u;
  const std::uint32_t family = new_family(kept);
  for (const PointIndex x : smaller.points) {
    if (is_explored(x)) continue;
    mark(x, family);
    to_explore_.push_back(x);
  }
  main_u = main_v = kept;
  for (const Search& side : sides_) {
    for (const PointIndex x : side.points) vertices_[x].visit = 0;
  }
}

/// Searches both old components alternately, and returns the search that is complete first.
CutSearch::Search& CutSearch::search_smaller(PointIndex from_u, PointIndex from_v,
                                             const EdgeKey& time) {
  for (Search& side : sides_) {
    side.points.clear();
    side.num_expanded = side.cost = 0;
  }
  reach(sides_[0], from_u, time);
  reach(sides_[1], from_v, time);
  while (true) {
    Search& side = sides_[0].cost <= sides_[1].cost ? sides_[0] : sides_[1];
    if (side.num_expanded == side.points.size()) return side;
    expand(side, time);
  }
}

void CutSearch::expand(Search& search, const EdgeKey& time) {
  const PointIndex x = search.points[search.num_expanded++];
  edges_.for_each_linked(x, [&](TreeEdgeId edge, PointIndex other) {
    ++search.cost;
    if (edges_.key(edge) < time && vertices_[other].visit == 0) reach(search, other, time);
  });
}

void CutSearch::reach(Search& search, PointIndex x, const EdgeKey& time) {
  vertices_[x].visit = 1;  // one mark is enough: the two old components share no point
  search.points.push_back(x);
  ++search.cost;
  if (is_explored(x) || forest_.is_absorbed_up_to(x, time)) return;
  const JoinHistory& history = forest_.history();
  search.cost += (history.total(x) - history.state_before(x, time).size) / kFuturePointsPerJoin;
}

std::uint32_t CutSearch::new_family(PointIndex main) {
  const auto number = static_cast<std::uint32_t>(families_.size());
  families_.push_back({number, main});
  return number;
}

void CutSearch::mark(PointIndex x, std::uint32_t family) {
  vertices_[x].family = family;
  explored_.push_back(x);
}

std::uint32_t CutSearch::find_family(PointIndex x) {
  std::uint32_t family = vertices_[x].family;
  while (families_[family].parent != family) {
    families_[family].parent = families_[families_[family].parent].parent;
    family = families_[family].parent;
  }
  return family;
}

/// An unexplored point of the old component of x; kNone when there is none.
PointIndex CutSearch::main_point(PointIndex x) {
  if (!is_explored(x)) return x;
  std::uint32_t family = find_family(x);
  while (families_[family].main != kNone && is_explored(families_[family].main)) {
    // The main point was explored meanwhile, so its family knows another one.
    const std::uint32_t next = find_family(families_[family].main);
    assert(next != family);
    families_[family].parent = next;
    family = next;
  }
  return families_[family].main;
}

}  // namespace kintsugi::segmenter::exact
