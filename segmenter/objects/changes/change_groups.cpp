#include "segmenter/objects/changes/change_groups.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

namespace kintsugi::segmenter {
namespace {

constexpr double kMost = 0.5;  // of a segment that is changed as a whole
// Of a segment of which less is known, what has changed says nothing about the rest.
constexpr double kLeastKnown = 0.3;
constexpr double kCell_vox = 1.5;  // points of a surface are in neighbouring cells
// Of the 27 cells around one in the middle of a surface 9 and more have points; on a strip three
// voxels wide 6 at most have all.
constexpr int kWide_cells = 8;
constexpr int kLeastWideCells = 3;
constexpr double kEdge = 0.7;

using Cell = std::array<std::int32_t, 3>;

struct Tally {
  double same = 0.0;
  double changed = 0.0;
  double all = 0.0;
};

bool is_changed(PointChange change) {
  return change == PointChange::kChanged || change == PointChange::kRecolored;
}

std::map<std::uint32_t, Tally> tallies_of(std::span<const std::uint32_t> segment_ids,
                                          std::span<const PointChange> changes) {
  std::map<std::uint32_t, Tally> tallies;
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Tally& tally = tallies[segment_ids[i]];
    tally.all += 1.0;
    tally.same += changes[i] == PointChange::kSame ? 1.0 : 0.0;
    tally.changed += is_changed(changes[i]) ? 1.0 : 0.0;
  }
  return tallies;
}

bool is_changed_as_a_whole(const Tally& tally) {
  const double known = tally.same + tally.changed;
  return known >= kLeastKnown * tally.all && tally.changed >= kMost * known;
}

/// Disjoint sets of numbers.
class Sets {
 public:
  explicit Sets(std::size_t size) : parents_(size) {
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    a = find(a);
    b = find(b);
    parents_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<std::size_t> parents_;
};

/// The points of one segment in one cell.
struct CellPoints {
  std::vector<std::size_t> points;
  std::size_t number = 0;
};
using Cells = std::map<Cell, std::map<std::uint32_t, CellPoints>>;

template <class Visit>
void visit_around(const Cells& cells, const Cell& at, const Visit& visit) {
  for (std::int32_t dx = -1; dx <= 1; ++dx) {
    for (std::int32_t dy = -1; dy <= 1; ++dy) {
      for (std::int32_t dz = -1; dz <= 1; ++dz) {
        const auto found = cells.find({at[0] + dx, at[1] + dy, at[2] + dz});
        if (found != cells.end()) visit(found->second);
      }
    }
  }
}

Cells cells_of(std::span<const CloudPoint> points, std::span<const std::uint32_t> segment_ids,
               const std::vector<bool>& is_member, double cell_m) {
  Cells cells;
  const auto index = [&](float x) {
    return static_cast<std::int32_t>(std::floor(static_cast<double>(x) / cell_m));
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!is_member[i]) continue;
    const Cell at{index(points[i].x), index(points[i].y), index(points[i].z)};
    cells[at][segment_ids[i]].points.push_back(i);
  }
  std::size_t number = 0;
  for (auto& [at, segments] : cells) {
    for (auto& [id, content] : segments) content.number = number++;
  }
  return cells;
}

std::size_t num_pieces(const Cells& cells) {
  std::size_t number = 0;
  for (const auto& [at, segments] : cells) number += segments.size();
  return number;
}

/// Joins what is connected within each segment.
void join_segments(const Cells& cells, Sets& sets) {
  for (const auto& [at, segments] : cells) {
    visit_around(cells, at, [&, &here = segments](const auto& around) {
      for (const auto& [id, content] : here) {
        const auto same = around.find(id);
        if (same != around.end()) sets.join(content.number, same->second.number);
      }
    });
  }
}

/// Joins pieces of different segments that meet along an edge, as the faces of one thing do: it is
/// as long as kEdge of the side of the smaller one. Things that stand side by side touch at less.
void join_faces(const Cells& cells, Sets& sets) {
  using Pair = std::pair<std::size_t, std::size_t>;
  std::map<std::size_t, double> sizes;  // cells
  std::map<Pair, double> contacts;      // cells of the first that touch the second
  for (const auto& [at, segments] : cells) {
    for (const auto& [id, content] : segments) {
      const std::size_t here = sets.find(content.number);
      sizes[here] += 1.0;
      std::set<std::size_t> others;
      visit_around(cells, at, [&](const auto& around) {
        for (const auto& [other_id, other] : around) others.insert(sets.find(other.number));
      });
      for (const std::size_t other : others) {
        if (other != here) contacts[{here, other}] += 1.0;
      }
    }
  }
  for (const auto& [pair, contact] : contacts) {
    const double smaller = std::min(sizes[pair.first], sizes[pair.second]);
    if (contact >= kEdge * std::sqrt(smaller)) sets.join(pair.first, pair.second);
  }
}

struct Gathered {
  std::vector<std::size_t> points;
  int wide_cells = 0;
};

std::map<std::size_t, Gathered> gather(const Cells& cells) {
  Sets sets(num_pieces(cells));
  join_segments(cells, sets);
  join_faces(cells, sets);
  std::map<std::size_t, Gathered> groups;
  for (const auto& [at, segments] : cells) {
    int occupied = 0;
    visit_around(cells, at, [&](const auto&) { ++occupied; });
    for (const auto& [id, content] : segments) {
      Gathered& group = groups[sets.find(content.number)];
      group.points.insert(group.points.end(), content.points.begin(), content.points.end());
      group.wide_cells += occupied >= kWide_cells ? 1 : 0;
    }
  }
  return groups;
}

struct Limits {
  double least_changed = 0.0;  // points
  int least_wide_cells = 0;
};

std::vector<ChangeGroup> groups_of(std::span<const CloudPoint> points,
                                   std::span<const std::uint32_t> segment_ids,
                                   std::span<const PointChange> changes,
                                   const std::vector<bool>& is_member, double voxel_m,
                                   const Limits& limits) {
  std::vector<ChangeGroup> groups;
  for (auto& [number, gathered] :
       gather(cells_of(points, segment_ids, is_member, kCell_vox * voxel_m))) {
    const auto num_changed = static_cast<double>(std::ranges::count_if(
        gathered.points, [&](std::size_t i) { return is_changed(changes[i]); }));
    if (num_changed < limits.least_changed || gathered.wide_cells < limits.least_wide_cells) {
      continue;
    }
    ChangeGroup group;
    group.share_changed = num_changed / static_cast<double>(gathered.points.size());
    group.points = std::move(gathered.points);
    std::ranges::sort(group.points);
    std::set<std::uint32_t> ids;
    for (const std::size_t i : group.points) ids.insert(segment_ids[i]);
    ids.erase(0);
    group.segment_ids.assign(ids.begin(), ids.end());
    groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace

std::vector<ChangeGroup> group_changes(std::span<const CloudPoint> points,
                                       std::span<const std::uint32_t> segment_ids,
                                       std::span<const PointChange> changes, double voxel_m) {
  const auto tallies = tallies_of(segment_ids, changes);
  std::set<std::uint32_t> whole;
  for (const auto& [id, tally] : tallies) {
    if (id != 0 && is_changed_as_a_whole(tally)) whole.insert(id);
  }
  std::vector<bool> is_thing(points.size());
  std::vector<bool> is_trace(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    is_thing[i] = changes[i] == PointChange::kChanged || whole.contains(segment_ids[i]);
    is_trace[i] = is_changed(changes[i]) && !whole.contains(segment_ids[i]);
  }
  const double area = std::pow(0.01 / voxel_m, 2);
  std::vector<ChangeGroup> groups =
      groups_of(points, segment_ids, changes, is_thing, voxel_m,
                {.least_changed = kLeastPoints * area, .least_wide_cells = kLeastWideCells});
  for (ChangeGroup& trace : groups_of(points, segment_ids, changes, is_trace, voxel_m,
                                      {.least_changed = kLeastTrace * area})) {
    trace.is_thing = false;
    groups.push_back(std::move(trace));
  }
  return groups;
}

}  // namespace kintsugi::segmenter
