#pragma once
// Several messages in one input: the events of an LCM log.

#include <string>
#include <vector>

#include "lcmtypes/codec/codec.hpp"

namespace kintsugi::fuzzing {

struct LoggedMessage {
  std::string channel;
  Bytes data;
};

/// The events at the beginning of `log`, up to the first that is not whole.
std::vector<LoggedMessage> read_events(ByteView log);

/// An LCM log of `events`.
Bytes write_events(const std::vector<LoggedMessage>& events);

}  // namespace kintsugi::fuzzing
