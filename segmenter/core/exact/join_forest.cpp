#include "segmenter/core/exact/join_forest.hpp"

#include <cassert>
#include <utility>

namespace kintsugi::segmenter::exact {

void JoinForest::absorb(PointIndex host, PointIndex guest, TreeEdgeId edge) {
  assert(vertices_.is_root(guest) && host != guest);
  vertices_.set_absorbed(guest, host, edge, edges_.key(edge).weight_bits);
  vertices_[guest].size = history_.total(guest);
  edges_.set_owner(edge, guest);
  history_.update_end(guest);
  history_.insert(guest);
}

PointIndex JoinForest::release(PointIndex guest) {
  const PointIndex host = vertices_.host(guest);
  assert(host != kNone);
  history_.erase(guest);
  set_free(guest);
  return host;
}

void JoinForest::release_after(PointIndex host, const EdgeKey& time, std::vector<Freed>& freed) {
  std::vector<PointIndex> guests;
  history_.split_after(host, time, guests);
  for (const PointIndex guest : guests) {
    freed.push_back({guest, vertices_[guest].edge});
    vertices_[guest].left = vertices_[guest].right = kNone;
    set_free(guest);
  }
}

void JoinForest::set_free(PointIndex guest) {
  edges_.set_owner(vertices_[guest].edge, kNone);
  vertices_.set_free(guest);
  vertices_[guest].is_queued = 0;
  history_.update_end(guest);
}

bool JoinForest::recount(PointIndex guest) {
  const std::uint32_t size = history_.total(guest);
  if (std::exchange(vertices_[guest].size, size) == size) return false;
  history_.update_size(guest);
  return true;
}

PointIndex JoinForest::step_down(PointIndex x) {
  const PointIndex heir =
      history_.first_guest_that(x, [&](PointIndex guest) { return vertices_[guest].is_gone == 0; });
  if (heir == kNone) return kNone;
  const TreeEdgeId edge = vertices_[heir].edge;
  const TreeEdgeId own_edge = vertices_[x].edge;
  const PointIndex host = vertices_.host(x);
  release(heir);
  if (host != kNone) release(x);
  const PointIndex later = history_.take_after(x, edges_.key(edge));
  absorb(heir, x, edge);
  history_.append(heir, later);
  if (host != kNone) absorb(host, heir, own_edge);
  return heir;
}

}  // namespace kintsugi::segmenter::exact
