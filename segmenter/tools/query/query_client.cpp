#include "segmenter/tools/query/query_client.hpp"

#include <algorithm>
#include <random>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "lcmtypes/base/deadline.hpp"
#include "lcmtypes/bus/message_subscriber.hpp"
#include "lcmtypes/channels.hpp"

namespace kintsugi::segmenter {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kFirstWait{500};  // before asking again; doubled each time up to
constexpr milliseconds kLongestWait{4'000};
constexpr milliseconds kMeanwhile{100};
constexpr milliseconds kOthersWait{500};  // for another segmenter when one has no answer

std::int64_t random_client() {
  std::random_device device;
  return std::uniform_int_distribution<std::int64_t>(1)(device);
}

}  // namespace

QueryClient::QueryClient(const std::string& lcm_url, std::shared_ptr<const BusKey> key)
    : bus_(lcm_url, MessageTrust{.key = std::move(key)}),
      client_(random_client()),
      answers_(channels::kSegmentAnswer,
               [this](SegmentAnswer answer) { take(std::move(answer)); }) {
  answers_.subscribe(bus_);
  subscribe<SegmenterStatus>(bus_, channels::kSegmenterStatus,
                             [this](const SegmenterStatus& status) { status_ = status; });
}

// Answers to other clients arrive too.
void QueryClient::take(SegmentAnswer answer) {
  if (answer.client != client_ || answer.number != number_) return;
  (answer.problem.empty() ? answer_ : refusal_) = std::move(answer);
}

template <class IsDone>
bool QueryClient::handle_until(Clock::time_point deadline, const std::function<void()>& meanwhile,
                               const IsDone& is_done) {
  while (!is_done()) {
    const auto left = std::chrono::ceil<milliseconds>(deadline - Clock::now());
    if (left <= milliseconds(0)) return false;
    bus_.handle(std::min(left, kMeanwhile));
    if (meanwhile) meanwhile();
  }
  return true;
}

SegmentAnswer QueryClient::ask(SegmentQuery query, Seconds timeout,
                               const std::function<void()>& meanwhile) {
  const auto deadline = deadline_after(timeout);
  query.client = client_;
  query.number = ++number_;
  answer_.reset();
  refusal_.reset();
  int times_asked = 0;
  for (milliseconds wait = kFirstWait; Clock::now() < deadline;
       wait = std::min(2 * wait, kLongestWait)) {
    query.utime = wall_clock_us();
    bus_.publish(channels::kSegmentQuery, query);
    ++times_asked;
    handle_until(std::min(deadline, Clock::now() + wait), meanwhile,
                 [&] { return answer_ || refusal_; });
    if (!answer_ && refusal_) {
      handle_until(Clock::now() + kOthersWait, meanwhile, [&] { return answer_.has_value(); });
    }
    if (answer_) return *std::move(answer_);
    if (refusal_) return *std::move(refusal_);
  }
  throw std::runtime_error(silence(timeout, times_asked));
}

std::string QueryClient::silence(Seconds timeout, int times_asked) const {
  const std::string what = fmt::format("nobody answered within {} s, asked {} times on {}",
                                       timeout.count(), times_asked, bus_.url());
  if (!status_) return what + ": no segmenter is heard there; is kintsugi-segmenter running?";
  return what + fmt::format(
                    ": the segmenter of map '{}' is heard, {} slices behind and {:.0f} ms a slice; "
                    "give it longer with --timeout",
                    status_->map_name, status_->lag_slices, status_->slice_ms);
}

}  // namespace kintsugi::segmenter
