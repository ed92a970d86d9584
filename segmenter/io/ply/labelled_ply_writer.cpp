#include "segmenter/io/ply/labelled_ply_writer.hpp"

#include <bit>
#include <cstring>
#include <stdexcept>

namespace kintsugi::segmenter {
namespace {

static_assert(std::endian::native == std::endian::little, "values are written as they are");

constexpr std::size_t kBufferBytes = std::size_t{1} << 20;

template <typename T>
void put(std::vector<char>& buffer, const T& value) {
  const auto offset = buffer.size();
  buffer.resize(offset + sizeof(T));
  std::memcpy(buffer.data() + offset, &value, sizeof(T));
}

}  // namespace

LabelledPlyWriter::LabelledPlyWriter(const std::filesystem::path& path, std::int64_t num_points,
                                     const std::vector<std::string>& comments)
    : file_(path), num_points_left_(num_points) {
  std::ostream& out = file_.stream();
  out << "ply\nformat binary_little_endian 1.0\n";
  for (const std::string& comment : comments) {
    out << "comment " << comment << '\n';
  }
  out << "element vertex " << num_points << '\n';
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"}) {
    out << "property float " << name << '\n';
  }
  for (const char* name : {"red", "green", "blue"}) {
    out << "property uchar " << name << '\n';
  }
  out << "property uint segment_id\nproperty int slice_id\nproperty float weight\nend_header\n";
  buffer_.reserve(kBufferBytes);
}

void LabelledPlyWriter::append(const CloudPoint& point_W, std::uint32_t segment_id,
                               std::int32_t slice_id) {
  --num_points_left_;
  for (const float value : {point_W.x, point_W.y, point_W.z, point_W.nx, point_W.ny, point_W.nz}) {
    put(buffer_, value);
  }
  for (const std::uint8_t value : {point_W.red, point_W.green, point_W.blue}) {
    put(buffer_, value);
  }
  put(buffer_, segment_id);
  put(buffer_, slice_id);
  put(buffer_, point_W.weight);
  constexpr std::size_t kRowBytes = 39;
  if (buffer_.size() + kRowBytes > kBufferBytes) {
    flush();
  }
}

void LabelledPlyWriter::commit() {
  if (num_points_left_ != 0) {
    throw std::logic_error("LabelledPlyWriter: " + std::to_string(num_points_left_) +
                           " points fewer than the header says");
  }
  flush();
  file_.commit();
}

void LabelledPlyWriter::flush() {
  file_.stream().write(buffer_.data(), static_cast<std::streamsize>(buffer_.size()));
  buffer_.clear();
}

}  // namespace kintsugi::segmenter
