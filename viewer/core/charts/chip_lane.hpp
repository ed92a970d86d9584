#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "viewer/core/drawing/palette.hpp"

namespace kintsugi::viewer {

/// A few words about one moment of a chart, in a box of a colour.
struct Chip {
  int x_px = 0;  ///< the moment
  std::string text;
  Rgb color;
};

/// Rows of chips above or below a chart; a line leads from each chip to the chart. Chips of one
/// moment may stand on each other. Otherwise no box covers another, or a line that leads past it.
class ChipLane {
 public:
  static constexpr int kRow_px = 22;

  struct Place {
    std::size_t chip = 0;
    int row = 0;  ///< 0 is next to the chart
    int left_px = 0;
    int width_px = 0;
  };

  /// Places what has room in `max_rows` rows from `left_px` to `right_px`: first come, first
  /// served, so the important ones first.
  ChipLane(std::vector<Chip> chips, int left_px, int right_px, int max_rows);

  std::span<const Place> places() const { return places_; }
  int num_rows() const;  ///< that are in use

  enum class Side { kAboveChart, kBelowChart };
  /// The row next to the chart begins at `first_row_px`, and the lines end at `chart_px`.
  void draw(cv::Mat3b& image, Side side, int first_row_px, int chart_px) const;

 private:
  bool find_place(std::size_t chip, int left_px, int right_px, int max_rows);
  bool is_free(const Place& place) const;

  std::vector<Chip> chips_;
  std::vector<Place> places_;
};

}  // namespace kintsugi::viewer
