#include "segmenter/io/saved_map.hpp"

#include <array>
#include <new>
#include <numeric>
#include <stdexcept>
#include <string>
#include <type_traits>

#include "lcmtypes/base/atomic_file.hpp"
#include "segmenter/io/record_file.hpp"

namespace kintsugi::segmenter {
namespace {

// The file: Start, Header; the mode and the name of the map as text; then for all slices one after
// another SliceHeader, the indices of rejected points (int32), accepted points as received
// (CloudPoint), their segment ids (uint32); the last change of each segment (LastChange); thetas
// (double); the chunks that are in the map (SequenceRange); where corrections have put patches
// (Place); the checksum. A change of any of this is a new version.
constexpr std::array<char, 8> kMagic = {'K', 'S', 'E', 'G', 'M', 'A', 'P', '\n'};
constexpr std::uint32_t kVersion = 7;
static_assert(kMapParameters.size() == 7, "other parameters are a new version of the file");

struct Start {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t neighbour_search = 0;
};

struct Header {
  std::int64_t session = 0;
  std::int64_t map_session = 0;
  std::int64_t final_revision_sum = 0;
  std::array<double, kMapParameters.size()> parameters{};
  std::int32_t final_slice_id = 0;
  std::uint32_t next_id = 0;
  std::uint32_t num_mode_bytes = 0;
  std::uint32_t num_name_bytes = 0;
  std::uint32_t num_slices = 0;
  std::uint32_t num_rejected = 0;
  std::uint32_t num_points = 0;
  std::uint32_t num_thetas = 0;
  std::uint32_t num_chunk_ranges = 0;
  std::uint32_t num_segments = 0;
  std::uint32_t num_places = 0;
  std::uint32_t reserved = 0;  ///< zero
};

/// Of a patch, as a correction tells it.
struct Place {
  std::int32_t slice_id = 0;
  PatchPlace place;
};

struct SliceHeader {
  std::int32_t slice_id = 0;
  std::int32_t revision = 0;
  std::int32_t num_points = 0;
  std::uint32_t num_rejected = 0;
  std::uint32_t patch = 0;  ///< PatchState
  PatchPlace place;
};
static_assert(sizeof(Start) == 16 && sizeof(Header) == 128 && sizeof(SliceHeader) == 56 &&
                  sizeof(Place) == 40,
              "no padding, which would be written with whatever is in it");

Header header_of(const SegmentMapState& state) {
  Header header;
  header.session = state.session;
  header.map_session = state.map_session;
  header.final_revision_sum = state.final_revision_sum;
  for (std::size_t i = 0; i < kMapParameters.size(); ++i) {
    header.parameters[i] = state.config.engine.*kMapParameters[i].value;
  }
  header.final_slice_id = state.final_slice_id;
  header.next_id = state.next_id;
  header.num_mode_bytes = static_cast<std::uint32_t>(state.config.mode.size());
  header.num_name_bytes = static_cast<std::uint32_t>(state.map_name.size());
  header.num_slices = static_cast<std::uint32_t>(state.slices.size());
  for (const SliceRecord& slice : state.slices) {
    header.num_rejected += static_cast<std::uint32_t>(slice.rejected.size());
  }
  header.num_points = static_cast<std::uint32_t>(state.points_W.size());
  header.num_segments = static_cast<std::uint32_t>(state.last_changes.size());
  header.num_thetas = static_cast<std::uint32_t>(state.thetas.size());
  header.num_places = static_cast<std::uint32_t>(state.motions.places().size());
  header.num_chunk_ranges = static_cast<std::uint32_t>(state.chunks.size());
  return header;
}

std::uint64_t num_bytes_after(const Header& header) {
  constexpr std::uint64_t kPointBytes = sizeof(CloudPoint) + sizeof(std::uint32_t);
  return std::uint64_t{header.num_mode_bytes} + header.num_name_bytes +
         header.num_slices * sizeof(SliceHeader) + header.num_rejected * sizeof(std::int32_t) +
         header.num_points * kPointBytes + header.num_segments * sizeof(LastChange) +
         header.num_thetas * sizeof(double) + header.num_chunk_ranges * sizeof(SequenceRange) +
         header.num_places * sizeof(Place) + sizeof(std::uint32_t);
}

/// Everything that can be told from the first bytes and the size of the file.
Start read_start(RecordReader& file) {
  if (file.size() < sizeof(Start)) {
    file.fail("is no saved segment map: " + std::to_string(file.size()) + " bytes, expected " +
              std::to_string(sizeof(Start)) + " at least");
  }
  const auto start = file.read<Start>();
  if (start.magic != kMagic) {
    file.fail("is no saved segment map: expected KSEGMAP at its beginning");
  }
  if (start.version != kVersion) {
    file.fail("is a saved segment map of version " + std::to_string(start.version) + ", expected " +
              std::to_string(kVersion) + ", which this program reads");
  }
  if (start.neighbour_search > static_cast<std::uint32_t>(NeighbourSearch::kFlann)) {
    file.fail("neighbour search " + std::to_string(start.neighbour_search) + ", expected 0 or 1");
  }
  return start;
}

Header read_header(RecordReader& file) {
  const auto header = file.read<Header>();
  if (const std::uint64_t expected = num_bytes_after(header); file.left() != expected) {
    file.fail(std::to_string(file.left()) + " bytes follow, expected " + std::to_string(expected) +
              " for what the header tells: the file is cut off or damaged");
  }
  if (header.reserved != 0) {
    file.fail("the reserved field is " + std::to_string(header.reserved) + ", expected 0");
  }
  return header;
}

SegmentMapConfig config_of(const Start& start, const Header& header) {
  SegmentMapConfig config;
  for (std::size_t i = 0; i < kMapParameters.size(); ++i) {
    config.engine.*kMapParameters[i].value = header.parameters[i];
  }
  config.engine.neighbour_search = static_cast<NeighbourSearch>(start.neighbour_search);
  return config;
}

std::string read_text(RecordReader& file, std::uint32_t num_bytes) {
  const auto text = file.read_all<char>(num_bytes);
  return {text.begin(), text.end()};
}

template <class Record>
void append(RecordReader& file, std::uint64_t count, std::vector<Record>& records) {
  const auto more = file.read_all<Record>(count);
  records.insert(records.end(), more.begin(), more.end());
}

void check_place(RecordReader& file, std::int32_t slice_id, const PatchPlace& place) {
  if (place.correction >= 0 && place.part >= 0 && place.X_WP.is_valid()) return;
  file.fail("slice " + std::to_string(slice_id) + " is at a place of correction " +
            std::to_string(place.correction) + " in part " + std::to_string(place.part) +
            ", expected both >= 0 and a pose");
}

/// Reads the accepted points of a slice, and moves them.
void read_points(RecordReader& file, SliceRecord& slice, std::vector<CloudPoint>& points_W) {
  if (slice.count == 0 || slice.place.X_WP.is_identity())
    return append(file, slice.count, points_W);
  slice.points_P =
      std::make_shared<std::vector<CloudPoint>>(file.read_all<CloudPoint>(slice.count));
  const std::vector<CloudPoint> more_W = moved(*slice.points_P, slice.place.X_WP);
  points_W.insert(points_W.end(), more_W.begin(), more_W.end());
}

void read_slice(RecordReader& file, SegmentMapState& state) {
  const auto header = file.read<SliceHeader>();
  if (header.num_points < 0 || std::int64_t{header.num_rejected} > header.num_points) {
    file.fail("slice " + std::to_string(header.slice_id) + " of " +
              std::to_string(header.num_points) + " points, " +
              std::to_string(header.num_rejected) + " of them rejected: expected no more");
  }
  if (header.patch > static_cast<std::uint32_t>(PatchState::kLeft)) {
    file.fail("slice " + std::to_string(header.slice_id) + " has the patch state " +
              std::to_string(header.patch) + ", expected 0 to 2");
  }
  check_place(file, header.slice_id, header.place);
  SliceRecord slice;
  slice.slice_id = header.slice_id;
  slice.place = header.place;
  slice.patch = static_cast<PatchState>(header.patch);
  slice.revision = header.revision;
  slice.num_points = header.num_points;
  slice.first = static_cast<PointIndex>(state.points_W.size());
  slice.count = static_cast<PointIndex>(header.num_points) - header.num_rejected;
  slice.rejected = file.read_all<std::int32_t>(header.num_rejected);
  read_points(file, slice, state.points_W);
  append(file, slice.count, state.segment_ids);
  state.slices.push_back(std::move(slice));
}

/// Where corrections have put patches, by ascending id.
void read_motions(RecordReader& file, std::uint32_t num_places, PatchMotions& motions) {
  std::int64_t last_id = -1;
  for (const Place& place : file.read_all<Place>(num_places)) {
    check_place(file, place.slice_id, place.place);
    if (place.slice_id <= last_id || place.place.correction == 0) {
      file.fail("correction " + std::to_string(place.place.correction) + " has moved slice " +
                std::to_string(place.slice_id) + " after slice " + std::to_string(last_id) +
                ", expected a correction >= 1 and ascending slices");
    }
    last_id = place.slice_id;
    motions.learn(place.slice_id, place.place);
  }
}

}  // namespace

void write_map_state(const SegmentMapState& state, const std::filesystem::path& path) {
  AtomicFile file(path);
  RecordWriter out(file.stream());
  Start start;
  start.neighbour_search = static_cast<std::uint32_t>(state.config.engine.neighbour_search);
  out.write(start);
  out.write(header_of(state));
  out.write_all(std::span<const char>(state.config.mode));
  out.write_all(std::span<const char>(state.map_name));
  for (const SliceRecord& slice : state.slices) {
    out.write(SliceHeader{slice.slice_id, slice.revision, slice.num_points,
                          static_cast<std::uint32_t>(slice.rejected.size()),
                          static_cast<std::uint32_t>(slice.patch), slice.place});
    out.write_all(std::span(slice.rejected));
    out.write_all(slice.points_P ? std::span(*slice.points_P)
                                 : std::span(state.points_W).subspan(slice.first, slice.count));
    out.write_all(std::span(state.segment_ids).subspan(slice.first, slice.count));
  }
  out.write_all(std::span(state.last_changes));
  out.write_all(std::span(state.thetas));
  out.write_all(std::span(state.chunks));
  for (const auto& [id, place] : state.motions.places()) out.write(Place{id, place});
  out.write_checksum();
  file.commit();
}

SegmentMapState read_map_state(const std::filesystem::path& path) {
  RecordReader file(path);
  const Start start = read_start(file);
  const Header header = read_header(file);
  file.check_checksum();
  SegmentMapState state;
  state.config = config_of(start, header);
  state.session = header.session;
  state.map_session = header.map_session;
  state.final_revision_sum = header.final_revision_sum;
  state.final_slice_id = header.final_slice_id;
  state.next_id = header.next_id;
  state.config.mode = read_text(file, header.num_mode_bytes);
  state.map_name = read_text(file, header.num_name_bytes);
  state.points_W.reserve(header.num_points);
  state.segment_ids.reserve(header.num_points);
  for (std::uint32_t i = 0; i < header.num_slices; ++i) read_slice(file, state);
  state.last_changes = file.read_all<LastChange>(header.num_segments);
  state.thetas = file.read_all<double>(header.num_thetas);
  state.chunks = file.read_all<SequenceRange>(header.num_chunk_ranges);
  read_motions(file, header.num_places, state.motions);
  if (file.left() != sizeof(std::uint32_t)) {
    file.fail("expected the checksum here: the slices have not the points the header tells");
  }
  return state;
}

std::unique_ptr<SegmentMap> make_map(const SegmentMapState& state,
                                     const std::filesystem::path& path) {
  try {
    return std::make_unique<SegmentMap>(state);
  } catch (const std::logic_error& error) {  // what it holds is no state of a map
    throw std::runtime_error(std::string("'") + path.string() + "': " + error.what());
  } catch (const std::bad_alloc&) {
    throw std::runtime_error(std::string("'") + path.string() + "': not enough memory for its " +
                             std::to_string(state.points_W.size()) + " points and " +
                             std::to_string(state.next_id) + " segment ids");
  }
}

std::unique_ptr<SegmentMap> load_map(const std::filesystem::path& path) {
  return make_map(read_map_state(path), path);
}

}  // namespace kintsugi::segmenter
