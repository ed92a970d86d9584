#include "segmenter/core/exact/join_history.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <iterator>
#include <utility>

namespace kintsugi::segmenter::exact {
namespace {

/// Priority of a vertex as a node of a treap: a bijective mix of 32 bits, so all are distinct.
std::uint32_t priority(PointIndex x) {
  x *= 0x9E3779B1U;
  x ^= x >> 15;
  x *= 0x85EBCA6BU;
  x ^= x >> 13;
  x *= 0xC2B2AE35U;
  return x ^ (x >> 16);
}

}  // namespace

bool JoinHistory::is_before(PointIndex x, PointIndex y) const {
  const Vertex& u = vertices_[x];
  const Vertex& v = vertices_[y];
  if (u.weight_bits != v.weight_bits) return u.weight_bits < v.weight_bits;
  return edges_.key(u.edge) < edges_.key(v.edge);
}

bool JoinHistory::is_up_to(PointIndex x, const EdgeKey& time) const {
  const Vertex& v = vertices_[x];
  if (v.weight_bits != time.weight_bits) return v.weight_bits < time.weight_bits;
  return !(time < edges_.key(v.edge));
}

void JoinHistory::refresh(PointIndex t) {
  Vertex& v = vertices_[t];
  v.sum = v.size;
  v.slack = v.capacity - static_cast<std::int32_t>(v.size);
  if (v.left != kNone) {
    const Vertex& left = vertices_[v.left];
    v.sum += left.sum;
    v.slack = std::min(v.slack - static_cast<std::int32_t>(left.sum), left.slack);
  }
  if (v.right != kNone) {
    const Vertex& right = vertices_[v.right];
    v.slack = std::min(v.slack, right.slack - static_cast<std::int32_t>(v.sum));
    v.sum += right.sum;
  }
}

void JoinHistory::refresh_path(PointIndex host, PointIndex guest) {
  // First down to the guest, then refresh on the way up. Treaps of n nodes are some 2 ln n deep.
  PointIndex path[128];
  std::size_t depth = 0;
  for (PointIndex t = vertices_[host].history; t != guest;
       t = is_before(guest, t) ? vertices_[t].left : vertices_[t].right) {
    assert(t != kNone && depth < std::size(path));
    path[depth++] = t;
  }
  refresh(guest);
  while (depth > 0) refresh(path[--depth]);
}

/// `next`: the guest after it, or kNone when the host's own absorption comes next.
void JoinHistory::set_capacity(PointIndex guest, PointIndex next) {
  Vertex& v = vertices_[guest];
  const std::uint32_t next_bits =
      next != kNone ? vertices_[next].weight_bits : vertices_[vertices_.host(guest)].weight_bits;
  // Minus one, because the host is itself a point of the component, and not gained.
  v.capacity = next_bits == UINT32_MAX ? JoinRule::kUnbounded
                                       : rule_.capacity(std::bit_cast<float>(v.weight_bits),
                                                        std::bit_cast<float>(next_bits)) -
                                             1;
}

/// The guest of `host` just before, or just after, `guest`, which need not be in the history.
PointIndex JoinHistory::neighbour(PointIndex host, PointIndex guest, bool before) const {
  PointIndex found = kNone;
  for (PointIndex t = vertices_[host].history; t != kNone;) {
    const bool is_candidate = before ? is_before(t, guest) : is_before(guest, t);
    if (is_candidate) found = t;
    t = is_candidate == before ? vertices_[t].right : vertices_[t].left;
  }
  return found;
}

PointIndex JoinHistory::first(PointIndex host) const {
  PointIndex t = vertices_[host].history;
  while (t != kNone && vertices_[t].left != kNone) t = vertices_[t].left;
  return t;
}

void JoinHistory::store_last_weight(PointIndex host) {
  const PointIndex guest = last(host);
  vertices_[host].last_weight_bits = guest == kNone ? 0 : vertices_[guest].weight_bits;
}

PointIndex JoinHistory::last(PointIndex host) const {
  PointIndex t = vertices_[host].history;
  while (t != kNone && vertices_[t].right != kNone) t = vertices_[t].right;
  return t;
}

void JoinHistory::insert(PointIndex guest) {
  const PointIndex host = vertices_.host(guest);
  set_capacity(guest, neighbour(host, guest, false));
  vertices_[guest].left = vertices_[guest].right = kNone;
  Vertex& h = vertices_[host];
  h.history = insert_below(h.history, guest);
  h.last_weight_bits = std::max(h.last_weight_bits, vertices_[guest].weight_bits);
  const PointIndex previous = neighbour(host, guest, true);
  if (previous != kNone) {
    set_capacity(previous, guest);
    refresh_path(host, previous);
  }
}

PointIndex JoinHistory::insert_below(PointIndex t, PointIndex guest) {
  if (t == kNone || priority(guest) > priority(t)) {
    const Halves halves = split(t, edges_.key(vertices_[guest].edge));
    vertices_[guest].left = halves.up_to;
    vertices_[guest].right = halves.after;
    refresh(guest);
    return guest;
  }
  if (is_before(guest, t)) {
    vertices_[t].left = insert_below(vertices_[t].left, guest);
  } else {
    vertices_[t].right = insert_below(vertices_[t].right, guest);
  }
  refresh(t);
  return t;
}

void JoinHistory::erase(PointIndex guest) {
  const PointIndex host = vertices_.host(guest);
  vertices_[host].history = erase_below(vertices_[host].history, guest);
  if (vertices_[guest].weight_bits == vertices_[host].last_weight_bits) store_last_weight(host);
  const PointIndex previous = neighbour(host, guest, true);
  if (previous != kNone) {
    set_capacity(previous, neighbour(host, guest, false));
    refresh_path(host, previous);
  }
  vertices_[guest].left = vertices_[guest].right = kNone;
}

PointIndex JoinHistory::erase_below(PointIndex t, PointIndex guest) {
  assert(t != kNone);
  if (t == guest) return merge(vertices_[t].left, vertices_[t].right);
  if (is_before(guest, t)) {
    vertices_[t].left = erase_below(vertices_[t].left, guest);
  } else {
    vertices_[t].right = erase_below(vertices_[t].right, guest);
  }
  refresh(t);
  return t;
}

/// All of `a` comes before all of `b`.
PointIndex JoinHistory::merge(PointIndex a, PointIndex b) {
  if (a == kNone) return b;
  if (b == kNone) return a;
  if (priority(a) > priority(b)) {
    vertices_[a].right = merge(vertices_[a].right, b);
    refresh(a);
    return a;
  }
  vertices_[b].left = merge(a, vertices_[b].left);
  refresh(b);
  return b;
}

JoinHistory::Halves JoinHistory::split(PointIndex t, const EdgeKey& time) {
  if (t == kNone) return {kNone, kNone};
  Halves halves;
  if (is_up_to(t, time)) {
    halves = split(vertices_[t].right, time);
    vertices_[t].right = halves.up_to;
    halves.up_to = t;
  } else {
    halves = split(vertices_[t].left, time);
    vertices_[t].left = halves.after;
    halves.after = t;
  }
  refresh(t);
  return halves;
}

PointIndex JoinHistory::take_after(PointIndex host, const EdgeKey& time) {
  const PointIndex last_guest = last(host);
  if (last_guest == kNone || is_up_to(last_guest, time)) return kNone;
  const Halves halves = split(vertices_[host].history, time);
  vertices_[host].history = halves.up_to;
  store_last_weight(host);
  update_end(host);
  return halves.after;
}

void JoinHistory::split_after(PointIndex host, const EdgeKey& time, std::vector<PointIndex>& out) {
  for_each_in_order(take_after(host, time), [&](PointIndex guest) { out.push_back(guest); });
}

/// Builds a Cartesian tree from an ordered list; the stack holds its right spine.
void JoinHistory::build(PointIndex host, std::span<const PointIndex> guests) {
  assert(vertices_[host].history == kNone);
  std::vector<PointIndex> spine;
  for (std::size_t k = 0; k < guests.size(); ++k) {
    const PointIndex guest = guests[k];
    set_capacity(guest, k + 1 < guests.size() ? guests[k + 1] : kNone);
    vertices_[guest].left = vertices_[guest].right = kNone;
    PointIndex below = kNone;
    while (!spine.empty() && priority(guest) > priority(spine.back())) {
      below = spine.back();
      refresh(below);
      spine.pop_back();
    }
    vertices_[guest].left = below;
    if (!spine.empty()) vertices_[spine.back()].right = guest;
    spine.push_back(guest);
  }
  while (!spine.empty()) {
    refresh(spine.back());
    vertices_[host].history = spine.back();
    spine.pop_back();
  }
  store_last_weight(host);
}

void JoinHistory::append(PointIndex host, PointIndex taken) {
  if (taken == kNone) return;
  PointIndex next = kNone;
  for_each_in_order(taken, [&](PointIndex guest) {
    vertices_.set_host(guest, host);
    if (next == kNone) next = guest;
  });
  const PointIndex previous = last(host);
  vertices_[host].history = merge(vertices_[host].history, taken);
  if (previous != kNone) {
    set_capacity(previous, next);
    refresh_path(host, previous);
  }
  store_last_weight(host);
  update_end(host);
}

void JoinHistory::update_end(PointIndex host) {
  const PointIndex guest = last(host);
  if (guest == kNone) return;
  set_capacity(guest, kNone);
  refresh_path(host, guest);
}

JoinHistory::State JoinHistory::state_before(PointIndex host, const EdgeKey& time) const {
  const Vertex& h = vertices_[host];
  if (h.last_weight_bits < time.weight_bits) {  // nothing happens to the host from `time` on
    return {total(host), std::bit_cast<float>(h.last_weight_bits)};
  }
  State state;
  for (PointIndex t = h.history; t != kNone;) {
    const Vertex& v = vertices_[t];
    const bool is_before_time = v.weight_bits != time.weight_bits ? v.weight_bits < time.weight_bits
                                                                  : edges_.key(v.edge) < time;
    if (!is_before_time) {
      t = v.left;
      continue;
    }
    state.size += v.size + (v.left == kNone ? 0 : vertices_[v.left].sum);
    state.weight = std::bit_cast<float>(v.weight_bits);
    t = v.right;
  }
  return state;
}

double JoinHistory::final_theta(PointIndex host) const {
  return rule_.theta(std::bit_cast<float>(vertices_[host].last_weight_bits), total(host));
}

PointIndex JoinHistory::first_broken(PointIndex host) const {
  PointIndex t = vertices_[host].history;
  if (t == kNone) return kNone;
  const PointIndex first_guest = first(host);
  const double first_weight = std::bit_cast<float>(vertices_[first_guest].weight_bits);
  if (!(first_weight < rule_.threshold)) return first_guest;
  if (vertices_[t].slack >= 0) return kNone;

  std::int32_t gained = 0;  // points, by all joins before the subtree t
  while (true) {
    const Vertex& v = vertices_[t];
    if (v.left != kNone && vertices_[v.left].slack < gained) {
      t = v.left;
      continue;
    }
    gained += static_cast<std::int32_t>(v.size);
    if (v.left != kNone) gained += static_cast<std::int32_t>(vertices_[v.left].sum);
    if (v.capacity < gained) break;
    t = v.right;
  }
  const PointIndex next = neighbour(host, t, false);
  return next != kNone ? next : host;
}

}  // namespace kintsugi::segmenter::exact
