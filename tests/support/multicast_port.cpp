#include "tests/support/multicast_port.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <regex>
#include <stdexcept>
#include <system_error>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

namespace kintsugi::testing {
namespace {

constexpr int kReceiveBufferBytes = 4'194'304;
constexpr std::size_t kMaxDatagramBytes = 65'536;

[[noreturn]] void fail(const std::string& what) {
  throw std::system_error(errno, std::generic_category(), what);
}

template <class Value>
void set_option(int socket, int level, int option, const Value& value, const char* name) {
  if (setsockopt(socket, level, option, &value, sizeof(value)) != 0) fail(name);
}

struct Url {
  sockaddr_in group{};
  int ttl = 0;
};

Url parse(const std::string& url) {
  static const std::regex form(R"(udpm://([0-9.]+):(\d{1,5})(?:\?ttl=(\d{1,3}))?)");
  std::smatch match;
  Url parsed;
  parsed.group.sin_family = AF_INET;
  if (!std::regex_match(url, match, form) ||
      inet_pton(AF_INET, match[1].str().c_str(), &parsed.group.sin_addr) != 1 ||
      !IN_MULTICAST(ntohl(parsed.group.sin_addr.s_addr)) || std::stoi(match[2]) > 65'535) {
    throw std::invalid_argument("bus " + url + ", expected udpm://GROUP:PORT?ttl=N");
  }
  parsed.group.sin_port = htons(static_cast<std::uint16_t>(std::stoi(match[2])));
  if (match[3].matched) parsed.ttl = std::stoi(match[3]);
  return parsed;
}

int new_socket() {
  const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (socket < 0) fail("socket");
  return socket;
}

/// Bound to the group, so that no other group's datagrams come in by the same port.
int listen_to(const sockaddr_in& group) {
  const int socket = new_socket();
  set_option(socket, SOL_SOCKET, SO_REUSEADDR, 1, "SO_REUSEADDR");
  set_option(socket, SOL_SOCKET, SO_RCVBUF, kReceiveBufferBytes, "SO_RCVBUF");
  set_option(socket, SOL_SOCKET, SO_RXQ_OVFL, 1, "SO_RXQ_OVFL");
  if (bind(socket, reinterpret_cast<const sockaddr*>(&group), sizeof(group)) != 0) fail("bind");
  ip_mreq membership{};
  membership.imr_multiaddr = group.sin_addr;
  set_option(socket, IPPROTO_IP, IP_ADD_MEMBERSHIP, membership, "IP_ADD_MEMBERSHIP");
  return socket;
}

/// Connected, so that it has a source address and port by which it knows its own datagrams.
int speak_to(const sockaddr_in& group, int ttl) {
  const int socket = new_socket();
  set_option(socket, IPPROTO_IP, IP_MULTICAST_TTL, ttl, "IP_MULTICAST_TTL");
  if (connect(socket, reinterpret_cast<const sockaddr*>(&group), sizeof(group)) != 0) {
    fail("connect (is there a route for 224.0.0.0/4?)");
  }
  return socket;
}

/// How many datagrams the socket has lost so far; the kernel attaches it to a datagram.
std::optional<std::uint32_t> losses_told(msghdr& header) {
  for (cmsghdr* part = CMSG_FIRSTHDR(&header); part != nullptr; part = CMSG_NXTHDR(&header, part)) {
    if (part->cmsg_level != SOL_SOCKET || part->cmsg_type != SO_RXQ_OVFL) continue;
    std::uint32_t count = 0;
    std::memcpy(&count, CMSG_DATA(part), sizeof(count));
    return count;
  }
  return {};
}

}  // namespace

MulticastPort::MulticastPort(const std::string& url) : buffer_(kMaxDatagramBytes) {
  const Url parsed = parse(url);
  receiver_ = listen_to(parsed.group);
  sender_ = speak_to(parsed.group, parsed.ttl);
  socklen_t size = sizeof(own_);
  if (getsockname(sender_, reinterpret_cast<sockaddr*>(&own_), &size) != 0) fail("getsockname");
}

MulticastPort::~MulticastPort() {
  close(receiver_);
  close(sender_);
}

std::optional<Bytes> MulticastPort::receive() {
  while (true) {
    sockaddr_in sender{};
    iovec place{buffer_.data(), buffer_.size()};
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(std::uint32_t))> beside{};
    msghdr header{};
    header.msg_name = &sender;
    header.msg_namelen = sizeof(sender);
    header.msg_iov = &place;
    header.msg_iovlen = 1;
    header.msg_control = beside.data();
    header.msg_controllen = beside.size();
    const ssize_t size = recvmsg(receiver_, &header, MSG_DONTWAIT);
    if (size < 0 && errno == EINTR) continue;
    if (size < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return {};
    if (size < 0) fail("recvmsg");
    if (const auto losses = losses_told(header)) lost_ = *losses;
    if (sender.sin_port == own_.sin_port && sender.sin_addr.s_addr == own_.sin_addr.s_addr)
      continue;
    return Bytes(buffer_.begin(), buffer_.begin() + size);
  }
}

void MulticastPort::send(ByteView datagram) {
  while (::send(sender_, datagram.data(), datagram.size(), 0) < 0) {
    if (errno != EINTR) fail("send " + std::to_string(datagram.size()) + " bytes");
  }
}

}  // namespace kintsugi::testing
