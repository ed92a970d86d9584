#include "segmenter/io/views_file.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <ostream>
#include <span>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lcmtypes/base/atomic_file.hpp"
#include "segmenter/io/record_file.hpp"
#include "segmenter/views/packed_depth.hpp"

namespace kintsugi::segmenter {
namespace {

// The file: Start, Header; the name of the map as text; of each view ViewHeader and its compressed
// depth; the checksum. A change of any of this is a new version.
constexpr std::array<char, 8> kMagic = {'K', 'V', 'I', 'E', 'W', 'S', '\r', '\n'};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kMaxNameBytes = 1'024;  // as texts on the bus
// Of the depth images; those of the mapper have 160 to 319 pixels a row.
constexpr std::int32_t kMaxSide_px = 4'096;

struct Start {
  std::array<char, 8> magic = kMagic;
  std::uint32_t version = kVersion;
  std::uint32_t reserved = 0;  ///< zero
};

struct Header {
  std::int64_t map_session = 0;
  std::uint64_t num_depth_bytes = 0;  ///< of all views
  std::uint32_t num_name_bytes = 0;
  std::uint32_t num_views = 0;
};

using PoseNumbers = std::array<double, 12>;  ///< rows of the 3x4 matrix [R | t], t in metres

struct ViewHeader {
  std::int64_t utime = 0;
  PoseNumbers X_PC{};
  PoseNumbers X_WC{};
  double fx = 0.0;
  double fy = 0.0;
  double cx = 0.0;
  double cy = 0.0;
  std::int32_t width = 0;
  std::int32_t height = 0;
  std::int32_t patch = 0;
  std::int32_t part = 0;
  std::uint32_t num_depth_bytes = 0;
  std::uint32_t reserved = 0;  ///< zero
};
static_assert(sizeof(Start) == 16 && sizeof(Header) == 24 && sizeof(ViewHeader) == 256,
              "no padding, which would be written with whatever is in it");

PoseNumbers numbers_of(const Pose& pose) {
  PoseNumbers numbers{};
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      numbers[static_cast<std::size_t>(4 * row + column)] = pose.matrix()(row, column);
    }
  }
  return numbers;
}

Pose pose_of(const PoseNumbers& numbers) {
  Pose pose = Pose::Identity();
  for (Eigen::Index row = 0; row < 3; ++row) {
    for (Eigen::Index column = 0; column < 4; ++column) {
      pose.matrix()(row, column) = numbers[static_cast<std::size_t>(4 * row + column)];
    }
  }
  return pose;
}

ViewHeader header_of(const KeptView& view) {
  ViewHeader header;
  header.utime = view.utime;
  header.X_PC = numbers_of(view.X_PC);
  header.X_WC = numbers_of(view.X_WC);
  header.fx = view.intrinsics.fx;
  header.fy = view.intrinsics.fy;
  header.cx = view.intrinsics.cx;
  header.cy = view.intrinsics.cy;
  header.width = view.intrinsics.width;
  header.height = view.intrinsics.height;
  header.patch = view.patch;
  header.part = view.part;
  header.num_depth_bytes = static_cast<std::uint32_t>(view.packed_depth->size());
  return header;
}

bool is_pose(const Pose& pose) {
  constexpr double kTolerance = 1e-4;  // of a rotation; products of rounded ones are far within
  const Eigen::Matrix3d R = pose.linear();
  return pose.matrix().allFinite() && pose.translation().cwiseAbs().maxCoeff() <= kMaxPosition_m &&
         (R * R.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() <= kTolerance &&
         R.determinant() > 0.0;
}

bool is_camera(const Intrinsics& camera) {
  return std::isfinite(camera.fx) && std::isfinite(camera.fy) && camera.fx > 0.0 &&
         camera.fy > 0.0 && std::isfinite(camera.cx) && std::isfinite(camera.cy) &&
         camera.width > 0 && camera.width <= kMaxSide_px && camera.height > 0 &&
         camera.height <= kMaxSide_px;
}

void read_start(RecordReader& file) {
  if (file.size() < sizeof(Start)) {
    file.fail("is no file of views: " + std::to_string(file.size()) + " bytes, expected " +
              std::to_string(sizeof(Start)) + " at least");
  }
  const auto start = file.read<Start>();
  if (start.magic != kMagic) file.fail("is no file of views: expected KVIEWS at its beginning");
  if (start.version != kVersion) {
    file.fail("has views of version " + std::to_string(start.version) + ", expected " +
              std::to_string(kVersion) + ", which this program reads");
  }
  if (start.reserved != 0) {
    file.fail("the reserved field is " + std::to_string(start.reserved) + ", expected 0");
  }
}

Header read_header(RecordReader& file) {
  const auto header = file.read<Header>();
  if (header.num_name_bytes > kMaxNameBytes) {
    file.fail("the name of the map has " + std::to_string(header.num_name_bytes) +
              " bytes, expected " + std::to_string(kMaxNameBytes) + " at most");
  }
  // Each term is less than 2^41, but for the bytes of depth.
  const std::uint64_t others = std::uint64_t{header.num_name_bytes} +
                               header.num_views * sizeof(ViewHeader) + sizeof(std::uint32_t);
  if (file.left() < others || file.left() - others != header.num_depth_bytes) {
    file.fail(std::to_string(file.left()) + " bytes follow, expected " + std::to_string(others) +
              " and " + std::to_string(header.num_depth_bytes) +
              " of depth, as the header tells: the file is cut off or damaged");
  }
  return header;
}

/// A small image compresses to a thousandth at best (zlib): more is not allocated for it.
void check_depth(RecordReader& file, const KeptView& view, const std::string& name) {
  const auto width = static_cast<std::size_t>(view.intrinsics.width);
  const auto height = static_cast<std::size_t>(view.intrinsics.height);
  constexpr std::size_t kMostCompressed = 1'100;
  if (2 * width * height > kMostCompressed * view.packed_depth->size()) {
    file.fail(name + " has " + std::to_string(view.packed_depth->size()) +
              " bytes of depth, too few for " + std::to_string(width) + " x " +
              std::to_string(height) + " pixels");
  }
  try {
    (void)unpack_depth(*view.packed_depth, width, height);
  } catch (const std::invalid_argument& error) {
    file.fail(name + ": " + error.what());
  }
}

KeptView read_view(RecordReader& file, std::size_t number, std::int64_t utime_before) {
  const std::string name = "view " + std::to_string(number);
  const auto header = file.read<ViewHeader>();
  KeptView view;
  view.utime = header.utime;
  view.X_PC = pose_of(header.X_PC);
  view.X_WC = pose_of(header.X_WC);
  view.intrinsics = {.fx = header.fx,
                     .fy = header.fy,
                     .cx = header.cx,
                     .cy = header.cy,
                     .width = header.width,
                     .height = header.height,
                     .distortion = {}};
  view.patch = header.patch;
  view.part = header.part;
  if (view.utime <= utime_before) {
    file.fail(name + " is of time " + std::to_string(view.utime) + ", expected later than " +
              std::to_string(utime_before) + ", that of the view before");
  }
  if (!is_pose(view.X_PC) || !is_pose(view.X_WC)) {
    file.fail(name + " has poses that are no rotations and positions within " +
              std::to_string(static_cast<int>(kMaxPosition_m)) + " m");
  }
  if (!is_camera(view.intrinsics)) {
    file.fail(name + " has a camera of " + std::to_string(header.width) + " x " +
              std::to_string(header.height) + " pixels with the focal lengths " +
              std::to_string(header.fx) + " and " + std::to_string(header.fy) + ", expected 1 to " +
              std::to_string(kMaxSide_px) + " pixels and lengths > 0");
  }
  if (view.patch < KeptView::kNoPatch || view.part < 0 || header.reserved != 0) {
    file.fail(name + " hangs on patch " + std::to_string(view.patch) + " in part " +
              std::to_string(view.part) + ", expected -1 or a patch, and a part");
  }
  view.packed_depth = std::make_shared<const std::vector<std::uint8_t>>(
      file.read_all<std::uint8_t>(header.num_depth_bytes));
  check_depth(file, view, name);
  return view;
}

void write(const ViewSet& views, std::ostream& stream) {
  Header header;
  header.map_session = views.map_session;
  header.num_name_bytes = static_cast<std::uint32_t>(views.map_name.size());
  header.num_views = static_cast<std::uint32_t>(views.views.size());
  for (const KeptView& view : views.views) header.num_depth_bytes += view.packed_depth->size();
  RecordWriter out(stream);
  out.write(Start{});
  out.write(header);
  out.write_all(std::span<const char>(views.map_name));
  for (const KeptView& view : views.views) {
    out.write(header_of(view));
    out.write_all(std::span<const std::uint8_t>(*view.packed_depth));
  }
  out.write_checksum();
}

ViewSet read(RecordReader& file) {
  read_start(file);
  const Header header = read_header(file);
  file.check_checksum();
  ViewSet views;
  views.map_session = header.map_session;
  const auto name = file.read_all<char>(header.num_name_bytes);
  views.map_name.assign(name.begin(), name.end());
  views.views.reserve(header.num_views);
  std::int64_t utime = -1;
  for (std::uint32_t i = 0; i < header.num_views; ++i) {
    views.views.push_back(read_view(file, i, utime));
    utime = views.views.back().utime;
  }
  if (file.left() != sizeof(std::uint32_t)) {
    file.fail("expected the checksum here: the views have not the depth the header tells");
  }
  return views;
}

}  // namespace

std::filesystem::path views_file_of(const std::filesystem::path& saved_map) {
  std::filesystem::path path = saved_map;
  path += ".views";
  return path;
}

void write_views(const ViewSet& views, const std::filesystem::path& path) {
  AtomicFile file(path);
  write(views, file.stream());
  file.commit();
}

ViewSet read_views(const std::filesystem::path& path) {
  RecordReader file(path);
  return read(file);
}

std::vector<std::uint8_t> view_bytes(const ViewSet& views) {
  std::ostringstream stream;
  stream.exceptions(std::ios::badbit | std::ios::failbit);
  write(views, stream);
  const std::string_view bytes = stream.view();
  return {bytes.begin(), bytes.end()};
}

ViewSet views_of_bytes(std::span<const std::uint8_t> bytes, const std::string& source) {
  RecordReader reader(bytes, source);
  return read(reader);
}

ViewSet read_views_of(const std::filesystem::path& path, std::int64_t map_session,
                      const std::string& map_name) {
  ViewSet views = read_views(path);
  if (views.map_session != map_session || views.map_name != map_name) {
    throw std::runtime_error("'" + path.string() + "' has the views of session " +
                             std::to_string(views.map_session) + " of map '" + views.map_name +
                             "', expected session " + std::to_string(map_session) + " of map '" +
                             map_name + "'");
  }
  return views;
}

}  // namespace kintsugi::segmenter
