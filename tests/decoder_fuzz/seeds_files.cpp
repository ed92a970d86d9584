// Files: images, clouds, saved maps, recordings, texts.

#include <stdexcept>
#include <vector>

#include <opencv2/imgcodecs.hpp>

#include "mapper/output/map_writers.hpp"
#include "segmenter/core/make_engine.hpp"
#include "segmenter/io/ply/labelled_ply_writer.hpp"
#include "segmenter/io/saved_map.hpp"
#include "segmenter/io/views_file.hpp"
#include "segmenter/objects/library/object_files.hpp"
#include "segmenter/views/view_record.hpp"
#include "tests/decoder_fuzz/input_file.hpp"
#include "tests/decoder_fuzz/seeds.hpp"
#include "tests/segmenter/io/formats/example_clouds.hpp"
#include "tests/segmenter/objects/library/example_object.hpp"
#include "tests/segmenter/process/slice_session.hpp"
#include "tests/support/example_messages.hpp"

namespace kintsugi::fuzzing {
namespace {

Bytes bytes_of(const std::string& text) { return {text.begin(), text.end()}; }

/// depth.txt, rgb.txt and associations.txt with a zero byte between them.
Bytes three_lists(const std::string& depth, const std::string& rgb, const std::string& pairs) {
  return bytes_of(depth + '\0' + rgb + '\0' + pairs);
}

Bytes encoded(const char* extension, const cv::Mat& image) {
  Bytes bytes;
  cv::imencode(extension, image, bytes);
  return bytes;
}

/// Little-endian words, as .oni files have them.
class OniBytes {
 public:
  OniBytes& words(const std::vector<std::uint32_t>& values) {
    for (const std::uint32_t value : values) {
      for (int shift = 0; shift < 32; shift += 8) {
        bytes_.push_back(static_cast<std::uint8_t>(value >> shift));
      }
    }
    return *this;
  }
  /// Magic, type, node, bytes of header and fields, bytes of payload, u64 of the record replaced.
  OniBytes& record(std::uint32_t type, std::uint32_t node, const std::vector<std::uint32_t>& fields,
                   std::uint32_t payload_bytes = 0) {
    const auto fields_bytes = static_cast<std::uint32_t>(28 + 4 * fields.size());
    words({0x0052494E, type, node, fields_bytes, payload_bytes, 0, 0}).words(fields);
    bytes_.resize(bytes_.size() + payload_bytes);
    return *this;
  }
  const Bytes& bytes() const { return bytes_; }

 private:
  Bytes bytes_;
};

/// One depth stream with two frames, and one colour stream; finished or cut off.
Bytes oni_recording(bool finished) {
  constexpr std::uint32_t kNodeAdded = 0x0D;
  constexpr std::uint32_t kNewData = 0x0A;
  constexpr std::uint32_t kEnd = 0x0B;
  OniBytes file;
  // "NI10", version 1.0.1, time and highest node.
  file.words({0x3031494E, 0x00010001, 0, 0, 0, finished ? 2U : 0U});
  for (const std::uint32_t node : {1U, 2U}) {
    // Bytes of the name, the name, type (2 depth, 3 colour), codec, frames, times, seek table.
    file.record(kNodeAdded, node,
                {4, 0x00617461, node + 1, 0, finished ? 2U : 0U, 0, 0, 0, 0, 0, 0});
  }
  for (const std::uint32_t node : {1U, 2U, 1U}) file.record(kNewData, node, {0, 0, 0}, 12);
  if (finished) file.record(kEnd, 0, {});
  return file.bytes();
}

}  // namespace

Seeds image_seeds() {
  const cv::Mat_<std::uint16_t> depth(6, 8, 1'234);
  const cv::Mat_<cv::Vec3b> color(6, 8, cv::Vec3b(10, 200, 90));
  return {{"depth_png", encoded(".png", depth)},
          {"color_png", encoded(".png", color)},
          {"color_jpeg", encoded(".jpg", color)},
          {"grey_jpeg", encoded(".jpg", cv::Mat_<std::uint8_t>(6, 8, 7))}};
}

Seeds cloud_file_seeds() {
  Seeds seeds = log_seeds();
  const auto path = input_folder() / "cloud.ply";
  mapper::CloudWriter writer(path);
  writer.append(testing::example_slice(5).points_W);
  writer.commit();
  seeds["cloud"] = bytes_of(contents(path));
  return seeds;
}

Seeds ply_seeds() {
  const auto path = input_folder() / "labelled.ply";
  segmenter::LabelledPlyWriter writer(path, 3, {"a comment"});
  for (const CloudPoint& point : testing::example_slice(3).points_W) writer.append(point, 1, 2);
  writer.commit();
  const std::string vertices =
      "\nelement vertex 2\nproperty double x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  return {{"labelled", bytes_of(contents(path))},
          {"ascii", bytes_of("ply\nformat ascii 1.0" + vertices +
                             "0 1e-3 +2 1 2 255\n-1 nan inf 0 0 0\n3 0 1 1\n")},
          {"big_endian", bytes_of("ply\nformat binary_big_endian 1.0" + vertices +
                                  std::string(38, '\0') + "\x01" + std::string(4, '\0'))}};
}

Seeds point_file_seeds() {
  Seeds seeds = ply_seeds();
  seeds["npy"] = bytes_of(segmenter::testing::npy_cloud());
  seeds["pcd"] = bytes_of(segmenter::testing::pcd_binary());
  seeds["pcd_compressed"] = bytes_of(segmenter::testing::pcd_compressed());
  seeds["pcd_ascii"] = bytes_of(
      "FIELDS x y z rgb _ n\nSIZE 4 4 4 4 1 2\nTYPE F F F U U I\nCOUNT 1 1 1 1 2 3\nWIDTH 1\n"
      "HEIGHT 1\nDATA ascii\n1 2 3 255 0 0 -1 2 3\n");
  for (const unsigned format : {0U, 3U, 8U}) {
    seeds["las" + std::to_string(format)] = bytes_of(segmenter::testing::las_cloud(format));
  }
  seeds["pts"] = bytes_of("2\n1 2 3 -4 10 20 30\n4 5 6 7 255 0 1\n");
  seeds["csv"] = bytes_of("a,X,Y,Z,\"R\",G,B\n1,2,3,,10,20,30\n");
  return seeds;
}

Seeds saved_map_seeds() {
  Seeds seeds;
  const auto path = input_folder() / "map";
  for (const std::string_view mode : segmenter::engine_modes()) {
    auto slices = segmenter::testing::wavy_session(2, 20);
    slices[0].points_W[3].x = std::numeric_limits<float>::quiet_NaN();
    slices[0].kind = SliceKind::kPatch;
    slices[0].in_volume = true;
    slices[1].revision_sum = 1;
    segmenter::SegmentMapConfig config;
    config.mode = mode;
    segmenter::SegmentMap map(config, 99, slices[0]);
    map.add(slices);
    segmenter::write_map_state(map.state(), path);
    seeds[std::string(mode)] = bytes_of(contents(path));
  }
  return seeds;
}

Seeds object_seeds() {
  const auto folder = input_folder() / "library";
  segmenter::write_object(segmenter::testing::example_object("mug"), folder);
  const auto mug = folder / "mug";
  return {{"mug", bytes_of(contents(mug / segmenter::kObjectFile) + '\0' +
                           contents(mug / segmenter::kModelFile))}};
}

Seeds views_file_seeds() {
  segmenter::ViewRecord record(5, "map");
  CloudSlice patch = segmenter::testing::wavy_session(1, 1)[0];
  patch.kind = SliceKind::kPatch;
  record.add(patch);
  for (int i = 1; i < 4; ++i) {
    CameraView view;
    view.utime = std::int64_t{1'000'000} * i;
    view.session = 5;
    view.state = TrackingState::kTracking;
    view.X_WC.translation().x() = i;
    view.intrinsics = {.fx = 5, .fy = 5, .cx = 3, .cy = 2, .width = 6, .height = 4};
    view.depth_mm.assign(24, static_cast<std::uint16_t>(900 + i));
    record.add(view);
  }
  const auto path = input_folder() / "views";
  segmenter::write_views(record.views(), path);
  return {{"three_views", bytes_of(contents(path))}};
}

Seeds oni_seeds() { return {{"whole", oni_recording(true)}, {"cut_off", oni_recording(false)}}; }

/// Two frames of 4x3 pixels, raw, in a .klg and in a .sens file.
Seeds recording_file_seeds() {
  const auto put = [](std::string& bytes, auto value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
  };
  const std::string depth(24, '\x05');
  const std::string color(36, '\x40');
  std::string klg;
  put(klg, std::int32_t{2});
  std::string sens;
  put(sens, std::uint32_t{4});
  put(sens, std::uint64_t{1});
  sens += 'S';
  for (int matrix = 0; matrix < 4; ++matrix) {
    for (int i = 0; i < 16; ++i) put(sens, i % 5 == 0 ? 1.0F : 0.0F);
  }
  for (const std::int32_t value : {0, 0, 4, 3, 4, 3}) put(sens, value);
  put(sens, 1000.0F);
  put(sens, std::uint64_t{2});
  for (std::int64_t frame = 1; frame <= 2; ++frame) {
    put(klg, frame * 33'333);
    put(klg, static_cast<std::int32_t>(depth.size()));
    put(klg, static_cast<std::int32_t>(color.size()));
    klg += depth + color;
    for (int i = 0; i < 16; ++i) put(sens, i % 5 == 0 ? 1.0F : 0.0F);
    for (int camera = 0; camera < 2; ++camera) put(sens, frame * 33'333);
    put(sens, static_cast<std::uint64_t>(color.size()));
    put(sens, static_cast<std::uint64_t>(depth.size()));
    sens += color + depth;
  }
  return {{"klg", bytes_of(klg)}, {"sens", bytes_of(sens)}};
}

Seeds text_seeds(const std::string& target) {
  static const std::map<std::string, Seeds> seeds = {
      {"calibration",
       {{"pinhole", bytes_of("# fx fy\n525 525.5 319.5 239.5 640 480 5000\n")},
        {"lens", bytes_of("525 525.5 319.5 239.5 640 480 1000 0.1 -0.2 1e-3 0 0.05\n")}}},
      {"folder_recording",
       {{"lists", three_lists("# depth\n0.1 depth/0.png\n0.2 depth/1.png\n",
                              "0.1 rgb/0.png\n0.25 rgb/2.png\n", "")},
        {"associations", three_lists("", "",
                                     "0.1 depth/0.png 0.1 rgb/0.png\n"
                                     "0.2 rgb/1.png 0.2 depth/1.png\n")}}},
      {"trajectory",
       {{"two_poses", bytes_of("# timestamp tx ty tz qx qy qz qw\n0.5 1 2 -3 0 0 0 1\n"
                               "1341836537.6556914 1e-3 0 0 0.5 -0.5 0.5 0.5 # here\n")}}},
      {"recording_uri",
       {{"folder", bytes_of("folder://office?camera=on&depth_modes=640x480@30,80x60@15")},
        {"synthetic", bytes_of("synthetic://office?frames=20&start=3&noise=off&seed=7")},
        {"imitation", bytes_of("synthetic://loop?color_gap=3-9&color_drop=0.5&mirror=stuck&"
                               "replug_after_ms=20&depth_units=1mm,shift")}}}};
  return seeds.at(target);
}

}  // namespace kintsugi::fuzzing
