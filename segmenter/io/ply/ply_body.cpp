#include "segmenter/io/ply/ply_body.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <stdexcept>

#include "segmenter/io/points/text_words.hpp"

namespace kintsugi::segmenter {
namespace {

class BinaryBody final : public PlyBody {
 public:
  BinaryBody(std::string_view bytes, const PlyHeader& header, const std::string& path)
      : PlyBody(bytes, header.num_bytes, path),
        swap_((header.format == PlyFormat::kBinaryLittleEndian) !=
              (std::endian::native == std::endian::little)) {}

  void read_row(const PlyElement& element, std::int64_t row, std::vector<double>& values) override {
    values.clear();
    for (const PlyProperty& property : element.properties) {
      values.push_back(property.list_count ? pass_list(element, row, property)
                                           : take(element, row, property, property.type));
    }
  }

 private:
  double take(const PlyElement& element, std::int64_t row, const PlyProperty& property,
              ScalarType type) {
    if (size_of(type) > num_bytes_left()) {
      fail(element, row, "the file ends inside property '" + property.name + "'");
    }
    const double value = read_scalar(bytes_.data() + position_, type, swap_);
    position_ += size_of(type);
    keep(value, type);
    return value;
  }

  double pass_list(const PlyElement& element, std::int64_t row, const PlyProperty& property) {
    const double length = take(element, row, property, *property.list_count);
    const std::size_t room = num_bytes_left() / size_of(property.type);
    if (length < 0.0 || length > static_cast<double>(room)) {
      fail(element, row,
           "list '" + property.name + "' claims " +
               std::to_string(static_cast<std::int64_t>(length)) + " entries, expected 0 to the " +
               std::to_string(room) + " that the rest of the file can hold");
    }
    for (auto left = static_cast<std::size_t>(length); left > 0; --left) {
      take(element, row, property, property.type);
    }
    return length;
  }

  std::size_t min_row_bytes(const PlyElement& element) const override {
    std::size_t num_bytes = 0;
    for (const PlyProperty& property : element.properties) {
      num_bytes += size_of(property.list_count.value_or(property.type));
    }
    return num_bytes;
  }

  std::string place() const override { return "byte " + std::to_string(position_); }

  bool swap_;
};

class AsciiBody final : public PlyBody {
 public:
  AsciiBody(std::string_view bytes, const PlyHeader& header, const std::string& path)
      : PlyBody(bytes, header.num_bytes, path), line_number_(header.num_lines) {}

  void read_row(const PlyElement& element, std::int64_t row, std::vector<double>& values) override {
    next_line(element, row);
    values.clear();
    for (const PlyProperty& property : element.properties) {
      if (!property.list_count) {
        values.push_back(next_value(element, row, property, property.type));
        continue;
      }
      const double length = next_value(element, row, property, *property.list_count);
      if (!(length >= 0.0)) {
        fail(element, row, "the length of list '" + property.name + "' is negative");
      }
      for (double i = 0.0; i < length; ++i) {
        next_value(element, row, property, property.type);
      }
      values.push_back(length);
    }
    if (line_.find_first_not_of(kBlanks) != std::string_view::npos) {
      fail(element, row, "more values than the header declares");
    }
  }

 private:
  static constexpr std::string_view kBlanks = " \t\r";

  // Moves line_ to the next line that is not blank.
  void next_line(const PlyElement& element, std::int64_t row) {
    do {
      if (num_bytes_left() == 0) {
        fail(element, row, "the file ends here");
      }
      const auto end = std::min(bytes_.find('\n', position_), bytes_.size());
      line_ = bytes_.substr(position_, end - position_);
      position_ = std::min(end + 1, bytes_.size());
      ++line_number_;
    } while (line_.find_first_not_of(kBlanks) == std::string_view::npos);
  }

  double next_value(const PlyElement& element, std::int64_t row, const PlyProperty& property,
                    ScalarType type) {
    line_.remove_prefix(std::min(line_.find_first_not_of(kBlanks), line_.size()));
    const std::string_view word =
        line_.substr(0, std::min(line_.find_first_of(kBlanks), line_.size()));
    line_.remove_prefix(word.size());
    if (word.empty()) {
      fail(element, row, "the line ends before property '" + property.name + "'");
    }
    const std::optional<double> value = parse_number(word);
    if (!value) fail(element, row, "property '" + property.name + "' is not a number");
    if (!holds(type, *value)) {
      fail(element, row,
           "property '" + property.name + "' has " + in_quotes(word) +
               ", expected a whole number of type " + std::string(name_of(type)));
    }
    keep(*value, type);
    return *value;
  }

  // A digit and a blank for each value; the last line may lack its end.
  std::size_t min_row_bytes(const PlyElement& element) const override {
    return 2 * element.properties.size();
  }

  std::string place() const override { return "line " + std::to_string(line_number_); }

  std::string_view line_;
  int line_number_;
};

}  // namespace

void PlyBody::check_count(const PlyElement& element) const {
  const std::size_t row_bytes = min_row_bytes(element);
  const auto count = static_cast<std::size_t>(element.count);
  if (row_bytes == 0 || count <= (num_bytes_left() + 1) / row_bytes) {
    return;
  }
  throw std::runtime_error(path_ + ": line " + std::to_string(element.line) + ": claims " +
                           std::to_string(element.count) + " rows of element '" + element.name +
                           "' of at least " + std::to_string(row_bytes) +
                           " bytes each, but the file holds " + std::to_string(num_bytes_left()) +
                           " bytes from " + place());
}

void PlyBody::keep(double value, ScalarType type) {
  if (records_ == nullptr) return;
  records_->resize(records_->size() + size_of(type));
  write_scalar(value, type, records_->data() + records_->size() - size_of(type));
}

void PlyBody::pass(const PlyElement& element, std::string* records) {
  check_count(element);
  if (element.properties.empty()) {
    return;
  }
  records_ = records;
  std::vector<double> values;
  for (std::int64_t row = 0; row < element.count; ++row) {
    read_row(element, row, values);
  }
  records_ = nullptr;
}

void PlyBody::expect_end() const {
  const auto extra = bytes_.find_first_not_of(" \t\r\n", position_);
  if (extra != std::string_view::npos) {
    throw std::runtime_error(path_ + ": " + std::to_string(bytes_.size() - extra) +
                             " bytes more than the header declares, from byte " +
                             std::to_string(extra));
  }
}

void PlyBody::fail(const PlyElement& element, std::int64_t row, const std::string& what) const {
  throw std::runtime_error(path_ + ": " + place() + ", row " + std::to_string(row) +
                           " of element '" + element.name + "': " + what);
}

std::unique_ptr<PlyBody> make_ply_body(std::string_view bytes, const PlyHeader& header,
                                       const std::string& path) {
  if (header.format == PlyFormat::kAscii) {
    return std::make_unique<AsciiBody>(bytes, header, path);
  }
  return std::make_unique<BinaryBody>(bytes, header, path);
}

}  // namespace kintsugi::segmenter
