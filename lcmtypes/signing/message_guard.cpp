#include "lcmtypes/signing/message_guard.hpp"

#include <atomic>
#include <iostream>
#include <stdexcept>
#include <utility>

namespace kintsugi {
namespace {

constexpr std::chrono::minutes kWarningPeriod{1};

struct Totals {
  std::atomic<std::int64_t> unsigned_ones{0};
  std::atomic<std::int64_t> forged{0};
  std::atomic<std::int64_t> replayed{0};
};

Totals& totals() {
  static Totals of_process;
  return of_process;
}

/// One write, so that lines of several threads stay whole.
void warn(const std::string& text) { std::cerr << text + "\n" << std::flush; }

std::string counts_text(const RefusedMessages& refused) {
  return "so far " + std::to_string(refused.unsigned_ones) + " not signed, " +
         std::to_string(refused.forged) + " forged, " + std::to_string(refused.replayed) +
         " replayed";
}

}  // namespace

RefusedMessages refused_by_process() {
  return {totals().unsigned_ones, totals().forged, totals().replayed};
}

MessageGuard::MessageGuard(MessageTrust trust, Source source, const std::string& name)
    : trust_(std::move(trust)),
      source_(source),
      where_(source == Source::kLog ? "log '" + name + "'" : "bus " + name) {}

std::optional<ByteView> MessageGuard::open(const std::string& channel, ByteView data,
                                           Clock::time_point now) {
  if (trust_.key && !trust_.trusts_all) return open_signed(channel, data, now);
  const auto parts = signed_message::split(data);
  if (!parts) return data;
  if (trust_.trusts_all) return parts->message;
  tell_of_missing_key(channel);
  return data;  // the decoder refuses it
}

std::optional<ByteView> MessageGuard::open_signed(const std::string& channel, ByteView data,
                                                  Clock::time_point now) {
  const auto parts = signed_message::split(data);
  if (!parts) return refuse(Reason::kUnsigned, channel, now);
  if (!signed_message::is_genuine(*trust_.key, channel, *parts)) {
    return refuse(Reason::kForged, channel, now);
  }
  if (!seen_.take(parts->session, parts->sequence)) {
    return refuse(Reason::kReplayed, channel, now);
  }
  return parts->message;
}

std::nullopt_t MessageGuard::refuse(Reason reason, const std::string& channel,
                                    Clock::time_point now) {
  std::int64_t count = 0;
  std::string text;
  switch (reason) {
    case Reason::kUnsigned:
      count = ++refused_.unsigned_ones;
      ++totals().unsigned_ones;
      text = "it is not signed: its sender has no --bus-key";
      break;
    case Reason::kForged:
      count = ++refused_.forged;
      ++totals().forged;
      text = "its tag is wrong: its sender has another --bus-key, or somebody has changed it";
      break;
    case Reason::kReplayed:
      count = ++refused_.replayed;
      ++totals().replayed;
      text =
          "it was received before: somebody repeats recorded messages, for instance plays a log "
          "again (restart what shall receive a log twice)";
      break;
  }
  if (count == 1 || now >= next_warning_) {
    next_warning_ = now + kWarningPeriod;
    warn(where_ + ": dropped a message on " + channel + ": " + text + "; " + counts_text(refused_));
  }
  return std::nullopt;
}

void MessageGuard::tell_of_missing_key(const std::string& channel) {
  if (source_ == Source::kLog) {
    throw std::runtime_error(where_ +
                             " is signed: give the key with --bus-key FILE, or read it without "
                             "verification with --trust-log");
  }
  if (std::exchange(warned_of_missing_key_, true)) return;
  warn(where_ + ": messages on " + channel +
       " are signed and cannot be used without the key of the bus: --bus-key FILE");
}

}  // namespace kintsugi
