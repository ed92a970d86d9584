#include "mapper/session/stored_stream.hpp"

#include <utility>

#include "lcmtypes/base/argument_check.hpp"

namespace kintsugi::mapper {

StoredStream::StoredStream(BufferedLog& log, std::string channel)
    : log_(log), channel_(std::move(channel)) {}

void StoredStream::add(std::int64_t sequence, ByteView message) {
  require(sequence == index_.end(), "chunk of " + channel_ + " for the log", sequence,
          std::to_string(index_.end()));
  log_.append_chunk(channel_, message, index_, sequence);
}

std::optional<Bytes> StoredStream::find(std::int64_t sequence) const {
  return log_.find(index_, sequence);
}

std::int64_t StoredStream::first_sequence() const { return index_.first(); }

std::int64_t StoredStream::next_sequence() const { return index_.end(); }

}  // namespace kintsugi::mapper
