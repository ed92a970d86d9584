#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

namespace kintsugi::segmenter {

// A Point has a position x, y, z and a unit normal nx, ny, nz, finite float32 all, and a colour
// red, green, blue of 8 bits each; black stands for a point without colour.
//
// All of this is computed in double, in the order that is written here, without fused
// multiply-add, and rounded once to float32. The order is part of the definition of a weight:
// every build and every number of threads gets the same bits.

inline double dot_product(double ax, double ay, double az, double bx, double by, double bz) {
  return (ax * bx + ay * by) + az * bz;
}

/// c of Eq. 2, 1 - n_i . n_j. It is clamped to >= 0, so that no weight is negative.
template <typename Point>
double normal_difference(const Point& i, const Point& j) {
  return std::max(0.0, 1.0 - dot_product(i.nx, i.ny, i.nz, j.nx, j.ny, j.nz));
}

/// The squared distance of two colours, 0 to 3 * 255^2. It is 0 where either point has no colour,
/// since nothing is known there.
template <typename Point>
int squared_color_distance(const Point& a, const Point& b) {
  const int red = a.red - b.red;
  const int green = a.green - b.green;
  const int blue = a.blue - b.blue;
  const bool has_a = (a.red | a.green | a.blue) != 0;
  const bool has_b = (b.red | b.green | b.blue) != 0;
  // Products instead of a branch, which would keep the compiler from vectorising the loop.
  return static_cast<int>(has_a) * static_cast<int>(has_b) *
         (red * red + green * green + blue * blue);
}

/// The weight of an edge between two points: Eq. 2, plus a term for colour. Engines get it from
/// EngineConfig::edge_weight() and hand it on as a value.
///
/// A new term of the weight is added here, with its parameter as a member.
struct EdgeWeight {
  double color_weight = 0.0;  ///< lambda, >= 0

  /// The weight from point i to point j: c, or c^2 where the surface is convex
  /// ((p_j - p_i) . n_j > 0), plus the colour term.
  template <typename Point>
  float directed(const Point& i, const Point& j) const {
    const double c = normal_difference(i, j);
    const double rise = dot_product(static_cast<double>(j.x) - i.x, static_cast<double>(j.y) - i.y,
                                    static_cast<double>(j.z) - i.z, j.nx, j.ny, j.nz);
    return static_cast<float>((rise > 0.0 ? c * c : c) + color_term(i, j));
  }

  /// The weight of the undirected edge: the smaller of both directions. Algorithm 2 inserts both,
  /// and the heavier one never changes the partition: when its turn comes, either the lighter one
  /// has joined the two components, or one of them is frozen for good.
  template <typename Point>
  float operator()(const Point& a, const Point& b) const {
    // What the directions share is computed once: c and the colour term are the same to the bit,
    // and p_a - p_b is exactly -(p_b - p_a).
    const double c = normal_difference(a, b);
    const double dx = static_cast<double>(b.x) - a.x;
    const double dy = static_cast<double>(b.y) - a.y;
    const double dz = static_cast<double>(b.z) - a.z;
    const bool is_convex_ab = dot_product(dx, dy, dz, b.nx, b.ny, b.nz) > 0.0;
    const bool is_convex_ba = dot_product(dx, dy, dz, a.nx, a.ny, a.nz) < 0.0;
    // c^2 is the smaller one up to c = 1: there one convex direction is enough, above it both have
    // to be. Looked up in a table, because on a noisy surface the branch cannot be predicted.
    const auto either =
        static_cast<std::size_t>(is_convex_ab) | static_cast<std::size_t>(is_convex_ba);
    const auto both =
        static_cast<std::size_t>(is_convex_ab) & static_cast<std::size_t>(is_convex_ba);
    const std::array<double, 2> weights = {c, c * c};
    return static_cast<float>(weights[c <= 1.0 ? either : both] + color_term(a, b));
  }

 private:
  /// lambda times the squared distance of the colours in the unit cube.
  template <typename Point>
  double color_term(const Point& a, const Point& b) const {
    constexpr double kSquaredRange = 255.0 * 255.0;
    return color_weight / kSquaredRange * squared_color_distance(a, b);
  }
};

}  // namespace kintsugi::segmenter
