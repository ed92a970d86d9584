#include "viewer/web/web_view.hpp"

#include <variant>

#include "lcmtypes/base/logger.hpp"

namespace kintsugi::viewer {

WebView::WebView(const Config& config)
    : feed_(scene_, config.splat), server_(config.address, config.token, scene_) {
  spdlog::info("the map in a browser: http://{}/{}", server_.address().text(),
               config.token.empty() ? "" : "?token=TOKEN");
}

void WebView::use(const Message& message) {
  if (const auto* update = std::get_if<SegmentUpdate>(&message)) feed_.use(*update);
}

}  // namespace kintsugi::viewer
