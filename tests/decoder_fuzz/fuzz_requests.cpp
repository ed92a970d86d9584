// Arbitrary resend requests: only chunks that exist are sent again, each once.

#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/stream/resend_queue.hpp"
#include "tests/decoder_fuzz/log_events.hpp"
#include "tests/decoder_fuzz/require.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace kintsugi;  // NOLINT(google-build-using-namespace): the messages
  constexpr std::int64_t kFirst = 3;
  constexpr std::int64_t kEnd = 40;
  ResendQueue queue;
  double now_s = 0.0;
  for (const auto& event : fuzzing::read_events({data, size})) {
    try {
      queue.want(decode<ResendRequest>(event.data).ranges, kFirst, kEnd, now_s);
    } catch (const DecodeError&) {
    }
    fuzzing::require(queue.size() <= kEnd - kFirst, "each chunk is wanted once");
    if (const auto sequence = queue.next(false)) {
      fuzzing::require(*sequence >= kFirst && *sequence < kEnd, "only what exists is sent");
      queue.sent(*sequence, now_s += 0.02);
    }
  }
  return 0;
}
