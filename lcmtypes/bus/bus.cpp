#include "lcmtypes/bus/bus.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <utility>

#include <arpa/inet.h>
#include <lcm/lcm.h>
#include <netinet/in.h>
#include <sys/select.h>
#include <sys/socket.h>
#include <unistd.h>

#include "lcmtypes/signing/process_key.hpp"

namespace kintsugi {
namespace {

// Holds 0.4 s of a stream at its default rate, for the time that the receiver is busy.
constexpr int kReceiveBufferBytes = 4'194'304;
constexpr char kGroup[] = "239.255.76.67";
constexpr char kReceiveBufferLimit[] = "/proc/sys/net/core/rmem_max";

bool is_datagrams(const std::string& url) { return url.starts_with("udpm://"); }
bool is_log(const std::string& url) { return url.starts_with("file://"); }

/// The multicast group of a URL: what stands between udpm:// and the port or the options.
std::string group_of(const std::string& url) {
  const std::size_t begin = url.find("://") + 3;
  const std::string group = url.substr(begin, url.find_first_of(":?", begin) - begin);
  return group.empty() ? kGroup : group;
}

/// Checked before LCM is opened, which without a route prints pages of text and fails without a
/// reason. Connecting a datagram socket sends nothing, and fails exactly when there is no route.
bool has_route_to(const std::string& group) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(7667);
  const bool is_address = inet_pton(AF_INET, group.c_str(), &address.sin_addr) == 1;
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  if (!is_address || socket < 0) return true;  // LCM will report the error
  const int result = connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof(address));
  const bool unreachable = result != 0 && errno == ENETUNREACH;
  close(socket);
  return !unreachable;
}

/// The URL to open: with defaults for what `asked` leaves out.
std::string complete_url(const std::string& asked) {
  std::string url = asked.empty() ? default_bus_url() : asked;
  if (!is_datagrams(url) || url.find("recv_buf_size=") != std::string::npos) return url;
  const char separator = url.find('?') == std::string::npos ? '?' : '&';
  return url + separator + "recv_buf_size=" + std::to_string(kReceiveBufferBytes);
}

/// True for errors after which a later datagram may be sent: a cable is unplugged, an interface is
/// down, a queue is full, a firewall drops packets.
bool is_temporary(int error) {
  constexpr std::array kTemporary = {ENETDOWN, ENETUNREACH, EHOSTDOWN, EHOSTUNREACH,
                                     ENOBUFS,  EAGAIN,      EPERM,     ECONNREFUSED};
  return std::find(kTemporary.begin(), kTemporary.end(), error) != kTemporary.end();
}

/// True when messages leave this host: ttl > 0; LCM's default is 0.
bool leaves_host(const std::string& url) {
  const std::size_t option = url.find("ttl=");
  return is_datagrams(url) && option != std::string::npos &&
         std::strtol(url.c_str() + option + 4, nullptr, 10) > 0;
}

}  // namespace

/// One subscription of LCM: a message is verified once, however many handlers there are.
struct Bus::Channel {
  Channel(Bus& its_bus, std::string its_name) : bus(its_bus), name(std::move(its_name)) {}

  Bus& bus;
  std::string name;
  std::vector<Handler> handlers;

  // Called by C code, through which no exception may pass: handle() throws it afterwards.
  static void on_message(const lcm_recv_buf_t* buffer, const char* /*channel*/, void* user) {
    auto* self = static_cast<Channel*>(user);
    try {
      const ByteView data(static_cast<const std::uint8_t*>(buffer->data), buffer->data_size);
      if (const auto message = self->bus.guard_.open(self->name, data)) self->pass(*message);
    } catch (...) {
      self->bus.keep_failure();
    }
  }

  void pass(ByteView message) {
    for (std::size_t i = 0; i < handlers.size(); ++i) {  // a handler may subscribe another one
      try {
        handlers[i](message);
      } catch (...) {
        bus.keep_failure();
      }
    }
  }
};

std::int64_t wall_clock_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

std::int64_t new_session() { return wall_clock_us(); }

std::string default_bus_url() {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  if (url != nullptr && *url != '\0') return url;
  return std::string("udpm://").append(kGroup).append(":7667?ttl=0");
}

void check_bus_url(const std::string& url) {
  constexpr std::array kTransports = {"udpm://", "mpudpm://", "tcpq://", "memq://", "file://"};
  const std::string asked = url.empty() ? default_bus_url() : url;
  const auto begins = [&](const char* transport) { return asked.starts_with(transport); };
  if (std::ranges::any_of(kTransports, begins)) return;
  throw std::runtime_error("cannot open the bus " + asked +
                           ": expected an LCM URL such as udpm://" + kGroup + ":7667?ttl=0");
}

std::optional<std::string> receive_buffer_advice() {
  std::int64_t limit = 0;
  if (!(std::ifstream(kReceiveBufferLimit) >> limit) || limit >= kReceiveBufferBytes) return {};
  const std::string wanted = std::to_string(kReceiveBufferBytes);
  return "the kernel limits receive buffers to " + std::to_string(limit) + " bytes, " + wanted +
         " are wanted: bursts may be lost. Raise the limit: sysctl -w net.core.rmem_max=" + wanted;
}

Bus::Bus(const std::string& url)
    : Bus(url, is_log(url) ? log_trust() : MessageTrust{.key = bus_key()}) {}

Bus::Bus(const std::string& url, const MessageTrust& trust)
    : url_(complete_url(url)),
      guard_(trust, is_log(url_) ? MessageGuard::Source::kLog : MessageGuard::Source::kBus, url_),
      lcm_(nullptr, lcm_destroy) {
  if (trust.key) signer_.emplace(trust.key);
  if (is_datagrams(url_) && !has_route_to(group_of(url_))) {
    throw std::runtime_error("cannot open the bus " + url_ + ": no route to " + group_of(url_) +
                             ". Add one for 224.0.0.0/4: ip route add 224.0.0.0/4 dev lo");
  }
  lcm_.reset(lcm_create(url_.c_str()));
  if (!lcm_) {
    throw std::runtime_error("cannot open the bus " + url_ +
                             ": expected an LCM URL such as udpm://" + kGroup + ":7667?ttl=0");
  }
  check_descriptor();
}

/// LCM waits for it with select(), which ends the process where it is out of range.
void Bus::check_descriptor() const {
  const int descriptor = lcm_get_fileno(lcm_.get());
  if (descriptor < 0 && url_.starts_with("tcpq://")) {
    throw std::runtime_error("cannot open the bus " + url_ + ": nobody answers there");
  }
  if (descriptor >= FD_SETSIZE) {
    throw std::runtime_error("cannot open the bus " + url_ + ": this process has " +
                             std::to_string(descriptor) + " files open, LCM works with up to " +
                             std::to_string(FD_SETSIZE));
  }
}

Bus::~Bus() = default;

void Bus::publish(const std::string& channel, ByteView message) {
  Bytes signed_bytes;
  if (signer_) {
    signed_bytes = signer_->sign(channel, message);
    message = signed_bytes;
  }
  const auto size = static_cast<unsigned>(message.size());
  errno = 0;
  if (lcm_publish(lcm_.get(), channel.c_str(), message.data(), size) == 0) return;
  if (is_datagrams(url_) && is_temporary(errno)) return;
  throw std::runtime_error("cannot publish " + std::to_string(message.size()) + " bytes on " +
                           channel + " of the bus " + url_);
}

std::size_t Bus::max_message_bytes() const {
  return leaves_host(url_) ? kMinMaxChunkBytes : kDefaultMaxChunkBytes;
}

void Bus::subscribe(const std::string& channel, Handler handler) {
  std::unique_ptr<Channel>& known = channels_[channel];
  const bool is_new = known == nullptr;
  if (is_new) known = std::make_unique<Channel>(*this, channel);
  known->handlers.push_back(std::move(handler));
  if (!is_new) return;
  lcm_subscription_t* subscription =
      lcm_subscribe(lcm_.get(), channel.c_str(), &Channel::on_message, known.get());
  if (subscription == nullptr) {
    throw std::runtime_error("cannot subscribe to " + channel + " of the bus " + url_);
  }
  // No limit: by default LCM silently drops messages beyond 30.
  lcm_subscription_set_queue_capacity(subscription, 0);
}

void Bus::keep_failure() {
  if (!failure_) failure_ = std::current_exception();
}

bool Bus::handle(std::chrono::milliseconds timeout) {
  errno = 0;
  const int handled = lcm_handle_timeout(lcm_.get(), static_cast<int>(timeout.count()));
  const bool interrupted = handled < 0 && errno == EINTR;  // by a signal
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
  if (handled < 0 && !interrupted) {
    throw std::runtime_error("the connection to the bus " + url_ + " is lost");
  }
  return handled > 0;
}

}  // namespace kintsugi
