#pragma once
// Statuses in words: what matters to a person, in part of a line.

#include <string>

#include "lcmtypes/messages.hpp"

namespace kintsugi {

/// Capitals say that something is lost, or that a person must see to it.
std::string text_of(const MapperStatus& status);
std::string text_of(const SegmenterStatus& status);
std::string text_of(const ViewerStatus& status);

}  // namespace kintsugi
