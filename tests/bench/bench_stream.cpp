// What a reliable stream costs on a real bus of this machine: a process that publishes slices, and
// one that receives them, in a network namespace of their own.

#include <chrono>
#include <cstdio>
#include <exception>
#include <memory>
#include <new>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>

#include <CLI/CLI.hpp>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "lcmtypes/base/patient_clock.hpp"
#include "lcmtypes/bus/bus_thread.hpp"
#include "lcmtypes/channels.hpp"
#include "lcmtypes/stream/stream_publisher.hpp"
#include "lcmtypes/stream/stream_subscriber.hpp"
#include "tests/support/private_bus.hpp"

namespace kintsugi {
namespace {

constexpr std::int64_t kSession = 1;
constexpr int kNumPoints = 20'000;
constexpr double kSliceBytes = double{sizeof(CloudPoint)} * kNumPoints;

struct Options {
  double rate_bytes_per_s = StreamPublisher::Config{}.rate_bytes_per_s;
  double seconds = 5.0;
  int receive_buffer_bytes = 212'992;

  std::string url() const {
    return std::string(testing::kPrivateBusUrl) +
           "&recv_buf_size=" + std::to_string(receive_buffer_bytes);
  }
  int num_slices() const { return static_cast<int>(seconds * rate_bytes_per_s / kSliceBytes); }
};

struct Case {
  std::size_t chunk_bytes = 0;
  double loss = 0.0;  ///< share of the chunks that the receiver drops unread
  bool is_signed = false;

  MessageTrust trust() const {
    if (!is_signed) return {};
    return {.key = std::make_shared<const BusKey>(BusKey::Secret{1})};
  }
};

/// Results of the receiver, in memory shared with the process that started it.
struct Received {
  double bytes_per_s = 0.0;
  double cpu = 0.0;  ///< share of one core
  std::int64_t chunks_lost = 0;
  std::int64_t chunks_duplicate = 0;
  std::int64_t requests = 0;
};

double cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

CloudSlice slice_of(int id) {
  CloudSlice slice;
  slice.session = kSession;
  slice.map_name = "map";
  slice.id = id;
  slice.resolution_m = 0.01F;
  CloudPoint point;
  point.ny = 1.0F;
  slice.points_W.assign(kNumPoints, point);
  return slice;
}

/// Receives until every slice is complete.
void receive(const Options& options, const Case& which, Received& received) {
  Bus bus(options.url(), which.trust());
  PatientClock clock;
  int num_complete = 0;
  StreamSubscriber<CloudSlice> stream(channels::kCloudSlice,
                                      [&](const CloudSlice&) { ++num_complete; });
  std::mt19937 random(1);
  std::bernoulli_distribution is_lost(which.loss);
  std::int64_t num_taken = 0;
  bus.subscribe(channels::kHeartbeat,
                [&](ByteView message) { stream.handle(channels::kHeartbeat, message); });
  bus.subscribe(channels::kCloudSlice, [&](ByteView message) {
    if (is_lost(random)) {
      ++received.chunks_lost;
    } else {
      stream.handle(channels::kCloudSlice, message);
      ++num_taken;
    }
  });
  while (num_taken == 0) bus.handle(std::chrono::milliseconds(20));
  const double begin_s = PatientClock::steady_clock_s();
  const double begin_cpu_s = cpu_s();
  while (num_complete < options.num_slices()) {
    bus.handle(std::chrono::milliseconds(20));
    stream.ask(bus, clock.now_s());
  }
  const double duration_s = PatientClock::steady_clock_s() - begin_s;
  received.cpu = (cpu_s() - begin_cpu_s) / duration_s;
  received.bytes_per_s = options.num_slices() * kSliceBytes / duration_s;
  received.chunks_duplicate = stream.counts().chunks_duplicate;
  received.requests = stream.counts().requests_sent;
}

/// Publishes all slices, answers requests until `receiver` has ended, and prints a row.
void publish(const Options& options, const Case& which, pid_t receiver, const Received& received) {
  Bus bus(options.url(), which.trust());
  RecentChunks store(std::size_t{4} << 30U);
  StreamPublisher::Config config;
  config.rate_bytes_per_s = options.rate_bytes_per_s;
  config.max_chunk_bytes = which.chunk_bytes;
  StreamPublisher stream(bus, channels::kCloudSlice, kSession, config, &store);
  stream.subscribe(bus);
  BusThread answering(bus);
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // until the receiver listens
  const double begin_s = PatientClock::steady_clock_s();
  const double begin_cpu_s = cpu_s();
  for (int id = 0; id < options.num_slices(); ++id) {
    while (stream.queued_bytes() > (1U << 20U)) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    stream.publish(slice_of(id));
  }
  stream.flush();
  const double cpu = (cpu_s() - begin_cpu_s) / (PatientClock::steady_clock_s() - begin_s);
  waitpid(receiver, nullptr, 0);
  answering.stop();
  const StreamPublisherCounts counts = stream.counts();
  std::printf(
      "| %zu | %s | %.0f | %.2f | %.1f | %.1f | %lld | %lld | %lld | %lld | %lld |\n",
      which.chunk_bytes, which.is_signed ? "yes" : "no", 100.0 * which.loss,
      1e-6 * received.bytes_per_s, 100.0 * cpu, 100.0 * received.cpu,
      static_cast<long long>(counts.chunks_sent), static_cast<long long>(received.chunks_lost),
      static_cast<long long>(counts.chunks_resent),
      static_cast<long long>(received.chunks_duplicate), static_cast<long long>(received.requests));
}

void measure(const Options& options, const Case& which) {
  void* shared =
      mmap(nullptr, sizeof(Received), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  if (shared == MAP_FAILED) throw std::runtime_error("no memory to share with the receiver");
  auto* received = new (shared) Received;
  std::fflush(stdout);
  const pid_t receiver = fork();
  if (receiver == 0) {
    receive(options, which, *received);
    _exit(0);
  }
  publish(options, which, receiver, *received);
  munmap(shared, sizeof(Received));
}

int run(int argc, char** argv) {
  Options options;
  CLI::App app("Cost of a reliable stream: a sender and a receiver on a private bus");
  app.add_option("--rate", options.rate_bytes_per_s, "rate of the stream, bytes/s")
      ->capture_default_str();
  app.add_option("--seconds", options.seconds, "duration of publishing")->capture_default_str();
  app.add_option("--receive-buffer", options.receive_buffer_bytes, "bytes")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  if (const auto why_not = testing::enter_private_bus()) throw std::runtime_error(*why_not);
  std::printf(
      "| largest chunk, bytes | signed | dropped, %% | MB/s of points | sender, %% of a core | "
      "receiver, %% | chunks sent | dropped | resent | received twice | requests |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (const std::size_t chunk_bytes : {kDefaultMaxChunkBytes, kMinMaxChunkBytes}) {
    measure(options, {chunk_bytes, 0.0, true});
    for (const double loss : {0.0, 0.01, 0.05, 0.1}) measure(options, {chunk_bytes, loss});
  }
  return 0;
}

}  // namespace
}  // namespace kintsugi

int main(int argc, char** argv) {
  try {
    return kintsugi::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_stream: %s\n", error.what());
    return 1;
  }
}
