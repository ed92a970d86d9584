#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "viewer/core/figure/segment_labels.hpp"
#include "viewer/core/rendering/highlight.hpp"
#include "viewer/core/rendering/shade.hpp"
#include "viewer/core/rendering/splat.hpp"

namespace kintsugi::viewer {

/// A picture of points from one camera. The visible point of each pixel is computed once and can
/// then be drawn in several colorings.
class Panel {
 public:
  /// Each pixel is the mean of `supersampling` squared samples. `highlight` and what the chunks
  /// refer to must outlive this object.
  Panel(std::vector<PointChunk> chunks, const VirtualCamera& camera, const SplatConfig& config,
        int supersampling, const Highlight& highlight);

  const VirtualCamera& camera() const { return camera_; }
  const Highlight& highlight() const { return highlight_; }

  /// Points that are not highlighted are dimmed, highlighted segments outlined.
  cv::Mat3b draw(Coloring coloring) const;

  /// Segment of the point in each pixel.
  IdImage segment_ids() const;

 private:
  std::uint32_t segment_at(int u, int v) const;

  std::vector<PointChunk> chunks_;
  VirtualCamera camera_;
  int supersampling_;
  const Highlight& highlight_;
  VirtualCamera fine_camera_;
  VisibilityImage visible_;
};

}  // namespace kintsugi::viewer
