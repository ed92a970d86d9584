// A message of a signed bus: what is let through was signed, and is let through once.

#include <iostream>
#include <memory>

#include "lcmtypes/signing/message_guard.hpp"
#include "tests/decoder_fuzz/require.hpp"
#include "tests/decoder_fuzz/signed_key.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi;  // NOLINT(google-build-using-namespace)
  using fuzzing::kSignedChannel;
  using fuzzing::require;
  using Source = MessageGuard::Source;
  static const auto no_warnings = std::cerr.rdbuf(nullptr);  // there is one for each new guard
  (void)no_warnings;
  static const std::shared_ptr<const BusKey> key(&fuzzing::signed_key(), [](const BusKey*) {});
  const ByteView message(data, size);

  MessageGuard guard({.key = key}, Source::kBus, "");
  const auto opened = guard.open(kSignedChannel, message);
  const auto parts = signed_message::split(message);
  require(!opened || (parts && opened->data() == data && opened->size() < size),
          "what is let through is the message before its signature");
  require(!opened || signed_message::sign(*key, kSignedChannel, parts->session, parts->sequence,
                                          *opened) == Bytes(data, data + size),
          "what is let through is what the key signs");
  require(!guard.open(kSignedChannel, message), "nothing is let through twice");
  require(!MessageGuard({.key = key}, Source::kBus, "").open("Y", message),
          "nothing is let through on another channel");

  MessageGuard trusting({.trusts_all = true}, Source::kLog, "");
  const auto trusted = trusting.open(kSignedChannel, message);
  require(trusted && trusted->size() + (parts ? signed_message::kSignatureBytes : 0) == size,
          "a signature is cut off");
  return 0;
}
