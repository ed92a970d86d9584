#pragma once
// A network of the test's own, with a multicast route on loopback: what is published there reaches
// nobody else, and nobody else's messages reach the test.

#include <cerrno>
#include <cstring>
#include <fstream>
#include <optional>
#include <string>

#include <arpa/inet.h>
#include <net/if.h>
#include <net/route.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

namespace kintsugi::testing {

/// The LCM URL to open a Bus with in this network.
inline constexpr char kPrivateBusUrl[] = "udpm://239.255.76.67:7667?ttl=0";

inline sockaddr internet_address(const char* text) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  inet_pton(AF_INET, text, &address.sin_addr);
  sockaddr any{};
  std::memcpy(&any, &address, sizeof(any));
  return any;
}

/// Moves the process into a network namespace of its own; without privileges, in a user namespace.
inline bool leave_network() {
  if (unshare(CLONE_NEWNET) == 0) return true;
  const auto uid = getuid();
  const auto gid = getgid();
  if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
  std::ofstream("/proc/self/setgroups") << "deny";
  std::ofstream("/proc/self/uid_map") << "0 " << uid << " 1";
  std::ofstream("/proc/self/gid_map") << "0 " << gid << " 1";
  return true;
}

/// ip link set lo up; ip route add 224.0.0.0/4 dev lo
inline bool route_multicast_to_loopback() {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  char loopback[] = "lo";
  ifreq interface {};
  std::strcpy(interface.ifr_name, loopback);
  interface.ifr_flags = IFF_UP | IFF_RUNNING;
  rtentry route{};
  route.rt_dst = internet_address("224.0.0.0");
  route.rt_genmask = internet_address("240.0.0.0");
  route.rt_flags = RTF_UP;
  route.rt_dev = loopback;
  const bool done =
      ioctl(socket, SIOCSIFFLAGS, &interface) == 0 && ioctl(socket, SIOCADDRT, &route) == 0;
  close(socket);
  return done;
}

/// ip link set lo down: from now on nothing can be sent.
inline bool take_loopback_down() {
  const int socket = ::socket(AF_INET, SOCK_DGRAM, 0);
  char loopback[] = "lo";
  ifreq interface {};
  std::strcpy(interface.ifr_name, loopback);
  const bool done = ioctl(socket, SIOCSIFFLAGS, &interface) == 0;
  close(socket);
  return done;
}

/// Call before the process has a second thread. Returns why it is not permitted here, if so:
///   if (const auto why_not = enter_private_bus()) GTEST_SKIP() << *why_not;
inline std::optional<std::string> enter_private_bus() {
  if (!leave_network()) {
    return std::string("no private network namespace here: ") + std::strerror(errno);
  }
  if (!route_multicast_to_loopback()) {
    return std::string("cannot route multicast to loopback: ") + std::strerror(errno);
  }
  return std::nullopt;
}

}  // namespace kintsugi::testing
