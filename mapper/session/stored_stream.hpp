#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lcmtypes/stream/sent_store.hpp"
#include "mapper/session/buffered_log.hpp"
#include "mapper/session/chunk_index.hpp"

namespace kintsugi::mapper {

/// The chunks of one session on one channel, stored in a log.
class StoredStream : public SentStore {
 public:
  /// @param log must outlive this
  StoredStream(BufferedLog& log, std::string channel);

  /// Appends the chunk to the log. Never fails for want of space, see BufferedLog.
  /// @throws std::invalid_argument when `sequence` is not next_sequence()
  void add(std::int64_t sequence, ByteView message) override;
  std::optional<Bytes> find(std::int64_t sequence) const override;
  std::int64_t first_sequence() const override;
  std::int64_t next_sequence() const override;
  bool is_safe(std::int64_t sequence) const override { return log_.is_safe(index_, sequence); }

  ChunkFate fate(std::int64_t sequence) const override { return index_.fate(sequence); }
  std::vector<SequenceRange> replaced(std::int64_t begin, std::size_t max_ranges) const override {
    return index_.replaced(begin, max_ranges);
  }

  ChunkIndex& index() { return index_; }

 private:
  BufferedLog& log_;
  const std::string channel_;
  ChunkIndex index_;
};

}  // namespace kintsugi::mapper
