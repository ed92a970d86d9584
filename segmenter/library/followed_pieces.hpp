#pragma once
// The points and labels of one map, as a client receives them.

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "lcmtypes/messages.hpp"
#include "lcmtypes/patch_motions.hpp"
#include "segmenter/library/piece_labels.hpp"

namespace kintsugi::segmenter {

/// The slices of one session of a mapper where corrections have moved them, with their labels.
/// Slices and updates may arrive in any order and repeatedly; the result is the same.
class FollowedPieces {
 public:
  using Points = std::shared_ptr<const std::vector<CloudPoint>>;

  /// Adds a slice, a newer revision of one, or the motions of a correction, and adds the pieces
  /// that changed to `changed`.
  void add(CloudSlice slice, std::set<std::int32_t>& changed);
  /// Applies labels and runs likewise. An update of a newer session of the segmenter begins anew.
  void apply(const SegmentUpdate& update, std::set<std::int32_t>& changed);

  [[nodiscard]] std::vector<std::int32_t> ids() const;
  /// @throws std::invalid_argument when there is no such piece
  [[nodiscard]] Points points_W(std::int32_t id) const;
  /// The final slice has come: what is still to come is on its way, or was lost.
  [[nodiscard]] bool has_final() const { return has_final_; }
  /// Pieces with labels of points that have not come.
  [[nodiscard]] std::ptrdiff_t num_without_points() const;
  /// Of each of these points.
  /// @throws std::invalid_argument when there is no such piece
  [[nodiscard]] std::vector<std::uint32_t> labels(std::int32_t id) const;

 private:
  struct Piece {
    std::int32_t revision = 0;
    bool is_patch = false;
    PatchPlace place;
    Points points_P;
    mutable Points points_W;  // null: not computed since the piece has moved
  };

  void move(const CloudSlice& correction, std::set<std::int32_t>& changed);
  [[nodiscard]] const Piece& find(std::int32_t id) const;
  PieceLabels* labels_of(std::int32_t id, std::int32_t revision);

  std::map<std::int32_t, Piece> pieces_;
  PatchMotions motions_;
  bool has_final_ = false;
  std::int64_t segmenter_session_ = 0;
  /// By piece and revision: those of revisions that have not come yet, too.
  std::map<std::int32_t, std::map<std::int32_t, PieceLabels>> labels_;
};

}  // namespace kintsugi::segmenter
