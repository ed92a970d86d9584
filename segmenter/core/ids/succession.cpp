#include "segmenter/core/ids/succession.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>

namespace kintsugi::segmenter {
namespace {

void append_births(std::span<const Succession> successions, std::vector<SegmentEvent>& events) {
  for (const Succession& s : successions) {
    if (s.preferred_id == kNoSegment) {
      events.push_back({SegmentEventType::kCreated, s.new_id, 0});
    } else if (s.new_id != s.preferred_id) {
      events.push_back({SegmentEventType::kSplit, s.preferred_id, s.new_id});
    } else if (s.gained) {
      events.push_back({SegmentEventType::kGrown, s.new_id, 0});
    }
  }
}

/// The number of points that an old segment shares with a new one.
struct Share {
  std::uint32_t old_id;
  std::int64_t count;
  std::uint32_t new_id;
};

/// By old id, the largest share first, ties to the smaller new id.
std::vector<Share> sorted_shares(std::span<const Succession> successions,
                                 std::span<const Overlap> overlaps) {
  std::vector<Share> shares;
  for (const Overlap& overlap : overlaps) {
    if (overlap.old_id == kNoSegment) continue;
    const Succession& taker = find_succession(successions, overlap.component);
    shares.push_back({overlap.old_id, overlap.count, taker.new_id});
  }
  std::sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) {
    return std::tuple(a.old_id, -a.count, a.new_id) < std::tuple(b.old_id, -b.count, b.new_id);
  });
  return shares;
}

/// An old id that nobody inherits was merged into the segment that has most of its points, or is
/// retired if none is left.
void append_deaths(std::span<const Share> shares, std::span<const std::uint32_t> old_ids,
                   std::vector<SegmentEvent>& events) {
  auto first = shares.begin();
  for (const std::uint32_t old_id : old_ids) {
    const auto last = std::find_if(first, shares.end(),
                                   [&](const Share& share) { return share.old_id != old_id; });
    const bool has_heir =
        std::any_of(first, last, [&](const Share& share) { return share.new_id == old_id; });
    if (first == last) {
      events.push_back({SegmentEventType::kRetired, old_id, 0});
    } else if (!has_heir) {
      events.push_back({SegmentEventType::kMerged, first->new_id, old_id});
    }
    first = last;
  }
}

/// The components that prefer an id, by that id; the one that shares most with it first.
std::vector<Succession*> sorted_claims(std::vector<Succession>& successions) {
  std::vector<Succession*> claims;
  for (Succession& s : successions) {
    if (s.preferred_id != kNoSegment) claims.push_back(&s);
  }
  std::sort(claims.begin(), claims.end(), [](const Succession* a, const Succession* b) {
    return std::tuple(a->preferred_id, -a->shared, a->first) <
           std::tuple(b->preferred_id, -b->shared, b->first);
  });
  return claims;
}

void mark_unrivalled(std::vector<Succession>& successions) {
  const std::vector<Succession*> claims = sorted_claims(successions);
  for (std::size_t i = 0; i < claims.size(); ++i) {
    const auto prefers_the_same = [&](std::size_t other) {
      return other < claims.size() && claims[other]->preferred_id == claims[i]->preferred_id;
    };
    const bool is_best = i == 0 || !prefers_the_same(i - 1);
    const bool is_tied = prefers_the_same(i + 1) && claims[i + 1]->shared == claims[i]->shared;
    claims[i]->is_unrivalled = is_best && !is_tied;
  }
}

}  // namespace

void combine(std::vector<Overlap>& overlaps) {
  std::sort(overlaps.begin(), overlaps.end(), [](const Overlap& a, const Overlap& b) {
    return std::tie(a.component, a.old_id) < std::tie(b.component, b.old_id);
  });
  std::size_t kept = 0;
  for (std::size_t i = 1; i < overlaps.size(); ++i) {
    if (overlaps[i].component == overlaps[kept].component &&
        overlaps[i].old_id == overlaps[kept].old_id) {
      overlaps[kept].count += overlaps[i].count;
    } else {
      overlaps[++kept] = overlaps[i];
    }
  }
  if (!overlaps.empty()) overlaps.resize(kept + 1);
}

std::vector<Succession> prefer(std::span<const Overlap> overlaps) {
  std::vector<Succession> successions;
  for (const Overlap& overlap : overlaps) {
    if (successions.empty() || successions.back().component != overlap.component) {
      successions.emplace_back().component = overlap.component;
    } else {
      successions.back().gained = true;
    }
    Succession& last = successions.back();
    if (overlap.old_id != kNoSegment && overlap.count > last.shared) {
      last.preferred_id = overlap.old_id;
      last.shared = overlap.count;
    }
  }
  mark_unrivalled(successions);
  return successions;
}

std::uint32_t assign_ids(std::vector<Succession>& successions, std::uint32_t next_id) {
  std::uint32_t inherited = kNoSegment;
  for (Succession* claim : sorted_claims(successions)) {
    if (claim->preferred_id == inherited) continue;
    inherited = claim->preferred_id;
    claim->new_id = inherited;
  }
  std::vector<Succession*> rest;
  for (Succession& s : successions) {
    if (s.new_id == kNoSegment) rest.push_back(&s);
  }
  std::sort(rest.begin(), rest.end(),
            [](const Succession* a, const Succession* b) { return a->first < b->first; });
  for (Succession* s : rest) s->new_id = next_id++;
  return next_id;
}

const Succession& find_succession(std::span<const Succession> successions, ComponentId component) {
  const auto found =
      std::lower_bound(successions.begin(), successions.end(), component,
                       [](const Succession& s, ComponentId value) { return s.component < value; });
  assert(found != successions.end() && found->component == component);
  return *found;
}

std::vector<SegmentEvent> events_of(std::span<const Succession> successions,
                                    std::span<const Overlap> overlaps,
                                    std::span<const std::uint32_t> old_ids) {
  std::vector<SegmentEvent> events;
  append_births(successions, events);
  append_deaths(sorted_shares(successions, overlaps), old_ids, events);
  std::sort(events.begin(), events.end(), [](const SegmentEvent& a, const SegmentEvent& b) {
    return std::tie(a.type, a.segment_id, a.other_id) < std::tie(b.type, b.segment_id, b.other_id);
  });
  return events;
}

}  // namespace kintsugi::segmenter
