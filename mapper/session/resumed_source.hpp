#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "mapper/source/frame_source.hpp"

namespace kintsugi::mapper {

/// A recording read once more for a session that goes on: of the frames up to the last one that the
/// session had mapped it gives those that were mapped, and counts the rest as dropped, as they were
/// then; after that it gives every frame.
class ResumedSource : public FrameSource {
 public:
  /// @param mapped_utimes of the frames that were mapped, ascending
  /// @param ends_there the session was ending when it was interrupted: no frame comes after them
  ResumedSource(std::unique_ptr<FrameSource> recording, std::vector<std::int64_t> mapped_utimes,
                bool ends_there);

  /// @throws std::runtime_error when a frame that was mapped is not there: another recording
  std::optional<RgbdFrame> next() override;
  [[nodiscard]] std::int64_t frames_total() const override { return recording_->frames_total(); }
  [[nodiscard]] std::string name() const override { return recording_->name(); }
  [[nodiscard]] SourceCounts counts() const override;
  [[nodiscard]] std::string end_reason() const override;
  [[nodiscard]] bool ended_well() const override;

 private:
  bool all_given() const { return num_given_ == mapped_utimes_.size(); }

  std::unique_ptr<FrameSource> recording_;
  const std::vector<std::int64_t> mapped_utimes_;
  const bool ends_there_;
  std::size_t num_given_ = 0;  ///< of mapped_utimes_
  std::int64_t num_skipped_ = 0;
};

}  // namespace kintsugi::mapper
