#include "segmenter/io/points/length_unit.hpp"

#include "segmenter/io/points/text_words.hpp"

namespace kintsugi::segmenter {

std::string unit_told_by(const std::vector<std::string>& comments) {
  std::string unit;
  for (const std::string& comment : comments) {
    const auto words = split_words(trimmed(comment));
    if (words.size() != 2 || words[0] != "unit") continue;
    if (words[1] == "m" || words[1] == "cm" || words[1] == "mm") unit = words[1];
  }
  return unit;
}

double metres_per(std::string_view unit) {
  if (unit == "mm") return 0.001;
  return unit == "cm" ? 0.01 : 1.0;
}

}  // namespace kintsugi::segmenter
