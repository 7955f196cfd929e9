// Mcast and the loop on real sockets, as root in a network of their own (namespace.sh).

#include "blactl/can/loop.hpp"
#include "blactl/can/mcast.hpp"

#include "catch.hpp"

#include <fcntl.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <tuple>

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;

namespace {

/// These tests take interfaces away: never in the network of somebody's machine.
const bool in_a_network_of_our_own = [] {
  if (std::getenv("BLACTL_NET_OF_ITS_OWN") == nullptr) {
    std::fputs("net-mcast: start it with tests/net/namespace.sh\n", stderr);
    std::_Exit(EXIT_FAILURE);
  }
  return true;
}();

constexpr Duration patience = 10s;

void shell(const std::string& command) {
  INFO(command);
  REQUIRE(std::system(command.c_str()) == 0);
}

/// Ethernet for one test: net7 is up and has an address.
class Ethernet {
 public:
  Ethernet() {
    shell("ip link add net7 type veth peer name net8 && ip addr add 10.82.7.1/24 dev net7 && "
          "ip link set net8 up && ip link set net7 up");
  }

  ~Ethernet() { std::ignore = std::system("ip link del net7 2>/dev/null"); }

  Ethernet(const Ethernet&) = delete;
  Ethernet& operator=(const Ethernet&) = delete;
};

std::unique_ptr<Bus> open(std::uint8_t number, std::string_view interface) {
  auto bus = Mcast::open(number, interface);
  REQUIRE(bus.has_value());
  return std::move(*bus);
}

Frame frame(std::uint32_t id) {
  return {.id = id, .size = 3, .data = {0xD2, 0x04, 0xC0}};
}

BusEvent next(Bus& bus) {
  const Time deadline = bus.now() + patience;
  while (bus.now() < deadline) {
    if (auto event = bus.receive()) {
      return *event;
    }
    pollfd waiting{bus.descriptor(), POLLIN, 0};
    poll(&waiting, 1, 1'000);
  }
  FAIL("nothing came");
  std::abort();
}

template <class T> T expect(Bus& bus) {
  BusEvent event = next(bus);
  REQUIRE(std::holds_alternative<T>(event));
  return std::get<T>(event);
}

/// The receiving UDP socket of this process, which is the last one bound to the port.
int receiving_socket() {
  int found = -1;
  for (int fd = 3; fd < 100; ++fd) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    if (getsockname(fd, reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
        address.sin_family == AF_INET && address.sin_port == htons(57732)) {
      found = fd;
    }
  }
  REQUIRE(found >= 0);
  return found;
}

template <class T> T option(int descriptor, int level, int name) {
  T value{};
  socklen_t size = sizeof value;
  REQUIRE(getsockopt(descriptor, level, name, &value, &size) == 0);
  return value;
}

} // namespace

TEST_CASE("a frame reaches every other bus object of its number, and never its sender") {
  const auto one = open(0, "lo");
  const auto two = open(0, "lo");
  const auto three = open(0, "lo");
  const auto elsewhere = open(1, "lo");
  CHECK(one->name() == "mcast:0?if=lo");
  CHECK_FALSE(one->echoes());
  REQUIRE(one->send(frame(0x1401'552A)).value());
  CHECK(expect<Received>(*two).frame == frame(0x1401'552A));
  CHECK(expect<Received>(*three).frame == frame(0x1401'552A));
  REQUIRE(two->send(frame(7)).value());
  CHECK(expect<Received>(*one).frame == frame(7)); // and not its own, which came before
  CHECK_FALSE(one->receive().has_value());
  CHECK_FALSE(elsewhere->receive().has_value());
  CHECK(one->unreadable() == 0);
}

TEST_CASE("frames of every kind arrive, in order, more of them than one read takes") {
  const auto one = open(0, "lo");
  const auto two = open(0, "lo");
  REQUIRE(one->send({.id = 0x7FF, .extended = false, .size = 8}).value());
  REQUIRE(one->send({.id = 5, .remote = true, .size = 8}).value());
  for (std::uint32_t id = 0; id < 100; ++id) {
    REQUIRE(one->send(frame(id)).value());
  }
  CHECK(expect<Received>(*two).frame == Frame{.id = 0x7FF, .extended = false, .size = 8});
  CHECK(expect<Received>(*two).frame == Frame{.id = 5, .remote = true, .size = 8});
  for (std::uint32_t id = 0; id < 100; ++id) {
    CHECK(expect<Received>(*two).frame.id == id);
  }
}

TEST_CASE("what comes after many frames of our own is not held back by them") {
  const auto one = open(0, "lo");
  const auto two = open(0, "lo");
  for (std::uint32_t id = 0; id < 100; ++id) {
    REQUIRE(one->send(frame(id)).value());
  }
  REQUIRE(two->send(frame(500)).value());
  const auto first = one->receive(); // one call, as a loop makes it
  REQUIRE(first.has_value());
  CHECK(std::get<Received>(*first).frame.id == 500);
}

TEST_CASE("the sockets do not block, are not inherited, and share the port without SO_REUSEPORT") {
  const auto bus = open(0, "lo");
  const int socket = receiving_socket();
  CHECK((fcntl(socket, F_GETFL) & O_NONBLOCK) != 0);
  CHECK((fcntl(socket, F_GETFD) & FD_CLOEXEC) != 0);
  CHECK((fcntl(bus->descriptor(), F_GETFD) & FD_CLOEXEC) != 0);
  CHECK(option<int>(socket, SOL_SOCKET, SO_REUSEADDR) == 1);
  CHECK(option<int>(socket, SOL_SOCKET, SO_REUSEPORT) == 0);
  CHECK(option<int>(socket, IPPROTO_IP, IP_MULTICAST_ALL) == 0);
  CHECK(option<int>(socket, SOL_SOCKET, SO_RCVBUF) >= 212'992); // as far as the kernel gives it
}

/// Whether a frame that waits in the socket for `wait` bears the time when it was sent.
bool bears_the_time_it_was_sent(Bus& sender, Bus& receiver, Duration wait) {
  const Duration slack = wait / 2; // clocks are read one after the other
  const Time before = receiver.now();
  const WallTime wall_before = receiver.wall();
  REQUIRE(sender.send(frame(1)).value());
  const Duration took = receiver.now() - before;
  usleep(static_cast<useconds_t>(wait.count()));
  const auto received = expect<Received>(receiver);
  CHECK(received.at >= before - slack);
  CHECK(received.wall >= wall_before - slack);
  return received.at <= before + took + slack && received.wall <= wall_before + took + slack;
}

TEST_CASE("a frame bears the time when the kernel saw it, not when it was read") {
  const auto one = open(0, "lo");
  const auto two = open(0, "lo");
  // Linux asks a worker to switch its stamps on: the first frames may come before that.
  bool is_stamped = false;
  for (int tries = 0; tries < 50 && !is_stamped; ++tries) {
    is_stamped = bears_the_time_it_was_sent(*one, *two, 200ms);
  }
  CHECK(is_stamped);
}

TEST_CASE("datagrams that the kernel had to drop are counted before the next one") {
  const auto one = open(0, "lo");
  const auto two = open(0, "lo");
  const int tiny = 1;
  REQUIRE(setsockopt(receiving_socket(), SOL_SOCKET, SO_RCVBUF, &tiny, sizeof tiny) == 0);
  for (std::uint32_t id = 0; id < 100; ++id) {
    REQUIRE(one->send(frame(id)).value());
  }
  std::uint64_t kept = 0;
  while (const auto event = two->receive()) {
    REQUIRE(std::holds_alternative<Received>(*event));
    ++kept;
  }
  CHECK(kept < 100);
  REQUIRE(one->send(frame(99)).value());
  CHECK(expect<Overflow>(*two).lost == 100 - kept);
  CHECK(expect<Received>(*two).frame.id == 99);
}

TEST_CASE("an interface keeps what is sent on another one away") {
  const Ethernet ethernet;
  const auto on_loopback = open(0, "lo");
  const auto sender = open(0, "net7");
  const auto receiver = open(0, "net7");
  CHECK(sender->name() == "mcast:0?if=net7");
  REQUIRE(sender->send(frame(1)).value());
  CHECK(expect<Received>(*receiver).frame.id == 1);
  CHECK_FALSE(on_loopback->receive().has_value());
}

TEST_CASE("an alternative name opens the interface, which is known by its own") {
  const Ethernet ethernet;
  shell("ip link property add dev net7 altname left-arm");
  CHECK(open(0, "left-arm")->name() == "mcast:0?if=net7");
}

TEST_CASE("a loop that waits is told when the interface goes down or away") {
  const Ethernet ethernet;
  Loop loop(open(0, "net7"));
  const bool away = GENERATE(false, true);
  shell(away ? "(sleep 0.3; ip link del net7) &" : "(sleep 0.3; ip link set net7 down) &");
  const Event event = loop.next(loop.now() + patience);
  REQUIRE(std::holds_alternative<Gone>(event));
  const Error error = std::get<Gone>(event).error;
  CHECK(error.code == Code::interface);
  CHECK(error.message.starts_with("interface net7 is "));
  CHECK_FALSE(error.hint.empty());
}

TEST_CASE("changes of other interfaces end nothing") {
  const Ethernet ethernet;
  const auto bus = open(0, "lo");
  shell("ip link set net7 down");
  CHECK_FALSE(bus->receive().has_value());
  pollfd waiting{bus->descriptor(), POLLIN, 0};
  CHECK(poll(&waiting, 1, 0) == 0);
}

TEST_CASE("sending by an interface that is down or has lost its address says so") {
  const Ethernet ethernet;
  const auto bus = open(0, "net7");
  SECTION("down") {
    shell("ip link set net7 down");
    const auto sent = bus->send(frame(1));
    REQUIRE_FALSE(sent.has_value());
    CHECK(sent.error().message == "interface net7 is down");
    CHECK(sent.error().hint.find("sudo ip link set net7 up") != std::string::npos);
  }
  SECTION("gone") {
    shell("ip link del net7");
    const auto sent = bus->send(frame(1));
    REQUIRE_FALSE(sent.has_value());
    CHECK(sent.error().message == "interface net7 is gone");
  }
  SECTION("no address") {
    shell("ip addr del 10.82.7.1/24 dev net7");
    const auto sent = bus->send(frame(1));
    REQUIRE_FALSE(sent.has_value());
    CHECK(sent.error().message == "interface net7 has no IPv4 address");
  }
}

TEST_CASE("a program that keeps the port for itself is told, with how to find it") {
  const int other = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(57732);
  REQUIRE(::bind(other, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  const auto bus = Mcast::open(0, "lo");
  close(other);
  REQUIRE_FALSE(bus.has_value());
  CHECK(bus.error().code == Code::interface);
  CHECK(bus.error().message.find("port 57732") != std::string::npos);
  CHECK(bus.error().hint.find("57732") != std::string::npos);
}

TEST_CASE("an interface that cannot be used is refused before anything is sent") {
  const Ethernet ethernet;
  CHECK(Mcast::open(0, "no\x1b[2Jnet").error().message == "there is no interface no\\x1b[2Jnet");
  CHECK(Mcast::open(0, "a-name-that-is-far-too-long").error().code == Code::interface);
  CHECK(Mcast::open(0, "net8").error().message == "interface net8 has no IPv4 address");
  shell("ip link set net8 down");
  CHECK(Mcast::open(0, "net8").error().message == "interface net8 is down");
}
