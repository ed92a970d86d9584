#pragma once
// Small messages from the bus, decoded and checked.

#include <functional>
#include <string>
#include <utility>

#include "lcmtypes/bus/bus.hpp"

namespace kintsugi {

/// Calls `on_message` with every valid Message on `channel`, and `on_bad` (when given) with the
/// reason why one was dropped.
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
