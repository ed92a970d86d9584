#include "segmenter/process/slice_receiver.hpp"

#include <algorithm>
#include <bit>
#include <chrono>
#include <exception>
#include <memory>
#include <utility>

#include "lcmtypes/base/logger.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/whole_log_reader.hpp"

namespace kintsugi::segmenter {

SliceReceiver::SliceReceiver(const Config& config, SliceQueue& queue, ViewRecorder* views)
    : queue_(queue),
      views_(views),
      subscriber_(
          channels::kCloudSlice,
          [this](CloudSlice slice) {
            if (views_ != nullptr) views_->add(slice);
            if (!slice.superseded) queue_.push(std::move(slice));
          },
          [this](const DecodeError& reason) { count_bad(reason); },
          [&] {
            StreamSubscriber<CloudSlice>::Config stream;
            stream.receiver = config.session;
            stream.max_pending_bytes = config.max_pending_bytes;
            stream.room = [this] { return room(); };
            stream.wanted_map_name = config.map_name;
            if (!config.map_name.empty()) {
              stream.wanted = [name = config.map_name](const CloudSlice& header) {
                return header.map_name == name;
              };
            }
            return stream;
          }()) {}

SliceReceiver::~SliceReceiver() { stop(); }

void SliceReceiver::subscribe(Bus& bus) { subscriber_.subscribe(bus); }

void SliceReceiver::ask(Bus& bus, double now_s) { subscriber_.ask(bus, now_s); }

void SliceReceiver::read(const std::filesystem::path& log) {
  reads_log_ = true;
  reader_ = std::thread([this, reader = std::make_shared<WholeLogReader>(log)] {
    try {
      while (!stopping_) {
        if (!queue_.wait_for_room(std::chrono::milliseconds(50))) continue;
        const auto event = reader->next();
        if (!event) break;
        if (views_ != nullptr && views_->handle(event->channel, event->data)) continue;
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

// What is read from a log is kept, because nobody sends it again; the reader waits for room.
StreamRoom SliceReceiver::room() const {
  if (stopping_) return StreamRoom::kNone;
  return reads_log_ ? StreamRoom::kPlenty : queue_.room();
}

bool SliceReceiver::is_coming(std::int64_t map_session) const {
  if (subscriber_.has_given_up(map_session) || subscriber_.is_complete(map_session)) {
    return false;
  }
  return std::ranges::any_of(subscriber_.gaps(), [&](const StreamGap& gap) {
    return gap.session == map_session;
  });  // no gap: nobody has announced the session
}

// Warns at the 1st, 2nd, 4th, 8th ... message: a publisher of garbage must not fill the log.
void SliceReceiver::count_bad(const DecodeError& reason) {
  if (std::has_single_bit(static_cast<std::uint64_t>(++num_bad_))) {
    spdlog::warn("dropped {} messages so far, the last: {}", num_bad_, reason.what());
  }
}

}  // namespace kintsugi::segmenter
