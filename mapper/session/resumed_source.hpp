#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "mapper/source/frames/frame_source.hpp"

namespace kintsugi::mapper {

/// A recording that is read again for a resumed session. Up to the last frame that was mapped
/// before the interruption it returns exactly the frames that were mapped and counts the others as
/// dropped; after that it returns every frame.
class ResumedSource : public FrameSource {
 public:
  /// @param mapped_utimes of the frames that were mapped, ascending
  /// @param ends_there mapping had ended when the session was interrupted: no frame follows these
  ResumedSource(std::unique_ptr<FrameSource> recording, std::vector<std::int64_t> mapped_utimes,
                bool ends_there);

  /// @throws std::runtime_error when a mapped frame is missing, so this is another recording
  std::optional<RgbdFrame> next() override;
  [[nodiscard]] SourceStatus status() const override;

 private:
  bool all_given() const { return num_given_ == mapped_utimes_.size(); }

  std::unique_ptr<FrameSource> recording_;
  const std::vector<std::int64_t> mapped_utimes_;
  const bool ends_there_;
  std::size_t num_given_ = 0;  ///< of mapped_utimes_
  std::int64_t num_skipped_ = 0;
};

}  // namespace kintsugi::mapper
