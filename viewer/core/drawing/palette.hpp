#pragma once
// Every colour that the viewer draws with, named by what is drawn in it.

#include <cstdint>

#include <opencv2/core.hpp>

#include "lcmtypes/messages.hpp"

namespace kintsugi::viewer {

/// A colour, 8 bits per channel, sRGB. OpenCV stores pixels as blue, green, red: the conversions
/// below are the only place where the order changes. cv::Vec3b always means a pixel (BGR).
struct Rgb {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  operator cv::Vec3b() const { return {blue, green, red}; }
  operator cv::Scalar() const {
    return {static_cast<double>(blue), static_cast<double>(green), static_cast<double>(red)};
  }
  bool operator==(const Rgb&) const = default;
};

namespace palette {

// Pictures of the map.
inline constexpr Rgb kBackground{24, 28, 34};  ///< pixels in which there is no point
inline constexpr Rgb kCameraPath{255, 190, 40};
inline constexpr Rgb kLoop{255, 70, 200};
inline constexpr Rgb kCameraFrustum{120, 255, 80};
inline constexpr Rgb kObject{90, 225, 255};  ///< boxes of known objects, and their names
inline constexpr Rgb kUnlabelledPoint{120, 120, 120};
inline constexpr Rgb kColorlessPoint{190, 190, 190};  ///< in true colour, where none was seen
inline constexpr Rgb kHighlightOutline{255, 255, 255};
inline constexpr Rgb kPictureText{235, 235, 235};   ///< titles, segment ids and their leader lines
inline constexpr Rgb kPictureTextEdge{14, 16, 20};  ///< around them
inline constexpr Rgb kPanelGap{72, 80, 90};
inline constexpr Rgb kCaptionBar{38, 44, 52};
inline constexpr Rgb kCaptionText{235, 235, 235};

// Charts.
inline constexpr Rgb kChartBackground{255, 255, 255};
inline constexpr Rgb kChartText{40, 40, 40};  ///< and frames
inline constexpr Rgb kChartSecondaryText{120, 120, 120};
inline constexpr Rgb kChartLightText{255, 255, 255};  ///< on dark colours
inline constexpr Rgb kChartGrid{225, 225, 225};
inline constexpr Rgb kChartCurve{20, 90, 180};
inline constexpr Rgb kTimelineLeader{150, 150, 150};    ///< from an event's box to the chart
inline constexpr Rgb kTimelineHatching{205, 205, 205};  ///< time from which no update is here

}  // namespace palette

/// The colour of a segment: always the same for the same id, different hues for neighbouring ids,
/// and never grey, so that it is not mistaken for kUnlabelledPoint, which kNoSegment has.
Rgb segment_color(std::uint32_t segment_id);

}  // namespace kintsugi::viewer
