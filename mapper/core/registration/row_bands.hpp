#pragma once

#include <algorithm>
#include <vector>

#include <opencv2/core.hpp>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace kintsugi::mapper {

/// The sums of each band of eight rows of an image, in order: added in this order, they do not
/// depend on the number of threads, and in bands so short single precision is enough.
/// `Sum sum_rows(int first, int last)` is called in parallel.
template <typename Sum, typename SumRows>
std::vector<Sum> sum_bands(cv::Size image, const SumRows& sum_rows) {
  constexpr int kRowsPerBand = 8;
  constexpr int kMinPixelsPerTask = 8192;  // waking a thread for fewer costs more
  std::vector<Sum> bands((image.height + kRowsPerBand - 1) / kRowsPerBand);
  const int pixels_per_band = kRowsPerBand * std::max(1, image.width);
  const tbb::blocked_range<int> all_bands(0, static_cast<int>(bands.size()),
                                          1 + kMinPixelsPerTask / pixels_per_band);
  tbb::parallel_for(all_bands, [&](const tbb::blocked_range<int>& range) {
    for (int band = range.begin(); band < range.end(); ++band) {
      const int first = band * kRowsPerBand;
      bands[band] = sum_rows(first, std::min(first + kRowsPerBand, image.height));
    }
  });
  return bands;
}

}  // namespace kintsugi::mapper
