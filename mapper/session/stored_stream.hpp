#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "lcmtypes/stream/sent_store.hpp"
#include "mapper/session/log_files.hpp"

namespace kintsugi::mapper {

class SessionLog;

/// The chunks of one stream in a SessionLog, by sequence number: 16 bytes of memory each.
class StoredStream : public SentStore {
 public:
  StoredStream(SessionLog& log, std::string channel);

  /// Appends the chunk to the log. Never fails: see SessionLog.
  /// @throws std::invalid_argument when `sequence` is not next_sequence()
  void add(std::int64_t sequence, ByteView message) override;
  /// Nothing when the chunk is not there, is lost, or cannot be read.
  std::optional<Bytes> find(std::int64_t sequence) const override;
  std::int64_t first_sequence() const override;
  std::int64_t next_sequence() const override;

  /// Forgets what follows the first chunk that is missing: it will be made and added again.
  void forget_behind_gap();
  /// Forgets the chunks from `sequence` on, likewise.
  void forget_from(std::int64_t sequence);

 private:
  friend class SessionLog;
  // Called with the mutex of the log locked.
  void set_place(std::int64_t sequence, const LogPlace& place);
  void set_waiting(std::int64_t sequence);
  void set_lost(std::int64_t sequence);
  LogPlace& place(std::int64_t sequence);

  SessionLog& log_;
  const std::string channel_;
  std::deque<LogPlace> places_;  ///< by sequence number; file < 0: not on disk
};

}  // namespace kintsugi::mapper
