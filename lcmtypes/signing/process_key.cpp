#include "lcmtypes/signing/process_key.hpp"

#include <cstdlib>
#include <exception>
#include <optional>
#include <utility>

#include <CLI/CLI.hpp>

namespace kintsugi {
namespace {

/// What the command line says, which is parsed before there are threads.
struct Given {
  std::optional<std::shared_ptr<const BusKey>> key;
  bool trusts_logs = false;
};

Given& given() {
  static Given of_process;
  return of_process;
}

void use_key_of(const std::string& file) {
  std::shared_ptr<const BusKey> key;
  try {
    if (!file.empty()) key = BusKey::read(file);
  } catch (const std::exception& error) {
    throw CLI::ValidationError("--bus-key", error.what());
  }
  given().key = std::move(key);
}

}  // namespace

std::shared_ptr<const BusKey> bus_key(const std::string& file) {
  if (!file.empty()) return BusKey::read(file);
  if (given().key) return *given().key;
  const char* const named = std::getenv(kBusKeyVariable);
  return named != nullptr && *named != '\0' ? BusKey::read(named) : nullptr;
}

MessageTrust log_trust() { return {bus_key(), given().trusts_logs}; }

void add_bus_key_flag(CLI::App& app) {
  app.add_option_function<std::string>(
         "--bus-key", use_key_of,
         "sign what is sent with the key in this file (kintsugi-keygen), and take only what is "
         "signed with it")
      ->type_name("FILE")
      ->envname(kBusKeyVariable);
}

void add_log_trust_flags(CLI::App& app) {
  add_bus_key_flag(app);
  app.add_flag("--trust-log", given().trusts_logs,
               "read logs whether or not they are signed, and verify nothing in them");
}

}  // namespace kintsugi
