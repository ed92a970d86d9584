#pragma once
// The key of this process. A process is on one bus, but opens it, and logs of it, in many places.

#include <memory>
#include <string>

#include "lcmtypes/signing/message_guard.hpp"

namespace CLI {
class App;
}

namespace kintsugi {

/// Names the file of the key where --bus-key does not.
inline constexpr char kBusKeyVariable[] = "KINTSUGI_BUS_KEY";

/// The key of `file`; where that is empty the one of --bus-key; without that the one that
/// KINTSUGI_BUS_KEY names; else null.
/// @throws std::runtime_error as BusKey::read()
std::shared_ptr<const BusKey> bus_key(const std::string& file = "");

/// bus_key() and --trust-log.
/// @throws std::runtime_error as BusKey::read()
MessageTrust log_trust();

/// Adds --bus-key FILE, which gives this process its key (empty: none). A wrong file is an error of
/// the command line.
void add_bus_key_flag(CLI::App& app);

/// Adds --bus-key FILE and --trust-log, which reads logs unverified.
void add_log_trust_flags(CLI::App& app);

}  // namespace kintsugi
