#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "viewer/core/rendering/highlight.hpp"
#include "viewer/core/rendering/segment_labels.hpp"
#include "viewer/core/rendering/shade.hpp"
#include "viewer/core/rendering/splat.hpp"

namespace kintsugi::viewer {

/// Points as seen by one camera: what is seen in each pixel is found once, and drawn in as many
/// colorings as wanted.
class Panel {
 public:
  /// Each pixel will be the mean of `supersampling` squared. `highlight` must outlive this, and
  /// what the chunks refer to.
  Panel(std::vector<PointChunk> chunks, const VirtualCamera& camera, const SplatConfig& config,
        int supersampling, const Highlight& highlight);

  const VirtualCamera& camera() const { return camera_; }
  const Highlight& highlight() const { return highlight_; }

  /// The points, what is not highlighted dimmed.
  cv::Mat3b draw(Coloring coloring) const;

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
