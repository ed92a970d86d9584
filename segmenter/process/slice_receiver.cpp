#include "segmenter/process/slice_receiver.hpp"

#include <bit>
#include <exception>
#include <memory>
#include <utility>

#include <spdlog/spdlog.h>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/log_reader.hpp"

namespace kintsugi::segmenter {

SliceReceiver::SliceReceiver(SliceQueue& queue)
    : queue_(queue),
      subscriber_(
          channels::kCloudSlice, [this](CloudSlice slice) { queue_.push(std::move(slice)); },
          [this](const DecodeError& reason) { bad(reason); }) {}

SliceReceiver::~SliceReceiver() { stop(); }

void SliceReceiver::subscribe(Bus& bus) { subscriber_.subscribe(bus); }

void SliceReceiver::read(const std::filesystem::path& log) {
  reader_ = std::thread([this, reader = std::make_shared<LogReader>(log)] {
    try {
      while (!stopping_) {
        const auto event = reader->next();
        if (!event) break;
        subscriber_.handle(event->channel, event->data);
      }
      problem_ = reader->damage();
    } catch (const std::exception& error) {
      problem_ = error.what();
    }
    queue_.close();
  });
}

void SliceReceiver::stop() {
  stopping_ = true;
  if (reader_.joinable()) reader_.join();
}

// The 1st, 2nd, 4th, 8th ...: a publisher of garbage does not fill the log.
void SliceReceiver::bad(const DecodeError& reason) {
  if (std::has_single_bit(static_cast<std::uint64_t>(++num_bad_))) {
    spdlog::warn("dropped {} messages so far, the last: {}", num_bad_, reason.what());
  }
}

}  // namespace kintsugi::segmenter
