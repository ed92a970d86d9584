#pragma once
// Lets those messages through that were signed with the key of this process, once each.

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "lcmtypes/signing/bus_key.hpp"
#include "lcmtypes/signing/seen_messages.hpp"
#include "lcmtypes/signing/signed_message.hpp"

namespace kintsugi {

/// How many messages were refused, and why.
struct RefusedMessages {
  std::int64_t unsigned_ones = 0;  ///< without a signature
  std::int64_t forged = 0;    ///< the tag is wrong: another key, or other bytes than were signed
  std::int64_t replayed = 0;  ///< received before

  std::int64_t total() const { return unsigned_ones + forged + replayed; }
  bool operator==(const RefusedMessages&) const = default;
};

/// What all receivers of this process have refused since it began. Any thread may call it.
RefusedMessages refused_by_process();

/// Sets messages_unsigned, messages_forged and messages_replayed of a status.
template <class Status>
void report_refused(Status& status) {
  const RefusedMessages refused = refused_by_process();
  status.messages_unsigned = refused.unsigned_ones;
  status.messages_forged = refused.forged;
  status.messages_replayed = refused.replayed;
}

/// Which messages are let through.
struct MessageTrust {
  std::shared_ptr<const BusKey> key{};  ///< null: messages are taken as they are
  bool trusts_all = false;              ///< whatever their signatures are; these are cut off
};

/// Stands between a connection or a log and the decoders. One thread at a time may use it.
class MessageGuard {
 public:
  using Clock = std::chrono::steady_clock;

  enum class Source { kBus, kLog };

  /// @param name of the source: the URL of the bus, the file of the log
  MessageGuard(MessageTrust trust, Source source, const std::string& name);

  /// The message without its signature, a part of `data`; nothing: it is refused. Warns on standard
  /// error: of the first of each kind, and then at most once a minute.
  /// @throws std::runtime_error when a log is signed and there is no key
  std::optional<ByteView> open(const std::string& channel, ByteView data,
                               Clock::time_point now = Clock::now());

  const RefusedMessages& refused() const { return refused_; }

 private:
  enum class Reason { kUnsigned, kForged, kReplayed };

  std::optional<ByteView> open_signed(const std::string& channel, ByteView data,
                                      Clock::time_point now);
  std::nullopt_t refuse(Reason reason, const std::string& channel, Clock::time_point now);
  void tell_of_missing_key(const std::string& channel);

  const MessageTrust trust_;
  const Source source_;
  const std::string where_;  // for warnings
  SeenMessages seen_;
  RefusedMessages refused_;
  Clock::time_point next_warning_;
  bool warned_of_missing_key_ = false;
};

}  // namespace kintsugi
