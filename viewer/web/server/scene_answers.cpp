#include "viewer/web/server/scene_answers.hpp"

#include <charconv>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "lcmtypes/scene/page.hpp"

namespace kintsugi::viewer {
namespace {

constexpr std::size_t kMaxWants = 64;
constexpr std::uint64_t kMaxPoints = 4'000'000;  // of one answer: 50 MB

/// A parameter is wrong; what() is for whoever asked.
class BadRequest : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The whole text as a number, in digits only.
template <class Number>
Number number_of(std::string_view text, const std::string& name) {
  Number value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || rest != text.data() + text.size()) {
    throw BadRequest("The parameter " + name + " must be a whole number up to " +
                     std::to_string(std::numeric_limits<Number>::max()) + ".");
  }
  return value;
}

const std::string& text_of(const Parameters& parameters, const std::string& name) {
  const auto [first, last] = parameters.equal_range(name);
  if (first == last || std::next(first) != last) {
    throw BadRequest("The parameter " + name + " must be given once.");
  }
  return first->second;
}

template <class Number>
Number number_in(const Parameters& parameters, const std::string& name) {
  return number_of<Number>(text_of(parameters, name), name);
}

/// Calls function(item) for each item between separators.
template <class Function>
void for_each_item(std::string_view text, char separator, Function&& function) {
  for (;;) {
    const std::size_t end = text.find(separator);
    function(text.substr(0, end));
    if (end == std::string_view::npos) return;
    text.remove_prefix(end + 1);
  }
}

/// "TILE.FIRST.COUNT,..." for points, "TILE.COUNT,..." for labels.
std::vector<LiveScene::Want> wants_of(const Parameters& parameters, bool with_points) {
  std::vector<LiveScene::Want> wants;
  std::uint64_t points = 0;
  for_each_item(text_of(parameters, "want"), ',', [&](std::string_view item) {
    std::vector<std::uint32_t> numbers;
    for_each_item(item, '.', [&](std::string_view text) {
      numbers.push_back(number_of<std::uint32_t>(text, "want"));
      if (numbers.size() > 3) throw BadRequest("The parameter want has too many numbers.");
    });
    if (numbers.size() != (with_points ? 3U : 2U)) {
      throw BadRequest(with_points ? "The parameter want must be TILE.FIRST.COUNT,..."
                                   : "The parameter want must be TILE.COUNT,...");
    }
    wants.push_back(with_points ? LiveScene::Want{numbers[0], numbers[1], numbers[2]}
                                : LiveScene::Want{numbers[0], 0, numbers[1]});
    points += wants.back().count;
    if (wants.size() > kMaxWants || points > kMaxPoints) {
      throw BadRequest("One request may ask for at most 64 tiles and 4000000 points.");
    }
  });
  return wants;
}

Answer json(std::string text) { return {200, "application/json", std::move(text)}; }
Answer bytes(std::string data) { return {200, "application/octet-stream", std::move(data)}; }

Answer page(std::string_view text, std::string type) {
  return {200, std::move(type), std::string(text)};
}

template <class Value>
std::string raw(const std::vector<Value>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)};
}

Answer answer_or_throw(LiveScene& scene, const std::string& path, const Parameters& parameters) {
  if (path == "/") return page(scene::kPageHtml, "text/html; charset=utf-8");
  if (path == "/page.css") return page(scene::kPageCss, "text/css; charset=utf-8");
  if (path == "/page.js") return page(scene::kPageJs, "text/javascript; charset=utf-8");
  if (path == "/state" || path == "/segments") {
    const auto epoch = number_in<std::int64_t>(parameters, "epoch");
    const auto since = number_in<std::uint64_t>(parameters, "since");
    return json(path == "/state" ? scene.state(epoch, since) : scene.segments(epoch, since));
  }
  if (path == "/points" || path == "/labels") {
    const bool with_points = path == "/points";
    return bytes(scene.blocks(wants_of(parameters, with_points), with_points));
  }
  if (path == "/segment") {
    const auto id = number_in<std::uint32_t>(parameters, "id");
    auto text = scene.segment(id);
    if (!text) return {404, "text/plain; charset=utf-8", "There is no such segment.\n"};
    return json(*std::move(text));
  }
  if (path == "/path") return bytes(raw(scene.path(number_in<std::int32_t>(parameters, "part"))));
  if (path == "/camera.jpg") {
    const std::vector<std::uint8_t> image = scene.image();
    if (image.empty()) return {404, "text/plain; charset=utf-8", "No image has come yet.\n"};
    return {200, "image/jpeg", raw(image)};
  }
  return {404, "text/plain; charset=utf-8", "There is no such page.\n"};
}

}  // namespace

Answer answer(LiveScene& scene, const std::string& path, const Parameters& parameters) {
  try {
    return answer_or_throw(scene, path, parameters);
  } catch (const BadRequest& error) {
    return {400, "text/plain; charset=utf-8", std::string(error.what()) + '\n'};
  }
}

}  // namespace kintsugi::viewer
