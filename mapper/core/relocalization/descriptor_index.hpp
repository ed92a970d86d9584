#pragma once
// Finds the images that share features with a new one.

#include <array>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace kintsugi::mapper {

/// Binary descriptors of many images in four hash tables, each keyed by 20 of the 256 bits
/// (locality-sensitive hashing, Indyk and Motwani 1998; a query looks into one bucket of each
/// table).
///
/// FLANN has this too, but it draws the bits from the system's entropy, so that two runs over the
/// same frames would not give the same map.
class DescriptorIndex {
 public:
  DescriptorIndex();

  /// Adds an image; images are numbered from 0. One row of 32 bytes for each descriptor; the rows
  /// are shared, not copied.
  void add(const cv::Mat_<std::uint8_t>& descriptors);

  /// For each image, how many of the given descriptors have a descriptor of that image within 64
  /// bits in the same bucket.
  std::vector<int> count_matches(const cv::Mat_<std::uint8_t>& descriptors) const;

 private:
  static constexpr int kTables = 4;
  static constexpr int kKeyBits = 20;

  struct Entry {
    std::uint32_t key = 0;
    std::uint32_t image = 0;
    std::uint32_t row = 0;
  };
  struct Table {
    std::array<int, kKeyBits> bits{};
    std::vector<Entry> entries;  ///< sorted by key, then in the order of adding
  };

  static std::uint32_t key_of(const Table& table, const std::uint8_t* descriptor);

  std::array<Table, kTables> tables_;
  std::vector<cv::Mat_<std::uint8_t>> images_;
};

}  // namespace kintsugi::mapper
