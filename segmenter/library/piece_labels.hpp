#pragma once
// The segments of the points of one revision of a piece.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

/// Labels that do not depend on the order in which updates arrive: every point remembers the update
/// that labelled it, and an update never overrides a later one. Runs that come before the labels of
/// all points wait for them.
class PieceLabels {
 public:
  /// `sequence` is that of the update. Returns whether something may have changed.
  bool apply(const std::vector<std::uint32_t>& labels, std::int64_t sequence);
  /// False also for a run that waits, or reaches beyond the piece.
  bool apply(const LabelRun& run, std::int64_t sequence);

  /// Empty: not known yet.
  const std::vector<std::uint32_t>& labels() const { return labels_; }

 private:
  /// A bound on what a faulty segmenter can make a client keep.
  static constexpr std::size_t kMaxWaiting = 1'000'000;

  struct WaitingRun {
    LabelRun run;
    std::int64_t sequence = 0;
  };

  void set(std::size_t point, std::uint32_t label, std::int64_t sequence);

  std::vector<std::uint32_t> labels_;
  std::vector<std::int64_t> sequences_;  // of the update behind each label
  std::vector<WaitingRun> waiting_;
};

}  // namespace kintsugi::segmenter
