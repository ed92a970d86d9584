#include "segmenter/objects/recognition/shape_features.hpp"

#include <cmath>

#include <pcl/features/fpfh.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/kdtree.h>

namespace kintsugi::segmenter {

namespace {

constexpr int kBins = 11;  // of each of the three histograms

}  // namespace

ShapeFeatures shape_features(const Surface& surface, float radius_m) {
  ShapeFeatures features =
      ShapeFeatures::Zero(kShapeFeatureSize, static_cast<Eigen::Index>(surface.size()));
  if (surface.empty()) return features;
  const pcl::PointCloud<pcl::PointNormal>::Ptr cloud(new pcl::PointCloud<pcl::PointNormal>);
  cloud->reserve(surface.size());
  for (const SurfacePoint& point : surface) {
    pcl::PointNormal p;
    p.getVector3fMap() = point.position;
    p.getNormalVector3fMap() = point.normal;
    cloud->push_back(p);
  }
  pcl::FPFHEstimation<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> estimation;
  estimation.setInputCloud(cloud);
  estimation.setInputNormals(cloud);
  // Unsorted: the sums do not depend on which neighbour is nearest.
  estimation.setSearchMethod(
      pcl::search::KdTree<pcl::PointNormal>::Ptr(new pcl::search::KdTree<pcl::PointNormal>(false)));
  estimation.setRadiusSearch(radius_m);
  pcl::PointCloud<pcl::FPFHSignature33> signatures;
  estimation.compute(signatures);
  for (std::size_t i = 0; i < signatures.size(); ++i) {
    for (int k = 0; k < kShapeFeatureSize; ++k) {
      const float value = signatures[i].histogram[k];
      if (std::isfinite(value)) features(k, static_cast<Eigen::Index>(i)) = value;
    }
  }
  for (Eigen::Index i = 0; i < features.cols(); ++i) {
    for (int first = 0; first < kShapeFeatureSize; first += kBins) {
      auto histogram = features.col(i).segment(first, kBins);
      const float sum = histogram.sum();
      if (sum > 0.0F) histogram = (histogram / sum).cwiseSqrt().eval();
    }
  }
  return features;
}

}  // namespace kintsugi::segmenter
