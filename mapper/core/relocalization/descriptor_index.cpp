#include "mapper/core/relocalization/descriptor_index.hpp"

#include <algorithm>
#include <numeric>
#include <random>

#include <opencv2/core/hal/hal.hpp>

namespace kintsugi::mapper {
namespace {

constexpr int kDescriptorBytes = 32;
constexpr std::size_t kDescriptorBits = 256;
static_assert(kDescriptorBits / 8 == kDescriptorBytes);
constexpr int kNearBits = 64;

}  // namespace

DescriptorIndex::DescriptorIndex() {
  std::mt19937 random(1);
  for (Table& table : tables_) {
    std::array<int, kDescriptorBits> bits;
    std::iota(bits.begin(), bits.end(), 0);
    for (int i = 0; i < kKeyBits; ++i) {  // Fisher-Yates; std::shuffle differs between libraries
      std::swap(bits[i], bits[i + random() % (bits.size() - i)]);
      table.bits[i] = bits[i];
    }
  }
}

void DescriptorIndex::add(const cv::Mat_<std::uint8_t>& descriptors) {
  const auto by_key = [](const Entry& a, const Entry& b) { return a.key < b.key; };
  for (Table& table : tables_) {
    const auto old_size = static_cast<std::ptrdiff_t>(table.entries.size());
    for (int row = 0; row < descriptors.rows; ++row) {
      table.entries.push_back({key_of(table, descriptors[row]),
                               static_cast<std::uint32_t>(images_.size()),
                               static_cast<std::uint32_t>(row)});
    }
    const auto middle = table.entries.begin() + old_size;
    std::stable_sort(middle, table.entries.end(), by_key);
    std::inplace_merge(table.entries.begin(), middle, table.entries.end(), by_key);
  }
  images_.push_back(descriptors);
}

std::vector<int> DescriptorIndex::count_matches(const cv::Mat_<std::uint8_t>& descriptors) const {
  std::vector<int> matches(images_.size(), 0);
  std::vector<int> last_row(images_.size(), -1);  // a descriptor counts once for each image
  for (int row = 0; row < descriptors.rows; ++row) {
    for (const Table& table : tables_) {
      const std::uint32_t key = key_of(table, descriptors[row]);
      auto entry = std::lower_bound(
          table.entries.begin(), table.entries.end(), key,
          [](const Entry& candidate, std::uint32_t wanted) { return candidate.key < wanted; });
      for (; entry != table.entries.end() && entry->key == key; ++entry) {
        if (last_row[entry->image] == row) continue;
        const std::uint8_t* candidate = images_[entry->image][static_cast<int>(entry->row)];
        if (cv::hal::normHamming(descriptors[row], candidate, kDescriptorBytes) > kNearBits) {
          continue;
        }
        last_row[entry->image] = row;
        ++matches[entry->image];
      }
    }
  }
  return matches;
}

std::uint32_t DescriptorIndex::key_of(const Table& table, const std::uint8_t* descriptor) {
  std::uint32_t key = 0;
  for (const int bit : table.bits) {
    key = key << 1 | (static_cast<std::uint32_t>(descriptor[bit / 8]) >> (bit % 8) & 1U);
  }
  return key;
}

}  // namespace kintsugi::mapper
