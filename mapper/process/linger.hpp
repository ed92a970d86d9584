#pragma once

#include <functional>

#include "mapper/process/map_publisher.hpp"

namespace kintsugi::mapper {

/// Waits until there was no request for `linger_s` seconds, or for a stop signal; if negative, for
/// a stop signal after this call. Calls `publish_status` several times a second.
void linger(const MapPublisher& publisher, double linger_s,
            const std::function<void()>& publish_status);

}  // namespace kintsugi::mapper
