#pragma once

#include <functional>

#include "mapper/process/map_publisher.hpp"

namespace kintsugi::mapper {

/// Stays until nobody has asked for anything for `linger_s` seconds, or until a stop signal;
/// negative: until a stop signal that comes from now on. Says now and then that it is there.
void linger(const MapPublisher& publisher, double linger_s,
            const std::function<void()>& publish_status);

}  // namespace kintsugi::mapper
