#pragma once
// Algorithms 1-5 of the paper, transcribed line by line with sets and maps: slow, and independent
// of the engines, which are compared with it. Two things that the pseudocode does not say: a join
// needs two different segments, and an edge needs two different points.

#include <algorithm>
#include <cmath>
#include <list>
#include <map>
#include <random>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "lcmtypes/messages.hpp"

namespace kintsugi::segmenter::testing {

struct LiteralParameters {
  double T = 0.001;
  double k = 0.0005;
  double lambda = 0.0;
  double beta = 0.85;
  float r = 0.02F;
};

struct LiteralEdge {
  int i;
  int j;
  float w;
};

struct LiteralSegment {
  std::set<int> d;
  double theta;
};

using LiteralSegments = std::list<LiteralSegment>;

/// ||(r, g, b)_i - (r, g, b)_j||^2, channels from 0 to 255; black is no colour.
inline double literal_color_difference(const CloudPoint& i, const CloudPoint& j) {
  if (i.red == 0 && i.green == 0 && i.blue == 0) return 0.0;
  if (j.red == 0 && j.green == 0 && j.blue == 0) return 0.0;
  return std::pow(i.red - j.red, 2) + std::pow(i.green - j.green, 2) + std::pow(i.blue - j.blue, 2);
}

/// Eq. 2 with colour.
inline float literal_weight(const CloudPoint& i, const CloudPoint& j, double lambda) {
  const double x = static_cast<double>(i.nx) * static_cast<double>(j.nx);
  const double y = static_cast<double>(i.ny) * static_cast<double>(j.ny);
  const double z = static_cast<double>(i.nz) * static_cast<double>(j.nz);
  double c = 1.0 - (x + y + z);
  if (c < 0.0) c = 0.0;
  const double dx = static_cast<double>(j.x) - static_cast<double>(i.x);
  const double dy = static_cast<double>(j.y) - static_cast<double>(i.y);
  const double dz = static_cast<double>(j.z) - static_cast<double>(i.z);
  const double side = dx * j.nx + dy * j.ny + dz * j.nz;
  const double color = lambda / (255.0 * 255.0) * literal_color_difference(i, j);
  return static_cast<float>((side > 0.0 ? c * c : c) + color);
}

inline bool literal_neighbours(const CloudPoint& i, const CloudPoint& j, float r) {
  const float dx = i.x - j.x;
  const float dy = i.y - j.y;
  const float dz = i.z - j.z;
  return dx * dx + dy * dy + dz * dz < r * r;
}

/// Algorithm 2. Equal weights come in a random order given by `seed`, which must not matter.
inline std::vector<LiteralEdge> literal_build_graph(std::span<const CloudPoint> points,
                                                    const std::set<int>& border,
                                                    const std::set<int>& D,
                                                    const LiteralParameters& parameters,
                                                    unsigned seed) {
  std::vector<LiteralEdge> E;
  std::set<int> all = border;
  all.insert(D.begin(), D.end());
  for (const int i : D) {
    for (const int j : all) {
      if (i != j && literal_neighbours(points[i], points[j], parameters.r)) {
        E.push_back({i, j, literal_weight(points[i], points[j], parameters.lambda)});
      }
    }
  }
  std::shuffle(E.begin(), E.end(), std::mt19937(seed));
  std::stable_sort(E.begin(), E.end(),
                   [](const LiteralEdge& a, const LiteralEdge& b) { return a.w < b.w; });
  return E;
}

/// The segments and which one each point is in.
class LiteralPartition {
 public:
  void add(LiteralSegment segment) {
    segments.push_back(std::move(segment));
    for (const int i : segments.back().d) of[i] = std::prev(segments.end());
  }
  void remove(LiteralSegments::iterator segment) {
    for (const int i : segment->d) of.erase(i);
    segments.erase(segment);
  }
  /// Lines 8-11 of Algorithm 1, 16-20 of Algorithm 4.
  void join(int i, int j, float w, double k) {
    LiteralSegment joined = *of.at(i);
    joined.d.insert(of.at(j)->d.begin(), of.at(j)->d.end());
    joined.theta = w + k / static_cast<double>(joined.d.size());
    remove(of.at(i));
    remove(of.at(j));
    add(std::move(joined));
  }

  LiteralSegments segments;
  std::map<int, LiteralSegments::iterator> of;
};

/// Algorithm 1, lines 2-13, over the points 0 .. num_points - 1.
inline LiteralPartition literal_segmenter(const std::vector<LiteralEdge>& E, int num_points,
                                          double T, double k) {
  LiteralPartition S;
  for (int i = 0; i < num_points; ++i) S.add({{i}, T});
  for (const LiteralEdge& e : E) {
    if (S.of.at(e.i) == S.of.at(e.j)) continue;
    if (e.w < std::min(S.of.at(e.i)->theta, S.of.at(e.j)->theta)) S.join(e.i, e.j, e.w, k);
  }
  return S;
}

inline LiteralPartition literal_batch(std::span<const CloudPoint> points,
                                      const LiteralParameters& parameters, unsigned seed = 0) {
  std::set<int> D;
  for (int i = 0; i < static_cast<int>(points.size()); ++i) D.insert(i);
  const auto E = literal_build_graph(points, {}, D, parameters, seed);
  return literal_segmenter(E, static_cast<int>(points.size()), parameters.T, parameters.k);
}

/// Algorithms 3-5.
class LiteralVoting {
 public:
  explicit LiteralVoting(const LiteralParameters& parameters) : parameters_(parameters) {}

  /// Segments the points from the last call's end to that of `points`; returns the rounds.
  int add(std::span<const CloudPoint> points, unsigned seed) {
    points_ = points;
    std::set<int> D;
    for (int i = num_points_; i < static_cast<int>(points.size()); ++i) D.insert(i);
    num_points_ = static_cast<int>(points.size());
    for (int c = 0;; ++c) {
      const std::set<int> border = border_of(D);
      const auto E = literal_build_graph(points, border, D, parameters_, seed);
      std::set<int> discrepant;
      LiteralPartition fresh = segment_graph(D, E, border, discrepant);
      const std::vector<LiteralSegments::iterator> voted = vote(discrepant, D, E, c);
      for (const auto segment : voted) {
        D.insert(segment->d.begin(), segment->d.end());
        S_.remove(segment);
      }
      if (voted.empty()) {
        for (const LiteralSegment& segment : fresh.segments) S_.add(segment);
        return c + 1;
      }
    }
  }

  const LiteralPartition& partition() const { return S_; }

 private:
  /// Algorithm 3, line 3.
  std::set<int> border_of(const std::set<int>& D) const {
    std::set<int> border;
    for (const auto& [j, segment] : S_.of) {
      for (const int i : D) {
        if (literal_neighbours(points_[i], points_[j], parameters_.r)) border.insert(j);
      }
    }
    return border;
  }

  /// Algorithm 4.
  LiteralPartition segment_graph(const std::set<int>& D, const std::vector<LiteralEdge>& E,
                                 const std::set<int>& border, std::set<int>& discrepant) const {
    LiteralPartition fresh;
    for (const int i : D) fresh.add({{i}, parameters_.T});
    for (const LiteralEdge& e : E) {
      const bool at_border = border.contains(e.j);
      const double t_i = fresh.of.at(e.i)->theta;
      const double t_j = at_border ? S_.of.at(e.j)->theta : fresh.of.at(e.j)->theta;
      if (!(e.w < std::min(t_i, t_j))) continue;
      if (at_border) {
        discrepant.insert(e.j);
      } else if (fresh.of.at(e.i) != fresh.of.at(e.j)) {
        fresh.join(e.i, e.j, e.w, parameters_.k);
      }
    }
    return fresh;
  }

  /// Algorithm 5.
  std::vector<LiteralSegments::iterator> vote(const std::set<int>& discrepant,
                                              const std::set<int>& D,
                                              const std::vector<LiteralEdge>& E, int c) {
    std::vector<LiteralSegments::iterator> voted;
    for (auto segment = S_.segments.begin(); segment != S_.segments.end(); ++segment) {
      int to_discrepant = 0;
      int to_segment = 0;
      for (const LiteralEdge& e : E) {
        if (!segment->d.contains(e.j) || !D.contains(e.i)) continue;
        ++to_segment;
        if (discrepant.contains(e.j)) ++to_discrepant;
      }
      if (to_discrepant == 0) continue;
      const double alpha = 1.0 - std::pow(parameters_.beta, c);  // Eq. 4
      if (static_cast<double>(to_discrepant) / to_segment > alpha) voted.push_back(segment);
    }
    return voted;
  }

  LiteralParameters parameters_;
  std::span<const CloudPoint> points_;
  int num_points_ = 0;
  LiteralPartition S_;
};

}  // namespace kintsugi::segmenter::testing
