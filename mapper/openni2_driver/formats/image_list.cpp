#include "mapper/openni2_driver/formats/image_list.hpp"

#include <stdexcept>
#include <string>

#include "mapper/openni2_driver/formats/text_file.hpp"

namespace kintsugi::mapper {
namespace {

namespace fs = std::filesystem;

/// One list file while it is read; knows what to say when it is wrong.
class ListReader {
 public:
  explicit ListReader(fs::path file) : file_(std::move(file)), lines_(read_text_lines(file_)) {
    if (lines_.empty()) throw std::runtime_error(file_.string() + ": lists no image");
  }

  [[nodiscard]] const std::vector<TextLine>& lines() const { return lines_; }

  void require_words(const TextLine& line, std::size_t num, const char* expected) const {
    if (line.words.size() != num) {
      fail(line, std::to_string(line.words.size()) + " words, expected " + expected);
    }
  }

  [[nodiscard]] TimedImage image(const TextLine& line, std::size_t first_word) const {
    const std::string& time = line.words[first_word];
    const auto utime = parse_seconds(time);
    if (!utime) fail(line, "'" + time + "' is not a time in decimal seconds");
    return {.utime = *utime,
            .has_point = time.find('.') != std::string::npos,
            .file = file_.parent_path() / line.words[first_word + 1]};
  }

  void append(const TextLine& line, std::vector<TimedImage>& images, TimedImage image) const {
    if (!images.empty() && image.utime <= images.back().utime) {
      fail(line, "time " + std::to_string(image.utime) + " us of " + image.file.string() +
                     " is not after " + std::to_string(images.back().utime) +
                     " us before it; times must ascend");
    }
    images.push_back(std::move(image));
  }

  [[noreturn]] void fail(const TextLine& line, const std::string& what) const {
    throw std::runtime_error(place(file_, line.number) + what);
  }

 private:
  fs::path file_;
  std::vector<TextLine> lines_;
};

std::vector<TimedImage> read_single_list(const fs::path& file) {
  const ListReader reader(file);
  std::vector<TimedImage> images;
  for (const TextLine& line : reader.lines()) {
    reader.require_words(line, 2, "2: seconds file");
    reader.append(line, images, reader.image(line, 0));
  }
  return images;
}

bool is_depth(const std::string& listed_file) {
  return fs::path(listed_file).lexically_normal().begin()->string().starts_with("depth");
}

ImageLists read_associations(const fs::path& file) {
  const ListReader reader(file);
  ImageLists lists;
  const auto append_new = [&](const TextLine& line, std::vector<TimedImage>& images,
                              std::size_t first_word) {
    TimedImage image = reader.image(line, first_word);
    const bool repeated =
        !images.empty() && images.back().utime == image.utime && images.back().file == image.file;
    if (!repeated) reader.append(line, images, std::move(image));
  };
  for (const TextLine& line : reader.lines()) {
    reader.require_words(line, 4, "4: seconds file seconds file");
    const bool depth_first = is_depth(line.words[1]);
    if (depth_first == is_depth(line.words[3])) {
      reader.fail(line, "expected exactly one of the two files under depth/");
    }
    append_new(line, lists.depth, depth_first ? 0 : 2);
    append_new(line, lists.color, depth_first ? 2 : 0);
  }
  return lists;
}

}  // namespace

ImageLists read_image_lists(const fs::path& folder) {
  if (!fs::exists(folder)) throw std::runtime_error(folder.string() + ": no such folder");
  if (!fs::is_directory(folder)) throw std::runtime_error(folder.string() + ": not a folder");
  if (fs::exists(folder / "depth.txt")) {
    ImageLists lists{.depth = read_single_list(folder / "depth.txt"), .color = {}};
    if (fs::exists(folder / "rgb.txt")) lists.color = read_single_list(folder / "rgb.txt");
    return lists;
  }
  if (fs::exists(folder / "associations.txt")) {
    return read_associations(folder / "associations.txt");
  }
  throw std::runtime_error(folder.string() +
                           ": neither depth.txt nor associations.txt in it, expected a recording "
                           "in TUM layout");
}

}  // namespace kintsugi::mapper
