#pragma once
// Detections of objects and changes as text for a person.

#include <string>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

/// For instance "found"; of a change "new".
const char* to_string(DetectionEvent event);
const char* to_string(ChangeKind kind);

/// One line with its end: the event, where the object is in W, and its segments.
std::string detection_text(const ObjectDetection& detection);
/// One line with its end: the change, its box in W, if moved how far, and its segments.
std::string change_text(const ChangeReport& change);

}  // namespace kintsugi
