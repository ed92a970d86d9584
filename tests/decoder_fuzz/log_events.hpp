#pragma once
// Several messages in one input, as the events of an LCM log.

#include <string>
#include <vector>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::fuzzing {

struct LoggedMessage {
  std::string channel;
  Bytes data;
};

/// The events of `log` before the first that is incomplete.
std::vector<LoggedMessage> read_events(ByteView log);

/// An LCM log of `events`.
Bytes write_events(const std::vector<LoggedMessage>& events);

}  // namespace kintsugi::fuzzing
