#include <kintsugi/segment_update_t.hpp>

#include "lcmtypes/codec/bulk.hpp"
#include "lcmtypes/codec/statistics.hpp"

namespace kintsugi {
namespace codec {

template <>
struct Bulk<SegmentUpdate> : PlacedByByte<segment_update_t> {
  static constexpr int kNumStrings = 1;
  static constexpr std::int16_t kRecordsVersion = kSegmentRecordsVersion;

  template <class From, class To>
  static void copy(const From& from, To& to) {
    to.utime = from.utime;
    to.session = from.session;
    to.map_session = from.map_session;
    to.slice_id = from.slice_id;
    to.slice_revision = from.slice_revision;
    to.is_final = from.is_final != 0;
    to.num_slices = from.num_slices;
    to.num_points = from.num_points;
    to.num_segments = from.num_segments;
    to.map_name = from.map_name;
  }
  static void header_to_wire(const SegmentUpdate& update, segment_update_t& wire) {
    copy(update, wire);
  }
  static void header_from_wire(const segment_update_t& wire, SegmentUpdate& update) {
    copy(wire, update);
  }
  static void set_counts(segment_update_t& wire, const Counts& counts) {
    wire.num_labels = counts[0];
    wire.num_runs = counts[1];
    wire.num_events = counts[2];
    wire.num_statistics = counts[3];
  }
  static Counts counts(const segment_update_t& wire) {
    return {wire.num_labels, wire.num_runs, wire.num_events, wire.num_statistics};
  }

  static void check_header(const Check& check, const SegmentUpdate& update,
                           const Counts& /*counts*/) {
    check.not_negative("utime", update.utime);
    check.positive("session", update.session);
    check.positive("map_session", update.map_session);
    check.not_negative("slice_id", update.slice_id);
    check.not_negative("slice_revision", update.slice_revision);
    check.not_negative("num_slices", update.num_slices);
    check.not_negative("num_points", update.num_points);
    check.not_negative("num_segments", update.num_segments);
    check.text("map_name", update.map_name);
  }
  static void check_records(const Check& check, const SegmentUpdate& update) {
    for (const LabelRun& run : update.runs) check_run(check, run);
    for (const SegmentEvent& event : update.events) {
      check.range<std::uint32_t>("event type", static_cast<std::uint32_t>(event.type), 0,
                                 static_cast<std::uint32_t>(SegmentEventType::kRetired));
    }
    for (const SegmentStatistics& statistics : update.statistics) {
      check_statistics(check, statistics);
    }
  }

  template <class Update, class Function>
  static void for_each_vector(Update& update, const Function& function) {
    function(update.labels);
    function(update.runs);
    function(update.events);
    function(update.statistics);
  }

 private:
  static void check_run(const Check& check, const LabelRun& run) {
    constexpr std::int64_t kMaxPoints =
        kMaxPayloadBytes / static_cast<std::int64_t>(sizeof(CloudPoint));
    check.not_negative("run slice_id", run.slice_id);
    check.not_negative("run slice_revision", run.slice_revision);
    check.range<std::int64_t>("run count", run.count, 1, kMaxPoints);
    check.range<std::int64_t>("run first", run.first, 0, kMaxPoints - run.count);
  }
};

}  // namespace codec

template std::int64_t payload_bytes(const SegmentUpdate&);
template std::int32_t num_chunks(const SegmentUpdate&, std::size_t);
template Bytes encode_chunk(const SegmentUpdate&, std::int64_t, std::int32_t, std::size_t);
template Chunk<SegmentUpdate> decode_chunk(ByteView);
template SegmentUpdate join(const std::vector<Chunk<SegmentUpdate>>&);

}  // namespace kintsugi
