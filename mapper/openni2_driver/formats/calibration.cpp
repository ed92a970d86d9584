#include "mapper/openni2_driver/formats/calibration.hpp"

#include <array>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "mapper/openni2_driver/formats/text_file.hpp"

namespace kintsugi::mapper {
namespace {

constexpr std::array<const char*, 12> kFieldNames = {
    "fx", "fy", "cx", "cy", "width", "height", "depth_scale", "k1", "k2", "p1", "p2", "k3"};
constexpr std::size_t kNumRequired = 7;
constexpr const char* kExpected = "fx fy cx cy width height depth_scale [k1 k2 p1 p2 k3]";
constexpr double kMaxImageSize = 16384;

/// One line of numbers, checked field by field.
class CalibrationLine {
 public:
  CalibrationLine(const std::filesystem::path& file, const TextLine& line)
      : file_(file), line_(line) {
    const auto num = line.words.size();
    if (num != kNumRequired && num != kFieldNames.size()) {
      std::ostringstream message;
      message << num << (num == 1 ? " field" : " fields") << ", expected " << kExpected;
      if (num < kFieldNames.size()) message << "; missing: " << kFieldNames.at(num);
      fail(message.str());
    }
  }

  [[nodiscard]] double number(std::size_t field) const {
    const auto value = parse_number(line_.words.at(field));
    if (!value) bad(field, "a finite number");
    return *value;
  }

  [[nodiscard]] double positive(std::size_t field) const {
    const double value = number(field);
    if (value <= 0.0) bad(field, "a number greater than 0");
    return value;
  }

  [[nodiscard]] double not_zero(std::size_t field) const {
    const double value = number(field);
    if (value == 0.0) bad(field, "a number other than 0");
    return value;
  }

  [[nodiscard]] int image_size(std::size_t field) const {
    const double value = positive(field);
    if (value > kMaxImageSize || value != std::floor(value)) {
      bad(field, "a whole number of pixels from 1 to 16384");
    }
    return static_cast<int>(value);
  }

 private:
  [[noreturn]] void bad(std::size_t field, const char* expected) const {
    fail(std::string(kFieldNames.at(field)) + " is '" + line_.words.at(field) + "', expected " +
         expected);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw std::runtime_error(place(file_, line_.number) + what);
  }

  const std::filesystem::path& file_;
  const TextLine& line_;
};

}  // namespace

Calibration read_calibration(const std::filesystem::path& file) {
  const std::vector<TextLine> lines = read_text_lines(file);
  if (lines.empty()) {
    throw std::runtime_error(file.string() + ": no calibration in it, expected one line " +
                             kExpected);
  }
  if (lines.size() > 1) {
    throw std::runtime_error(place(file, lines[1].number) +
                             "a second line of values, expected only one: " + kExpected);
  }
  const CalibrationLine line(file, lines.front());
  Calibration calibration;
  Intrinsics& intrinsics = calibration.intrinsics;
  intrinsics.fx = line.positive(0);
  intrinsics.fy = line.not_zero(1);
  intrinsics.cx = line.positive(2);
  intrinsics.cy = line.positive(3);
  intrinsics.width = line.image_size(4);
  intrinsics.height = line.image_size(5);
  calibration.depth_units_per_m = line.positive(6);
  if (lines.front().words.size() == kFieldNames.size()) {
    for (std::size_t k = 0; k < intrinsics.distortion.size(); ++k) {
      intrinsics.distortion.at(k) = line.number(kNumRequired + k);
    }
  }
  return calibration;
}

}  // namespace kintsugi::mapper
