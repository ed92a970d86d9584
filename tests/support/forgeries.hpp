#pragma once
// Well-made lies: messages that every decoder accepts, about a map that others are making.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/segment_messages.hpp"
#include "lcmtypes/signing/signed_message.hpp"

namespace kintsugi::testing {

/// Learns from a bus what there is to know without its key, and makes messages of every kind from
/// it: slices, corrections, an end of the map, heartbeats, claims of the map's name, requests,
/// queries, updates, poses, statuses. In turn they have no signature, one with another key, one
/// that was taken from another message; and every fourth is a recorded message as it was.
class Forgeries {
 public:
  struct Message {
    std::string channel;
    Bytes data;
  };

  /// The number under which the forged queries ask, to know whether they are answered.
  static constexpr std::int64_t kClient = 4242;

  Forgeries();

  /// Takes note of a message on the bus, signed or not.
  void learn(const std::string& channel, ByteView data);
  /// True when a slice and a heartbeat were learned, without which nothing can be forged.
  bool knows_enough() const { return slice_ && next_sequence_ > 0 && !recorded_.empty(); }

  /// The next one; knows_enough() must be true.
  Message next();

  /// How many of them were recorded messages as they were.
  std::size_t num_repeated() const { return num_made_ - num_lies_; }

 private:
  enum class Signature { kNone, kOtherKey, kTaken };

  void learn_slice(ByteView message);
  void learn_heartbeat(ByteView message);
  Message lie(std::size_t kind);
  CloudSlice forged_slice(SliceKind kind);
  Message chunk_of(const CloudSlice& slice);
  Bytes with_signature(const Message& message, Signature signature);

  std::optional<CloudSlice> slice_;       // the header of the newest
  std::vector<std::int32_t> slice_ids_;   // that were heard of
  std::int64_t next_sequence_ = 0;        // of the mapper's chunks
  std::vector<Message> recorded_;         // as they were on the bus
  std::optional<Bytes> taken_signature_;  // of the newest signed message
  MessageSigner other_signer_;
  std::size_t num_made_ = 0;
  std::size_t num_lies_ = 0;
};

}  // namespace kintsugi::testing
