// Segments two squares that are added one after the other, moves one beside the other, and prints
// the segments after each change.

#include <iostream>
#include <vector>

#include <kintsugi/segmentation.hpp>
#include <kintsugi/version.hpp>

static std::vector<kintsugi::CloudPoint> square(float x_m) {
  std::vector<kintsugi::CloudPoint> points;
  for (int i = 0; i < 400; ++i) {
    kintsugi::CloudPoint& point = points.emplace_back();
    point.x = x_m + 0.01F * static_cast<float>(i % 20);
    point.y = 0.01F * static_cast<float>(i / 20);
    point.nz = -1.0F;
  }
  return points;
}

int main() {
  kintsugi::Segmenter segmenter({.resolution_m = 0.01});
  segmenter.add(square(0.0F));
  const kintsugi::PieceId piece = segmenter.add(square(2.0F));
  std::cout << "Kintsugi " << kintsugi::kVersion << '\n';
  std::cout << segmenter.num_segments() << " segments\n";
  // As on the bus, whose records may be used in full.
  const kintsugi::PatchPose X_WP(kintsugi::Pose(Eigen::Translation3d(-1.8, 0.0, 0.0)));
  segmenter.move(piece, X_WP.pose());
  for (const kintsugi::SegmentStatistics& segment : segmenter.segments()) {
    std::cout << "segment " << segment.segment_id << ": " << segment.num_points << " points\n";
  }
}
