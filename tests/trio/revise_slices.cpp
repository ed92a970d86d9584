// trio_revise_slices IN.lcm OUT.lcm: rewrites a recorded run as if its mapper had corrected the
// map.
//
// Before the last slice but one, a third of the slices is published again as revision 1, moved by a
// few centimetres; before the last slice, again as revision 2, unmoved. The final map is therefore
// the recorded one. Messages of the segmenter and the viewer are left out.

#include <cstdint>
#include <cstdio>
#include <exception>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <lcm/lcm-cpp.hpp>

#include "lcmtypes/channels.hpp"
#include "lcmtypes/log/log_reader.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"

namespace kintsugi {
namespace {

constexpr std::int64_t kChunk_us = 6'000;      // a mapper sends 60 kB at 10 MB/s
constexpr std::int64_t kPause_us = 1'500'000;  // longer than a segmenter waits for more corrections

struct Event {
  std::int64_t utime = 0;
  std::string channel;  // empty for a slice
  Bytes data;
  CloudSlice slice;
};

struct Recording {
  std::vector<Event> events;
  std::vector<std::size_t> slices;  // indices into events
};

Recording read(const std::string& path) {
  Recording recording;
  std::int64_t utime = 0;
  StreamSubscriber<CloudSlice> subscriber(channels::kCloudSlice, [&](CloudSlice slice) {
    recording.slices.push_back(recording.events.size());
    recording.events.push_back({utime, "", {}, std::move(slice)});
  });
  LogReader log(path);
  while (const auto event = log.next()) {
    utime = event->utime;
    subscriber.handle(event->channel, event->data);
    if (event->channel == channels::kCameraPose || event->channel == channels::kMapperStatus) {
      recording.events.push_back(
          {utime, event->channel, Bytes(event->data.begin(), event->data.end()), {}});
    }
  }
  if (recording.slices.size() < 3) {
    throw std::runtime_error(path + ": " + std::to_string(recording.slices.size()) +
                             " slices, expected 3 at least");
  }
  return recording;
}

CloudSlice moved(CloudSlice slice) {
  const Eigen::AngleAxisf rotation(0.0035F, Eigen::Vector3f(1, 2, 3).normalized());
  const Eigen::Vector3f translation_m(0.03F, -0.02F, 0.025F);
  for (CloudPoint& point : slice.points_W) {
    const Eigen::Vector3f p = rotation * Eigen::Vector3f(point.x, point.y, point.z) + translation_m;
    const Eigen::Vector3f n =
        (rotation * Eigen::Vector3f(point.nx, point.ny, point.nz)).normalized();
    point.x = p.x();
    point.y = p.y();
    point.z = p.z();
    point.nx = n.x();
    point.ny = n.y();
    point.nz = n.z();
  }
  return slice;
}

class Writer {
 public:
  Writer(const std::string& path, std::int64_t session)
      : log_(path, "w"),
        publisher_(
            [this](const std::string& channel, ByteView data) { write_chunk(channel, data); },
            channels::kCloudSlice, session, unpaced()) {
    if (!log_.good()) throw std::runtime_error("cannot write " + path);
  }

  void write(const Event& event) {
    utime_ = event.utime + delay_us_;
    if (event.channel.empty()) {
      write(event.slice);
    } else {
      write(event.channel, event.data, utime_);
    }
  }

  /// Later events are delayed by the duration of the corrections.
  void write_corrections(std::span<const Event* const> slices, std::int32_t revision) {
    const std::int64_t begin_us = utime_;
    for (const Event* event : slices) {
      CloudSlice slice = revision % 2 == 1 ? moved(event->slice) : event->slice;
      slice.revision = revision;
      write(slice);
    }
    utime_ += kPause_us;
    delay_us_ += utime_ - begin_us;
  }

 private:
  static StreamPublisher::Config unpaced() {
    StreamPublisher::Config config;
    config.rate_bytes_per_s = 1e12;
    return config;
  }

  // Heartbeats are left out, because they depend on wall time.
  void write_chunk(const std::string& channel, ByteView data) {
    if (channel == channels::kCloudSlice) write(channel, data, utime_ += kChunk_us);
  }

  void write(const CloudSlice& slice) {
    publisher_.publish(slice);
    publisher_.flush();
  }

  void write(const std::string& channel, ByteView data, std::int64_t utime) {
    lcm::LogEvent event{};
    event.eventnum = num_events_++;
    event.timestamp = utime;
    event.channel = channel;
    event.datalen = static_cast<std::int32_t>(data.size());
    event.data = const_cast<std::uint8_t*>(data.data());  // NOLINT: LCM does not write to it
    if (log_.writeEvent(&event) != 0) throw std::runtime_error("cannot write the log");
  }

  lcm::LogFile log_;
  std::int64_t utime_ = 0;
  std::int64_t delay_us_ = 0;
  std::int64_t num_events_ = 0;
  StreamPublisher publisher_;  // last: its thread writes
};

void revise(const std::string& in, const std::string& out) {
  const Recording recording = read(in);
  const auto slice = [&](std::size_t i) { return &recording.events[recording.slices[i]]; };
  const std::size_t num_slices = recording.slices.size();
  std::vector<const Event*> third;
  const std::size_t first = (num_slices - 2 - num_slices / 3) / 2;
  for (std::size_t i = 0; i < num_slices / 3; ++i) third.push_back(slice(first + i));

  Writer writer(out, slice(0)->slice.session);
  for (const Event& event : recording.events) {
    if (&event == slice(num_slices - 2)) writer.write_corrections(third, 1);
    if (&event == slice(num_slices - 1)) writer.write_corrections(third, 2);
    writer.write(event);
  }
  std::printf("%zu slices, %zu of them corrected twice\n", num_slices, third.size());
}

}  // namespace
}  // namespace kintsugi

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: %s IN.lcm OUT.lcm\n", argv[0]);
    return 2;
  }
  try {
    kintsugi::revise(argv[1], argv[2]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
