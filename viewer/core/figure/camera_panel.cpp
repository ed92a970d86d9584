#include "viewer/core/figure/camera_panel.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <unordered_map>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/figure/overlay.hpp"
#include "viewer/core/figure/segment_labels.hpp"
#include "viewer/core/view/camera_image.hpp"
#include "viewer/core/view/view_segments.hpp"

namespace kintsugi::viewer {
namespace {

/// Segments are looked up in a picture of so many pixels per measured depth, along each axis:
/// between two depths the map has more detail, but not much more.
constexpr int kPixelsPerDepth = 2;

/// Which segment is in each pixel, as a number in a list of ids.
struct SegmentImage {
  cv::Mat1w number;
  std::vector<std::uint32_t> ids;  ///< the first is kNoSegment

  std::uint32_t id(int u, int v) const { return ids[number(v, u)]; }
};

SegmentImage numbered(const IdImage& ids) {
  SegmentImage image{cv::Mat1w(ids.size()), {kNoSegment}};
  std::unordered_map<std::int32_t, std::uint16_t> number_of{
      {static_cast<std::int32_t>(kNoSegment), std::uint16_t{0}}};
  std::int32_t last_id = static_cast<std::int32_t>(kNoSegment);
  std::uint16_t last = 0;
  for (int v = 0; v < ids.rows; ++v) {
    for (int u = 0; u < ids.cols; ++u) {
      if (const std::int32_t id = ids(v, u); id != last_id) {
        // Beyond what fits into 16 bits, segments share a number.
        const auto next =
            static_cast<std::uint16_t>(std::min<std::size_t>(image.ids.size(), UINT16_MAX));
        const auto [entry, is_new] = number_of.try_emplace(id, next);
        if (is_new && next == image.ids.size()) image.ids.push_back(static_cast<std::uint32_t>(id));
        last_id = id;
        last = entry->second;
      }
      image.number(v, u) = last;
    }
  }
  return image;
}

/// Enlarges the picture, without specks and without steps of a pixel in the outlines: each pixel
/// becomes the median of its neighbourhood, which is one of the segments in it, where two meet the
/// one that has more of it.
void enlarge(SegmentImage& image, cv::Size size) {
  constexpr int kWindow = 5;  // the largest that OpenCV takes for 16 bits
  cv::Mat1w large;
  cv::medianBlur(image.number, image.number, kWindow);
  cv::resize(image.number, large, size, 0.0, 0.0, cv::INTER_NEAREST);
  cv::medianBlur(large, image.number, kWindow);
}

/// How a segment is drawn into the image.
struct Tint {
  cv::Vec3f color;
  bool is_tinted = false;
};

std::vector<Tint> tints_of(const SegmentImage& segments, const Highlight& highlight) {
  std::vector<Tint> tints;
  for (const std::uint32_t id : segments.ids) {
    const cv::Vec3b color = segment_color(id);
    tints.push_back({color, id != kNoSegment && (highlight.empty() || highlight.contains(id))});
  }
  return tints;
}

/// The pixel is of another segment than one `reach` pixels away along an axis.
bool is_at_edge(const cv::Mat1w& number, int u, int v, int reach) {
  const std::uint16_t here = number(v, u);
  return here != number(v, std::max(u - reach, 0)) ||
         here != number(v, std::min(u + reach, number.cols - 1)) ||
         here != number(std::max(v - reach, 0), u) ||
         here != number(std::min(v + reach, number.rows - 1), u);
}

void draw_tints(cv::Mat3b& image, const SegmentImage& segments, const Highlight& highlight) {
  constexpr float kInside = 0.45F;  // of a segment's colour
  constexpr float kOutline = 0.95F;
  const int reach = std::max(1, image.cols / 480);
  const std::vector<Tint> tints = tints_of(segments, highlight);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      cv::Vec3b& pixel = image(v, u);
      const Tint& tint = tints[segments.number(v, u)];
      if (tint.is_tinted) {
        const float share = is_at_edge(segments.number, u, v, reach) ? kOutline : kInside;
        pixel = (1.0F - share) * cv::Vec3f(pixel) + share * tint.color;
      } else if (!highlight.empty()) {
        pixel = dimmed(pixel);
      }
    }
  }
}

void draw_ids(cv::Mat3b& image, const SegmentImage& segments, const Highlight& highlight,
              const std::string& title) {
  IdImage ids(segments.number.size());
  for (int v = 0; v < ids.rows; ++v) {
    for (int u = 0; u < ids.cols; ++u) ids(v, u) = static_cast<std::int32_t>(segments.id(u, v));
  }
  const std::array reserved{title_box(image, title)};
  draw_labels(image, place_labels(ids, highlight, reserved));
}

std::string title_of(const CameraView& view) {
  return is_located(view.state) ? "camera" : "camera: " + std::string(to_string(view.state));
}

}  // namespace

cv::Size camera_panel_size(const CameraView& view, cv::Size box) {
  const double scale = std::min(static_cast<double>(box.width) / view.intrinsics.width,
                                static_cast<double>(box.height) / view.intrinsics.height);
  const auto scaled = [scale](int length, int most) {
    return std::clamp(static_cast<int>(std::lround(scale * length)), 1, most);
  };
  return {scaled(view.intrinsics.width, box.width), scaled(view.intrinsics.height, box.height)};
}

cv::Mat3b draw_camera_panel(std::span<const PointChunk> chunks, const CameraView& view,
                            cv::Size size, const Highlight& highlight,
                            std::span<const DrawnObject> objects, const CameraPanelConfig& config) {
  const cv::Size detail(std::max(1, kPixelsPerDepth * view.depth_width()),
                        std::max(1, kPixelsPerDepth * view.depth_height()));
  SplatConfig splat = config.splat;
  // A surface of voxels that are at most a pixel wide has a point in nearly every pixel; specks
  // without one vanish in enlarge().
  splat.min_radius_px = std::max(splat.min_radius_px, splat.radius_vox);
  SegmentImage segments = numbered(segments_in_view(chunks, view, detail, splat));
  enlarge(segments, size);
  cv::Mat3b image = camera_image(view, size);
  draw_tints(image, segments, highlight);
  const std::string title = title_of(view);
  if (config.label_ids || !highlight.empty()) draw_ids(image, segments, highlight, title);
  if (is_located(view.state)) {
    const std::array reserved{title_box(image, title)};
    draw_objects(image, camera_of(view, size), objects, reserved);
  }
  draw_title(image, title);
  return image;
}

}  // namespace kintsugi::viewer
