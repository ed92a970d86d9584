#include "lcmtypes/client/segment_listener.hpp"

#include <algorithm>
#include <utility>

#include "lcmtypes/channels.hpp"

namespace kintsugi {
namespace {

StreamSubscriber<SegmentUpdate>::Config of_map(const std::string& map_name) {
  StreamSubscriber<SegmentUpdate>::Config stream;
  stream.receiver = new_session();
  stream.wanted_map_name = map_name;
  return stream;
}

}  // namespace

SegmentListener::SegmentListener(const std::string& map_name,
                                 std::function<void(const SegmentUpdate&)> on_update)
    : map_name_(map_name),
      on_update_(std::move(on_update)),
      updates_(
          channels::kSegmentUpdate, [this](const SegmentUpdate& update) { use(update); },
          [this](const DecodeError& reason) { note_bad(reason); }, of_map(map_name)) {}

void SegmentListener::use(const SegmentUpdate& update) {
  if (map_name_.empty()) map_name_ = update.map_name;
  if (update.map_name != map_name_) return;
  const SegmentUpdate* const newest = table_.newest();
  const std::int64_t session = newest != nullptr ? newest->session : update.session;
  if (!table_.apply(update)) return;
  // The segmenter was restarted: updates of its earlier session are not needed any more.
  if (session != update.session) updates_.forget(session);
  on_update_(update);
}

void SegmentListener::note_bad(const DecodeError& reason) {
  dropped_ = "messages dropped: " + std::to_string(++num_bad_) + ", the last: " + reason.what();
}

/// Updates before the last one that listed all segments are not needed.
bool SegmentListener::lacks_updates() const {
  const std::int64_t session = table_.newest()->session;
  const std::vector<StreamGap> gaps = updates_.gaps();
  return std::ranges::any_of(gaps, [&](const StreamGap& gap) {
    // If there are more ranges than are reported, the highest are left out.
    return gap.session == session && (gap.ranges.size() >= kMaxResendRanges ||
                                      gap.ranges.back().last > table_.listed_sequence());
  });
}

std::string SegmentListener::problem() const {
  if (table_.newest() == nullptr) return "no segment update was received";
  if (lacks_updates()) {
    return "updates are missing: the table may lack segments, and have some that no longer exist";
  }
  if (!table_.has_all_segments()) {
    return "the table has " + std::to_string(table_.segments().size()) + " segments, the map " +
           std::to_string(table_.newest()->num_segments);
  }
  return "";
}

bool SegmentListener::has_ended() const {
  return table_.is_final() && (is_whole() || updates_.has_given_up(table_.newest()->session));
}

}  // namespace kintsugi
