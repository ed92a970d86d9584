#pragma once
// Statuses as text for a person: part of a line each, with the most important fields.

#include <string>

#include "lcmtypes/statuses.hpp"

namespace kintsugi {

/// Capital letters mark what is lost, or what a person must attend to.
std::string text_of(const MapperStatus& status);
std::string text_of(const SegmenterStatus& status);
std::string text_of(const ViewerStatus& status);
std::string text_of(const DetectorStatus& status);

}  // namespace kintsugi
