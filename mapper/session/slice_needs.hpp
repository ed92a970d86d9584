#pragma once
// Which slices of a session are still needed, of those in some files of its log.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>

#include "lcmtypes/messages.hpp"
#include "mapper/session/log_contents.hpp"

namespace kintsugi::mapper {

/// A patch is needed in the newest revision that is whole in the files; of a correction the pose of
/// each patch for which no later correction and no header of the newest revision has another one,
/// and the loops if it is the last that tells them. With these a receiver has the same map as with
/// all slices. Every id stays, because receivers wait for each; of slices that were not sent as a
/// whole, or are not in the files as a whole, all stays that is there.
class SliceNeeds {
 public:
  using Read = std::function<Bytes(const LogPlace& place)>;

  enum class Need {
    kWhole,
    kShortened,  ///< a correction, of which shortened() is needed
    kNone,
  };

  /// @param contents must outlive this
  /// @param read the data of an event in the files
  /// @throws DecodeError, and what `read` throws
  SliceNeeds(const SessionContents& contents, const Read& read);

  Need need(const PlacedSlice& slice) const;

  /// What is needed of the correction.
  CloudSlice shortened(const PlacedSlice& correction) const;
  /// Of its chunks, for encode_chunk(): so it has no more of them than it had.
  static std::size_t max_chunk_bytes(const PlacedSlice& slice);

 private:
  CloudSlice whole(const PlacedSlice& slice) const;
  void shorten(CloudSlice& correction) const;

  Read read_;
  std::map<std::int32_t, const PlacedSlice*> newest_;  ///< by id
  std::map<std::int32_t, std::int32_t> placed_by_;     ///< patch to the correction that counts
  std::map<std::int32_t, std::int32_t> last_with_loops_of_;  ///< part to correction
};

}  // namespace kintsugi::mapper
