// Messages of another version of Kintsugi, as in an old log, are refused with an error that says
// so.

#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/codec/checksum.hpp"
#include "lcmtypes/codec/codec.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "tests/support/example_messages.hpp"

namespace kintsugi {
namespace {

using namespace testing;  // NOLINT: the examples
using ::testing::HasSubstr;

std::string refusal(const std::function<void()>& decode) {
  try {
    decode();
  } catch (const DecodeError& error) {
    return error.what();
  }
  return "accepted";
}

/// Writes the lowest two bytes of a big-endian integer whose last byte is at `end` - 1.
void put(Bytes& message, std::size_t end, std::size_t value) {
  message.at(end - 1) = static_cast<std::uint8_t>(value);
  message.at(end - 2) = static_cast<std::uint8_t>(value >> 8U);
}

/// A message of one chunk with records of another version, and of another size: `cut_bytes` less.
template <BulkMessage Message>
Bytes of_version(const Message& message, std::size_t version, std::size_t cut_bytes) {
  Bytes data = encode_chunk(message, 0, 0, kDefaultMaxChunkBytes);
  const auto payload = static_cast<std::size_t>(payload_bytes(message));
  // Behind the version there are: the number of bytes, the map's name with its length and a
  // terminator, and the payload.
  const std::size_t end_of_count = data.size() - payload - (4 + message.map_name.size() + 1);
  put(data, end_of_count - 4, version);
  put(data, end_of_count, payload - cut_bytes);
  data.resize(data.size() - cut_bytes);
  codec::set_checksum(data);
  return data;
}

template <BulkMessage Message>
void expect_version_error(const Message& message, const std::string& type, int known) {
  for (const int version : {known - 1, known + 1}) {
    for (const std::size_t cut_bytes : {0U, 4U}) {
      const Bytes data = of_version(message, static_cast<std::size_t>(version), cut_bytes);
      EXPECT_EQ(refusal([&] { (void)decode_chunk<Message>(data); }),
                type + " has records of version " + std::to_string(version) +
                    ", this program knows version " + std::to_string(known) +
                    ": it was sent or recorded by another version of Kintsugi");
    }
  }
  EXPECT_EQ(refusal([&] {
              (void)decode_chunk<Message>(of_version(message, static_cast<std::size_t>(known), 0));
            }),
            "accepted");
}

TEST(CodecVersions, RecordsOfAnotherVersionAreRefusedWhateverTheirSize) {
  expect_version_error(example_slice(10), "cloud_slice_t", kCloudPointVersion);
  expect_version_error(example_update(12), "segment_update_t", kSegmentRecordsVersion);
  expect_version_error(example_answer(4), "segment_answer_t", kSegmentRecordsVersion);
}

TEST(CodecVersions, AnotherVersionOfATypeIsRefusedWhateverItsSize) {
  Bytes message = encode(example_viewer_status());
  message[0] ^= 1;  // LCM's fingerprint depends on the fields of the type
  codec::set_checksum(message);
  for (const std::size_t size : {message.size(), message.size() - 8, codec::kChecksumEnd}) {
    EXPECT_THAT(
        refusal([&] { (void)decode<ViewerStatus>(ByteView(message).first(size)); }),
        HasSubstr("viewer_status_t: the fingerprint is that of another type, or the message "
                  "was sent or recorded by another version of Kintsugi"));
  }
}

TEST(CodecVersions, AReceiverCountsAndReportsRecordsOfAnotherVersion) {
  std::string reason;
  StreamSubscriber<SegmentUpdate> subscriber(
      channels::kSegmentUpdate, [](const SegmentUpdate&) { FAIL() << "accepted"; },
      [&reason](const DecodeError& error) { reason = error.what(); });
  subscriber.handle(channels::kSegmentUpdate,
                    of_version(example_update(12), kSegmentRecordsVersion + 1, 0));
  EXPECT_EQ(subscriber.counts().messages_bad, 1);
  EXPECT_THAT(reason, HasSubstr("another version of Kintsugi"));
}

}  // namespace
}  // namespace kintsugi
