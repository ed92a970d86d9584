# cmake -DPAGE=FOLDER -DOUT=FILE -P EmbedPage.cmake: writes the page's files into a C++ file.
#
# The modules are joined in the order in which they need each other, so that the page is the same
# script in a program and in one file: their imports are left out, and what they export is visible
# to those behind them.
set(modules math palette arena shaders renderer orbit tiles live embedded panel objects main)
set(js "'use strict';\n")
foreach(module IN LISTS modules)
  file(READ ${PAGE}/${module}.js text)
  string(REGEX REPLACE "(^|\n)import [^\n]*" "\\1" text "${text}")
  string(REGEX REPLACE "(^|\n)export " "\\1" text "${text}")
  string(APPEND js "\n// ${module}.js\n${text}")
endforeach()
file(READ ${PAGE}/index.html html)
file(READ ${PAGE}/page.css css)
set(cpp "// Made by EmbedPage.cmake.\n#include \"lcmtypes/scene/page.hpp\"\n\nnamespace kintsugi::scene {\n")
string(APPEND cpp "const std::string_view kPageHtml = R\"page(${html})page\";\n")
string(APPEND cpp "const std::string_view kPageCss = R\"page(${css})page\";\n")
string(APPEND cpp "const std::string_view kPageJs = R\"page(${js})page\";\n")
string(APPEND cpp "}  // namespace kintsugi::scene\n")
file(WRITE ${OUT} "${cpp}")
