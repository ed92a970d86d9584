#include "segmenter/library/piece_labels.hpp"

#include <utility>

namespace kintsugi::segmenter {

bool PieceLabels::apply(const std::vector<std::uint32_t>& labels, std::int64_t sequence) {
  if (labels.empty()) return false;
  if (labels_.empty()) {
    labels_.assign(labels.size(), kNoSegment);
    sequences_.assign(labels.size(), -1);
  }
  if (labels.size() != labels_.size()) return false;
  for (std::size_t i = 0; i < labels.size(); ++i) set(i, labels[i], sequence);
  for (const auto& [run, run_sequence] : std::exchange(waiting_, {})) apply(run, run_sequence);
  return true;
}

bool PieceLabels::apply(const LabelRun& run, std::int64_t sequence) {
  if (labels_.empty()) {
    if (waiting_.size() < kMaxWaiting) waiting_.push_back({run, sequence});
    return false;
  }
  const auto first = static_cast<std::size_t>(run.first);
  const std::size_t end = first + static_cast<std::size_t>(run.count);
  if (run.first < 0 || run.count <= 0 || end > labels_.size()) return false;
  for (std::size_t i = first; i < end; ++i) set(i, run.segment_id, sequence);
  return true;
}

void PieceLabels::set(std::size_t point, std::uint32_t label, std::int64_t sequence) {
  // Within an update the labels come before the runs, which are of other pieces.
  if (sequence < sequences_[point]) return;
  labels_[point] = label;
  sequences_[point] = sequence;
}

}  // namespace kintsugi::segmenter
