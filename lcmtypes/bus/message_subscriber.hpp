#pragma once
// Subscribes to small messages.

#include <functional>
#include <string>
#include <utility>

#include "lcmtypes/bus/bus.hpp"

namespace kintsugi {

/// From now on bus.handle() calls `on_message` with every valid message on `channel`, and `on_bad`
/// (if not empty) with the error of every other.
template <SmallMessage Message>
void subscribe(Bus& bus, const std::string& channel, std::function<void(const Message&)> on_message,
               std::function<void(const DecodeError&)> on_bad = {}) {
  bus.subscribe(channel,
                [on_message = std::move(on_message), on_bad = std::move(on_bad)](ByteView data) {
                  Message message;
                  try {
                    message = decode<Message>(data);
                  } catch (const DecodeError& error) {
                    if (on_bad) on_bad(error);
                    return;
                  }
                  on_message(message);
                });
}

}  // namespace kintsugi
