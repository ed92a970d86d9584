#pragma once
// Which of many images share features with a new one?

#include <array>
#include <cstdint>
#include <vector>

#include <opencv2/core.hpp>

namespace kintsugi::mapper {

/// Binary descriptors of many images in four hash tables, each keyed by 20 of the 256 bits
/// (locality sensitive hashing, Indyk and Motwani 1998; one bucket a table is looked into).
///
/// FLANN has the same, but draws the bits from the system's entropy: two runs over the same frames
/// would not give the same map.
class DescriptorIndex {
 public:
  DescriptorIndex();

  /// Adds an image, numbered from 0. Rows of 32 bytes; they are shared, not copied.
  void add(const cv::Mat_<std::uint8_t>& descriptors);

  /// For each image the number of the given descriptors that have a near one (at most 64 bits
  /// apart) in a common bucket.
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
    std::vector<Entry> entries;  ///< by key, then in the order of adding
  };

  static std::uint32_t key_of(const Table& table, const std::uint8_t* descriptor);

  std::array<Table, kTables> tables_;
  std::vector<cv::Mat_<std::uint8_t>> images_;
};

}  // namespace kintsugi::mapper
