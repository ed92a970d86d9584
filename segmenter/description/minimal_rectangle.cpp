#include "segmenter/description/minimal_rectangle.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <utility>

namespace kintsugi::segmenter {
namespace {

using Eigen::Vector2d;
using Polygon = std::vector<Vector2d>;

/// Whether a, b, c are a turn to the left.
bool is_left_turn(const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  const Vector2d ab = b - a;
  const Vector2d ac = c - a;
  return ab.x() * ac.y() - ab.y() * ac.x() > 0.0;
}

/// Appends the corners of one half of the hull: the lower one for points sorted by ascending x, the
/// upper one for descending x. The last point belongs to the other half.
template <class Iterator>
void append_half_hull(Iterator point, const Iterator& end, Polygon& hull) {
  const std::size_t first = hull.size();
  for (; point != end; ++point) {
    while (hull.size() >= first + 2 &&
           !is_left_turn(hull[hull.size() - 2], hull[hull.size() - 1], *point)) {
      hull.pop_back();
    }
    hull.push_back(*point);
  }
  hull.pop_back();
}

/// The corners, anticlockwise (Andrew's monotone chain). For equal points it is one corner.
Polygon convex_hull(Polygon points) {
  std::sort(points.begin(), points.end(), [](const Vector2d& a, const Vector2d& b) {
    return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
  });
  points.erase(std::unique(points.begin(), points.end()), points.end());
  if (points.size() < 3) return points;
  Polygon hull;
  append_half_hull(points.begin(), points.end(), hull);
  append_half_hull(points.rbegin(), points.rend(), hull);
  return hull;
}

/// Of least area among those with an edge along `axis`.
Rectangle rectangle_along(const Vector2d& axis, const Polygon& hull) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const Vector2d across(-axis.y(), axis.x());
  Vector2d min = Vector2d::Constant(kInfinity);
  Vector2d max = Vector2d::Constant(-kInfinity);
  for (const Vector2d& corner : hull) {
    const Vector2d place(axis.dot(corner), across.dot(corner));
    min = min.cwiseMin(place);
    max = max.cwiseMax(place);
  }
  const Vector2d middle = 0.5 * (min + max);
  return {middle.x() * axis + middle.y() * across, axis, max - min};
}

}  // namespace

Rectangle minimal_rectangle(std::vector<Vector2d> points) {
  assert(!points.empty());
  const Polygon hull = convex_hull(std::move(points));
  Rectangle best = rectangle_along(Vector2d::UnitX(), hull);
  if (hull.size() == 1) return best;
  double best_area = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector2d edge = hull[(i + 1) % hull.size()] - hull[i];
    const Rectangle rectangle = rectangle_along(edge.normalized(), hull);
    if (rectangle.size.prod() < best_area) {
      best_area = rectangle.size.prod();
      best = rectangle;
    }
  }
  if (best.size.x() < best.size.y()) {
    best.axis = Vector2d(-best.axis.y(), best.axis.x());
    best.size.reverseInPlace();
  }
  return best;
}

}  // namespace kintsugi::segmenter
