#include <algorithm>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "lcmtypes/base/argument_check.hpp"
#include "lcmtypes/bus/bus.hpp"
#include "segmenter/core/ids/slice_labels.hpp"
#include "segmenter/core/parameters/presets.hpp"
#include "segmenter/io/saved_map.hpp"
#include "segmenter/library/local_query.hpp"
#include "segmenter/library/segmentation.hpp"
#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/map/segment_map.hpp"
#include "segmenter/query/answer.hpp"

namespace kintsugi {
namespace {

segmenter::SegmentMapConfig config_of(const SegmenterOptions& options) {
  segmenter::SegmentMapConfig config;
  config.mode = options.mode;
  config.engine = segmenter::preset(options.preset);
  for (const auto& [name, value] : options.parameters) {
    const auto parameter =
        std::ranges::find_if(segmenter::kMapParameters, [&](const auto& candidate) {
          return candidate.name == name && !candidate.comes_with_slices;
        });
    require(parameter != segmenter::kMapParameters.end(), "there is no parameter '" + name + "'");
    config.engine.*(parameter->value) = value;
  }
  return config;
}

/// A patch or correction without points.
CloudSlice empty_slice(const SegmenterOptions& options) {
  require(options.resolution_m > 0.0, "resolution_m", options.resolution_m, "> 0");
  CloudSlice slice;
  slice.session = 1;
  slice.map_name = "map";
  slice.kind = SliceKind::kPatch;
  slice.resolution_m = static_cast<float>(options.resolution_m);
  return slice;
}

void check_pose(const PieceMove& move) {
  const auto& X_WP = move.X_WP;
  const bool is_rigid = X_WP.matrix().allFinite() && X_WP.linear().determinant() > 0.0 &&
                        (X_WP.linear() * X_WP.linear().transpose()).isIdentity(1e-4) &&
                        X_WP.translation().cwiseAbs().maxCoeff() <= kMaxPosition_m;
  require(is_rigid, "the pose X_WP of piece " + std::to_string(move.piece) +
                        " must be a rotation and a translation of at most 1e6 m");
}

}  // namespace

/// A piece is a patch, a move is a correction of the map.
class Segmenter::Implementation {
 public:
  explicit Implementation(const SegmenterOptions& options)
      : empty_(empty_slice(options)), map_(config_of(options), new_session(), empty_) {}

  PieceId add(std::span<const CloudPoint> points_W) {
    CloudSlice slice = next_slice();
    slice.points_W.assign(points_W.begin(), points_W.end());
    change(slice);
    revisions_[slice.id] = 0;
    return slice.id;
  }

  void replace(PieceId piece, std::span<const CloudPoint> points_P) {
    check(piece);
    CloudSlice slice = empty_;
    slice.id = piece;
    slice.revision = revisions_[piece] + 1;
    slice.points_W.assign(points_P.begin(), points_P.end());
    change(slice);
    revisions_[piece] = slice.revision;
  }

  void remove(PieceId piece) {
    replace(piece, {});
    revisions_.erase(piece);
  }

  void move(std::span<const PieceMove> moves) {
    if (moves.empty()) return;
    std::set<PieceId> named;
    CloudSlice correction = next_slice();
    correction.kind = SliceKind::kCorrection;
    correction.correction = num_corrections_ + 1;
    for (const PieceMove& move : moves) {
      check(move.piece);
      check_pose(move);
      require(named.insert(move.piece).second,
              "piece " + std::to_string(move.piece) + " is named twice");
      correction.motions.push_back({move.piece, move.X_WP});
    }
    std::ranges::sort(correction.motions, {}, &PatchMotion::id);
    change(correction);
    num_corrections_ = correction.correction;
  }

  std::vector<PieceId> pieces() const {
    std::vector<PieceId> ids;
    ids.reserve(revisions_.size());
    for (const auto& [id, revision] : revisions_) ids.push_back(id);
    return ids;
  }

  const segmenter::SliceRecord& record(PieceId piece) const {
    check(piece);
    return *map_.cloud().find_slice(piece);
  }

  std::vector<PieceId> relabelled() const {
    std::set<PieceId> pieces;
    if (revisions_.contains(last_change_.slice_id)) pieces.insert(last_change_.slice_id);
    for (const LabelRun& run : last_change_.runs) pieces.insert(run.slice_id);
    return {pieces.begin(), pieces.end()};
  }

  const segmenter::SegmentMap& map() const { return map_; }
  const SegmentUpdate& last_change() const { return last_change_; }

 private:
  void check(PieceId piece) const {
    require(revisions_.contains(piece), "there is no piece " + std::to_string(piece));
  }
  CloudSlice next_slice() const {
    CloudSlice slice = empty_;
    slice.id = next_id_;
    return slice;
  }
  void change(const CloudSlice& slice) {
    last_change_ = std::move(map_.add({&slice, 1}).front());
    next_id_ = std::max(next_id_, slice.id + 1);
  }

  const CloudSlice empty_;
  segmenter::SegmentMap map_;
  std::int32_t next_id_ = 0;  // of pieces and corrections
  std::int32_t num_corrections_ = 0;
  std::map<PieceId, std::int32_t> revisions_;  // of the pieces that exist
  SegmentUpdate last_change_;
};

Segmenter::Segmenter(const SegmenterOptions& options)
    : implementation_(std::make_unique<Implementation>(options)) {}
Segmenter::~Segmenter() = default;
Segmenter::Segmenter(Segmenter&& other) noexcept = default;
Segmenter& Segmenter::operator=(Segmenter&& other) noexcept = default;

PieceId Segmenter::add(std::span<const CloudPoint> points_W) {
  return implementation_->add(points_W);
}
void Segmenter::replace(PieceId piece, std::span<const CloudPoint> points_P) {
  implementation_->replace(piece, points_P);
}
void Segmenter::move(std::span<const PieceMove> moves) { implementation_->move(moves); }
void Segmenter::move(PieceId piece, const Pose& X_WP) {
  const PieceMove one{piece, X_WP};
  implementation_->move({&one, 1});
}
void Segmenter::remove(PieceId piece) { implementation_->remove(piece); }

std::vector<PieceId> Segmenter::pieces() const { return implementation_->pieces(); }

std::vector<std::uint32_t> Segmenter::labels(PieceId piece) const {
  return segmenter::slice_labels(implementation_->record(piece),
                                 implementation_->map().segment_ids().ids());
}

std::vector<CloudPoint> Segmenter::points_W(PieceId piece) const {
  const segmenter::SliceRecord& record = implementation_->record(piece);
  const auto points = implementation_->map().cloud().points_W().subspan(record.first, record.count);
  return {points.begin(), points.end()};
}

std::vector<SegmentStatistics> Segmenter::segments() const {
  return implementation_->map().statistics().all();
}
std::int64_t Segmenter::num_points() const { return implementation_->map().cloud().num_live(); }
std::int64_t Segmenter::num_segments() const {
  return implementation_->map().segment_ids().num_segments();
}

const std::vector<SegmentEvent>& Segmenter::events() const {
  return implementation_->last_change().events;
}
const std::vector<SegmentStatistics>& Segmenter::changed_segments() const {
  return implementation_->last_change().statistics;
}
std::vector<PieceId> Segmenter::relabelled_pieces() const { return implementation_->relabelled(); }

SegmentAnswer Segmenter::ask(const SegmentQuery& query) const {
  segmenter::check_local(query);
  return segmenter::answer(segmenter::take_snapshot(implementation_->map()), query);
}

void Segmenter::save(const std::filesystem::path& path) const {
  segmenter::write_map_state(implementation_->map().state(), path);
}

}  // namespace kintsugi
