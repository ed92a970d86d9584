#pragma once

#include <cstddef>
#include <cstdint>
#include <variant>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

/// A message that the viewer uses, from the bus or a log.
using Message = std::variant<CloudSlice, SegmentUpdate, CameraPose, CameraView, SegmenterStatus,
                             SegmentAnswer, ObjectDetection, DetectorStatus>;

/// Memory that a message takes.
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
    std::size_t operator()(const CameraView& m) const {
      return m.depth_mm.size() * sizeof(std::uint16_t) + m.color_jpeg.size();
    }
    std::size_t operator()(const SegmenterStatus& /*small*/) const { return 0; }
    std::size_t operator()(const SegmentAnswer& m) const {
      return m.segments.size() * sizeof(DescribedSegment) +
             m.contacts.size() * sizeof(SegmentContact);
    }
    std::size_t operator()(const ObjectDetection& m) const {
      return m.segment_ids.size() * sizeof(std::uint32_t);
    }
    std::size_t operator()(const DetectorStatus& /*small*/) const { return 0; }
  };
  return sizeof(Message) + std::visit(Bulk{}, message);
}

/// The message belongs to no resent stream: it may be lost anyway, so it may be dropped.
inline bool is_droppable(const Message& message) {
  return !std::holds_alternative<CloudSlice>(message) &&
         !std::holds_alternative<SegmentUpdate>(message);
}

}  // namespace kintsugi::viewer
