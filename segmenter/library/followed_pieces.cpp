#include "segmenter/library/followed_pieces.hpp"

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>

namespace kintsugi::segmenter {
namespace {

/// Of one piece. A client receives slices and updates at about the same time.
constexpr std::size_t kMaxLabelledRevisions = 8;

}  // namespace

void FollowedPieces::add(CloudSlice slice, std::set<std::int32_t>& changed) {
  if (slice.kind == SliceKind::kCorrection) {
    move(slice, changed);
    return;
  }
  if (slice.superseded) return;
  has_final_ |= slice.kind == SliceKind::kFinal;
  const auto found = pieces_.find(slice.id);
  if (found != pieces_.end() && found->second.revision >= slice.revision) return;
  Piece piece;
  piece.revision = slice.revision;
  piece.is_patch = slice.kind == SliceKind::kPatch;
  piece.place = motions_.place_of(slice);
  piece.points_P = std::make_shared<const std::vector<CloudPoint>>(std::move(slice.points_W));
  pieces_[slice.id] = std::move(piece);
  if (const auto labels = labels_.find(slice.id); labels != labels_.end()) {
    labels->second.erase(labels->second.begin(), labels->second.lower_bound(slice.revision));
  }
  changed.insert(slice.id);
}

void FollowedPieces::move(const CloudSlice& correction, std::set<std::int32_t>& changed) {
  for (const auto& [id, place] : motions_.learn(correction)) {
    const auto found = pieces_.find(id);
    if (found == pieces_.end() || !found->second.is_patch) continue;
    if (found->second.place.correction >= place.correction) continue;
    found->second.place = place;
    found->second.points_W = nullptr;
    changed.insert(id);
  }
}

void FollowedPieces::apply(const SegmentUpdate& update, std::set<std::int32_t>& changed) {
  if (update.session < segmenter_session_) return;
  const auto note = [&](std::int32_t id) {
    if (pieces_.contains(id)) changed.insert(id);
  };
  if (update.session > segmenter_session_) {
    for (const auto& [id, labels] : labels_) note(id);
    labels_.clear();
    segmenter_session_ = update.session;
  }
  PieceLabels* const own = labels_of(update.slice_id, update.slice_revision);
  if (own != nullptr && own->apply(update.labels, update.sequence)) note(update.slice_id);
  for (const LabelRun& run : update.runs) {
    PieceLabels* const labels = labels_of(run.slice_id, run.slice_revision);
    if (labels != nullptr && labels->apply(run, update.sequence)) note(run.slice_id);
  }
}

/// Nothing: the points of a newer revision are here.
PieceLabels* FollowedPieces::labels_of(std::int32_t id, std::int32_t revision) {
  const auto piece = pieces_.find(id);
  if (piece != pieces_.end() && revision < piece->second.revision) return nullptr;
  std::map<std::int32_t, PieceLabels>& revisions = labels_[id];
  PieceLabels* const labels = &revisions[revision];
  if (revisions.size() <= kMaxLabelledRevisions) return labels;
  const bool is_oldest = revisions.begin()->first == revision;
  revisions.erase(revisions.begin());
  return is_oldest ? nullptr : labels;
}

std::vector<std::int32_t> FollowedPieces::ids() const {
  std::vector<std::int32_t> ids;
  ids.reserve(pieces_.size());
  for (const auto& [id, piece] : pieces_) ids.push_back(id);
  return ids;
}

const FollowedPieces::Piece& FollowedPieces::find(std::int32_t id) const {
  const auto found = pieces_.find(id);
  if (found == pieces_.end()) {
    throw std::invalid_argument("there is no piece " + std::to_string(id));
  }
  return found->second;
}

FollowedPieces::Points FollowedPieces::points_W(std::int32_t id) const {
  const Piece& piece = find(id);
  if (!piece.points_W) {
    piece.points_W = piece.place.X_WP.is_identity()
                         ? piece.points_P
                         : std::make_shared<const std::vector<CloudPoint>>(
                               moved(*piece.points_P, piece.place.X_WP));
  }
  return piece.points_W;
}

std::ptrdiff_t FollowedPieces::num_without_points() const {
  return std::ranges::count_if(labels_, [this](const auto& entry) {
    const auto& [id, revisions] = entry;
    if (revisions.empty() || revisions.rbegin()->second.labels().empty()) return false;
    const auto piece = pieces_.find(id);
    return piece == pieces_.end() || piece->second.revision < revisions.rbegin()->first;
  });
}

std::vector<std::uint32_t> FollowedPieces::labels(std::int32_t id) const {
  const Piece& piece = find(id);
  const std::size_t num_points = piece.points_P->size();
  if (const auto revisions = labels_.find(id); revisions != labels_.end()) {
    const auto labels = revisions->second.find(piece.revision);
    if (labels != revisions->second.end() && labels->second.labels().size() == num_points) {
      return labels->second.labels();
    }
  }
  return std::vector<std::uint32_t>(num_points, kNoSegment);
}

}  // namespace kintsugi::segmenter
