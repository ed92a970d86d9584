#include "segmenter/core/succession.hpp"

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

/// An old id without an heir went to the component that took most of it, ties to the smaller id.
void append_mergers(std::span<const Succession> successions, std::span<const Overlap> overlaps,
                    std::vector<SegmentEvent>& events) {
  struct Share {
    std::uint32_t old_id;
    std::int64_t count;
    std::uint32_t new_id;
  };
  std::vector<Share> shares;
  for (const Overlap& overlap : overlaps) {
    if (overlap.old_id == kNoSegment) continue;
    const Succession& taker = find_succession(successions, overlap.component);
    shares.push_back({overlap.old_id, overlap.count, taker.new_id});
  }
  std::sort(shares.begin(), shares.end(), [](const Share& a, const Share& b) {
    return std::tuple(a.old_id, -a.count, a.new_id) < std::tuple(b.old_id, -b.count, b.new_id);
  });
  for (auto first = shares.begin(); first != shares.end();) {
    const auto last = std::find_if(
        first, shares.end(), [&](const Share& share) { return share.old_id != first->old_id; });
    const bool has_heir =
        std::any_of(first, last, [](const Share& share) { return share.new_id == share.old_id; });
    if (!has_heir) {
      events.push_back({SegmentEventType::kMerged, first->new_id, first->old_id});
    }
    first = last;
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
      successions.push_back({.component = overlap.component});
    } else {
      successions.back().gained = true;
    }
    Succession& last = successions.back();
    if (overlap.old_id != kNoSegment && overlap.count > last.shared) {
      last.preferred_id = overlap.old_id;
      last.shared = overlap.count;
    }
  }
  return successions;
}

std::uint32_t hand_out(std::vector<Succession>& successions, std::uint32_t next_id) {
  std::vector<Succession*> claims;
  for (Succession& s : successions) {
    if (s.preferred_id != kNoSegment) claims.push_back(&s);
  }
  std::sort(claims.begin(), claims.end(), [](const Succession* a, const Succession* b) {
    return std::tuple(a->preferred_id, -a->shared, a->component) <
           std::tuple(b->preferred_id, -b->shared, b->component);
  });
  std::uint32_t inherited = kNoSegment;
  for (Succession* claim : claims) {
    if (claim->preferred_id == inherited) continue;
    inherited = claim->preferred_id;
    claim->new_id = inherited;
  }
  for (Succession& s : successions) {
    if (s.new_id == kNoSegment) s.new_id = next_id++;
  }
  return next_id;
}

const Succession& find_succession(std::span<const Succession> successions, PointIndex component) {
  const auto found =
      std::lower_bound(successions.begin(), successions.end(), component,
                       [](const Succession& s, PointIndex value) { return s.component < value; });
  assert(found != successions.end() && found->component == component);
  return *found;
}

std::vector<SegmentEvent> tell_events(std::span<const Succession> successions,
                                      std::span<const Overlap> overlaps) {
  std::vector<SegmentEvent> events;
  append_births(successions, events);
  append_mergers(successions, overlaps, events);
  std::sort(events.begin(), events.end(), [](const SegmentEvent& a, const SegmentEvent& b) {
    return std::tie(a.type, a.segment_id, a.other_id) < std::tie(b.type, b.segment_id, b.other_id);
  });
  return events;
}

}  // namespace kintsugi::segmenter
