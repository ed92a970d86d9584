#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter {

// A Point has a position x, y, z and a unit normal nx, ny, nz, finite float32 all, and a colour
// red, green, blue of 8 bits each; black stands for none.

/// In double, summed as (x + y) + z: like each rounding below, part of the definition of weights.
inline double dot_product(double ax, double ay, double az, double bx, double by, double bz) {
  return (ax * bx + ay * by) + az * bz;
}

/// c of Eq. 2, 1 - n_i . n_j, clamped to >= 0, so that no weight is negative.
template <typename Point>
double normal_difference(const Point& i, const Point& j) {
  return std::max(0.0, 1.0 - dot_product(i.nx, i.ny, i.nz, j.nx, j.ny, j.nz));
}

/// The squared distance of two colours, 0 to 3 * 255^2; 0 where either point has none, which says
/// nothing about the surface.
template <typename Point>
int squared_color_distance(const Point& a, const Point& b) {
  const int red = a.red - b.red;
  const int green = a.green - b.green;
  const int blue = a.blue - b.blue;
  const bool has_a = (a.red | a.green | a.blue) != 0;
  const bool has_b = (b.red | b.green | b.blue) != 0;
  // By arithmetic: most points have a colour, but a branch on the data hinders vectorising.
  return static_cast<int>(has_a) * static_cast<int>(has_b) *
         (red * red + green * green + blue * blue);
}

/// What the colours add to a weight: lambda times their squared distance in the unit cube.
template <typename Point>
double color_term(const Point& a, const Point& b, double color_weight) {
  constexpr double kSquaredRange = 255.0 * 255.0;
  return color_weight / kSquaredRange * squared_color_distance(a, b);
}

/// Eq. 2 for the edge from point i to point j: c, squared where the surface is convex
/// ((p_j - p_i) . n_j > 0). `color_weight` (lambda, >= 0) times the colour difference is added, and
/// the sum rounded once to float32.
template <typename Point>
float directed_edge_weight(const Point& i, const Point& j, double color_weight) {
  const double c = normal_difference(i, j);
  const double rise = dot_product(static_cast<double>(j.x) - i.x, static_cast<double>(j.y) - i.y,
                                  static_cast<double>(j.z) - i.z, j.nx, j.ny, j.nz);
  return static_cast<float>((rise > 0.0 ? c * c : c) + color_term(i, j, color_weight));
}

/// The weight of the undirected edge, the smaller of both directions. Algorithm 2 inserts the two;
/// the smaller alone gives the same partition, because an edge is either joined at its first chance
/// or one of its sides has frozen for good.
template <typename Point>
float edge_weight(const Point& a, const Point& b, double color_weight) {
  // What the directions share is computed once: c and the colour term are the same to the bit, and
  // p_a - p_b is -(p_b - p_a) exactly.
  const double c = normal_difference(a, b);
  const double dx = static_cast<double>(b.x) - a.x;
  const double dy = static_cast<double>(b.y) - a.y;
  const double dz = static_cast<double>(b.z) - a.z;
  const bool is_convex_ab = dot_product(dx, dy, dz, b.nx, b.ny, b.nz) > 0.0;
  const bool is_convex_ba = dot_product(dx, dy, dz, a.nx, a.ny, a.nz) < 0.0;
  // Of one direction squared and one not, the smaller. By arithmetic: on a noisy surface there is
  // no guessing which way a branch would go.
  const auto either =
      static_cast<std::size_t>(is_convex_ab) | static_cast<std::size_t>(is_convex_ba);
  const auto both = static_cast<std::size_t>(is_convex_ab) & static_cast<std::size_t>(is_convex_ba);
  const std::array<double, 2> weights = {c, c * c};
  return static_cast<float>(weights[c <= 1.0 ? either : both] + color_term(a, b, color_weight));
}

}  // namespace kintsugi::segmenter
