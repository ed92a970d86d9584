#include "segmenter/io/points/point_table.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace kintsugi::segmenter {

void PointTable::add_field(std::string name, ScalarType type, bool is_list) {
  if (num_points_ > 0) throw std::logic_error("PointTable: a column is added behind the records");
  fields_.push_back({std::move(name), type, record_bytes_, is_list});
  record_bytes_ += size_of(type);
}

std::optional<std::size_t> PointTable::find(std::string_view name) const {
  const auto found = std::ranges::find(fields_, name, &PointField::name);
  if (found == fields_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - fields_.begin());
}

char* PointTable::append() {
  records_.resize(records_.size() + record_bytes_);
  return records_.data() + record_bytes_ * num_points_++;
}

}  // namespace kintsugi::segmenter
