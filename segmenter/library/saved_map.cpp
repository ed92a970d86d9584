#include "segmenter/io/saved_map.hpp"

#include <stdexcept>
#include <utility>

#include "segmenter/library/local_query.hpp"
#include "segmenter/library/segmentation.hpp"
#include "segmenter/map/map_snapshot.hpp"
#include "segmenter/query/answer.hpp"

namespace kintsugi {
namespace {

segmenter::MapSnapshot read(const std::filesystem::path& path) {
  segmenter::SegmentMapState state = segmenter::read_map_state(path);
  try {
    return segmenter::make_snapshot(std::move(state));
  } catch (const std::invalid_argument& reason) {
    throw std::runtime_error(path.string() + ": " + reason.what());
  }
}

}  // namespace

class SavedMap::Implementation {
 public:
  explicit Implementation(const std::filesystem::path& path) : map(read(path)) {}

  const segmenter::MapSnapshot map;
};

SavedMap::SavedMap(const std::filesystem::path& path)
    : implementation_(std::make_unique<Implementation>(path)) {}
SavedMap::~SavedMap() = default;
SavedMap::SavedMap(SavedMap&& other) noexcept = default;
SavedMap& SavedMap::operator=(SavedMap&& other) noexcept = default;

const std::string& SavedMap::name() const { return implementation_->map.state.map_name; }
double SavedMap::resolution_m() const {
  return implementation_->map.state.config.engine.resolution_m;
}
bool SavedMap::is_complete() const { return implementation_->map.is_complete; }
std::span<const CloudPoint> SavedMap::points_W() const {
  return implementation_->map.state.points_W;
}
std::span<const std::uint32_t> SavedMap::labels() const {
  return implementation_->map.state.segment_ids;
}
const std::vector<SegmentStatistics>& SavedMap::segments() const {
  return implementation_->map.segments;
}

SegmentAnswer SavedMap::ask(const SegmentQuery& query) const {
  segmenter::check_local(query);
  return segmenter::answer(implementation_->map, query);
}

}  // namespace kintsugi
