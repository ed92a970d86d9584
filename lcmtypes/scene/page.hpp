#pragma once
// The page that shows a map in a browser. Its files are in page/; the build puts them into the
// program, so that nothing is read at run time.

#include <string>
#include <string_view>

namespace kintsugi::scene {

extern const std::string_view kPageHtml;  ///< loads page.css and page.js
extern const std::string_view kPageCss;
extern const std::string_view kPageJs;

/// The page as one file, with style and script in it, before its data; end with kFileEnd.
/// Browsers let it load nothing from anywhere.
std::string file_begin();
inline constexpr std::string_view kFileEnd = "</body>\n</html>\n";

/// A block of data of that file: a script element that is not run.
std::string data_element(std::string_view id, std::string_view text);

/// RFC 4648, without line breaks.
std::string base64(std::string_view bytes);

}  // namespace kintsugi::scene
