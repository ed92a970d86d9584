#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "viewer/core/drawing/palette.hpp"

namespace kintsugi::viewer {

/// A short text about one moment of a chart, in a coloured box.
struct Tag {
  int x_px = 0;  ///< the moment
  std::string text;
  Rgb color;
};

/// Rows of tags above or below a chart, each with a leader line to its moment. No box covers
/// another box or the leader line of another tag; tags of the same moment share one line.
class TagRows {
 public:
  static constexpr int kRow_px = 22;  ///< height of a row

  struct Place {
    std::size_t tag = 0;  ///< index
    int row = 0;          ///< 0 is next to the chart
    int left_px = 0;
    int width_px = 0;
  };

  /// Places the tags in their order in `max_rows` rows between `left_px` and `right_px`, so give
  /// the important ones first. Those without room are left out.
  TagRows(std::vector<Tag> tags, int left_px, int right_px, int max_rows);

  std::span<const Place> places() const { return places_; }
  int num_rows() const;  ///< rows with tags in them

  enum class Side { kAboveChart, kBelowChart };
  /// The row next to the chart begins at `first_row_px`, and the leader lines end at `chart_px`.
  void draw(cv::Mat3b& image, Side side, int first_row_px, int chart_px) const;

 private:
  bool find_place(std::size_t tag, int left_px, int right_px, int max_rows);
  bool is_free(const Place& place) const;

  std::vector<Tag> tags_;
  std::vector<Place> places_;
};

}  // namespace kintsugi::viewer
