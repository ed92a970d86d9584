#pragma once

#include <cstddef>
#include <variant>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

/// What the viewer takes from the bus or a log.
using Message = std::variant<CloudSlice, SegmentUpdate, CameraPose, SegmenterStatus, SegmentAnswer>;

/// Memory of a message.
inline std::size_t bytes_of(const Message& message) {
  struct Bulk {
    std::size_t operator()(const CloudSlice& m) const {
      return m.points_W.size() * sizeof(CloudPoint);
    }
    std::size_t operator()(const SegmentUpdate& m) const {
      return m.labels.size() * sizeof(std::uint32_t) + m.runs.size() * sizeof(LabelRun) +
             m.events.size() * sizeof(SegmentEvent) +
             m.statistics.size() * sizeof(SegmentStatistics);
    }
    std::size_t operator()(const CameraPose& /*small*/) const { return 0; }
    std::size_t operator()(const SegmenterStatus& /*small*/) const { return 0; }
    std::size_t operator()(const SegmentAnswer& m) const {
      return m.segments.size() * sizeof(DescribedSegment) +
             m.contacts.size() * sizeof(SegmentContact);
    }
  };
  return sizeof(Message) + std::visit(Bulk{}, message);
}

/// A message that is lost without harm: nobody sends it again.
inline bool is_passing(const Message& message) {
  return std::holds_alternative<CameraPose>(message) ||
         std::holds_alternative<SegmenterStatus>(message) ||
         std::holds_alternative<SegmentAnswer>(message);
}

}  // namespace kintsugi::viewer
