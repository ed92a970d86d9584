#include "lcmtypes/scene/page.hpp"

#include <cstdint>
#include <stdexcept>

namespace kintsugi::scene {
namespace {

/// Replaces the only occurrence of `mark`.
void replace(std::string& text, std::string_view mark, std::string_view by) {
  const std::size_t place = text.find(mark);
  if (place == std::string::npos) {
    throw std::logic_error("the page has no " + std::string(mark));
  }
  text.replace(place, mark.size(), by);
}

}  // namespace

std::string file_begin() {
  constexpr std::string_view kPolicy =
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; "
      "script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data:\">";
  std::string html(kPageHtml);
  replace(html, "<meta charset=\"utf-8\">", "<meta charset=\"utf-8\">\n" + std::string(kPolicy));
  replace(html, "<link rel=\"stylesheet\" href=\"page.css\">",
          "<style>\n" + std::string(kPageCss) + "</style>");
  // At the end of the body and after the data, which the script reads when the page is loaded.
  replace(html, "<script type=\"module\" src=\"page.js\"></script>",
          "<script type=\"module\">\n" + std::string(kPageJs) + "</script>");
  html.resize(html.rfind("</body>"));
  return html;
}

std::string data_element(std::string_view id, std::string_view text) {
  std::string element = "<script type=\"text/plain\" id=\"";
  element += id;
  element += "\">";
  for (const char c : text) {
    // So that no text can end the element. JSON reads this as the same character.
    if (c == '<') {
      element += "\\u003c";
    } else {
      element += c;
    }
  }
  element += "</script>\n";
  return element;
}

std::string base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8U | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool is_padding = i + k > bytes.size();
      text += is_padding ? '=' : kDigits[group >> (18U - 6U * k) & 63U];
    }
  }
  return text;
}

}  // namespace kintsugi::scene
