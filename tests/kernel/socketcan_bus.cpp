// SocketCan, the loop and the list of interfaces in a real kernel, as root (uml.sh). Every test
// has an interface of its own, and a plain raw socket that plays the other end.

#include "blactl/can/link.hpp"
#include "blactl/can/loop.hpp"
#include "blactl/can/socketcan.hpp"

#include "catch.hpp"

#include <fcntl.h>
#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <linux/tty.h>
#include <net/if.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <string>

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;

namespace {

/// These tests delete interfaces and set the clock: never in the kernel of somebody's machine.
const bool in_a_kernel_of_our_own = [] {
  if (std::getenv("BLACTL_KERNEL_OF_ITS_OWN") == nullptr) {
    std::fputs("kernel-can: start it with tests/kernel/uml.sh\n", stderr);
    std::_Exit(EXIT_FAILURE);
  }
  return true;
}();

constexpr Duration patience = 10s;

void shell(const std::string& command) {
  INFO(command);
  REQUIRE(std::system(command.c_str()) == 0);
}

/// A virtual interface that is up, for one test.
class Interface {
 public:
  Interface() { shell("ip link add dev vcan7 type vcan && ip link set vcan7 up"); }

  ~Interface() { std::ignore = std::system("ip link del vcan7 2>/dev/null"); }

  Interface(const Interface&) = delete;
  Interface& operator=(const Interface&) = delete;

  /// Frames leave only so long after they were sent; at most `limit` of them wait.
  void delay(Duration time, int limit) {
    shell("tc qdisc replace dev vcan7 root netem delay " + std::to_string(time.count()) +
          "us limit " + std::to_string(limit));
  }

  /// Frames that wait to leave.
  [[nodiscard]] int queued() const {
    FILE* const tc =
        popen("tc -s qdisc show dev vcan7 | sed -n 's/.*backlog .* \\(.*\\)p .*/\\1/p'", "r");
    int count = -1;
    REQUIRE(std::fscanf(tc, "%d", &count) == 1);
    pclose(tc);
    return count;
  }

  [[nodiscard]] std::unique_ptr<Bus> open() const {
    auto bus = SocketCan::open("vcan7");
    REQUIRE(bus.has_value());
    return std::move(*bus);
  }
};

/// Another program on the interface: a raw socket with nothing around it.
class Other {
 public:
  Other() : descriptor_(::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW)) {
    sockaddr_can address{};
    address.can_family = AF_CAN;
    address.can_ifindex = static_cast<int>(if_nametoindex("vcan7"));
    REQUIRE(::bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0);
  }

  ~Other() { close(descriptor_); }

  Other(const Other&) = delete;
  Other& operator=(const Other&) = delete;

  void send(std::uint32_t kernel_id, std::array<std::uint8_t, 8> data = {}) {
    can_frame frame{};
    frame.can_id = kernel_id;
    frame.len = 8;
    std::ranges::copy(data, frame.data);
    REQUIRE(write(descriptor_, &frame, sizeof frame) == sizeof frame);
  }

  void send_flexible_rate(std::uint32_t id) {
    const int on = 1;
    REQUIRE(setsockopt(descriptor_, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof on) == 0);
    canfd_frame frame{};
    frame.can_id = id | CAN_EFF_FLAG;
    frame.len = 64;
    REQUIRE(write(descriptor_, &frame, sizeof frame) == sizeof frame);
  }

  [[nodiscard]] can_frame receive() {
    can_frame frame{};
    pollfd waiting{descriptor_, POLLIN, 0};
    REQUIRE(poll(&waiting, 1, 10'000) == 1);
    REQUIRE(read(descriptor_, &frame, sizeof frame) == sizeof frame);
    return frame;
  }

 private:
  int descriptor_;
};

Frame frame(std::uint32_t id) {
  return {.id = id, .size = 3, .data = {0xD2, 0x04, 0xC0}};
}

/// The next event of a bus without a loop.
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

/// The next event has to be a T.
template <class T> T expect(Bus& bus) {
  BusEvent event = next(bus);
  REQUIRE(std::holds_alternative<T>(event));
  return std::get<T>(event);
}

template <class T> T expect(Loop& loop) {
  Event event = loop.next(loop.now() + patience);
  REQUIRE(std::holds_alternative<T>(event));
  return std::get<T>(event);
}

bool contains(const std::string& text, std::string_view part) {
  CAPTURE(text, part);
  return text.find(part) != std::string::npos;
}

Error open_error(std::string_view name) {
  auto bus = SocketCan::open(name);
  REQUIRE_FALSE(bus.has_value());
  CHECK(bus.error().code == Code::interface);
  return bus.error();
}

} // namespace

// --- frames -----------------------------------------------------------------------------------

TEST_CASE("a frame of ours reaches the other end and comes back as Sent") {
  const Interface interface;
  const auto bus = interface.open();
  Other other;
  CHECK(bus->name() == "vcan7");
  CHECK_FALSE(bus->receive().has_value());
  CHECK(bus->send(frame(0x1401'552A)).value());
  const can_frame seen = other.receive();
  CHECK(seen.can_id == 0x9401'552A);
  CHECK(seen.len == 3);
  CHECK(std::ranges::equal(std::span(seen.data, 3), frame(0).payload()));
  CHECK(expect<Sent>(*bus).frame == frame(0x1401'552A));
  CHECK_FALSE(bus->receive().has_value());
}

TEST_CASE("frames of other programs of this machine are Received, of every kind") {
  const Interface interface;
  const auto bus = interface.open();
  Other other;
  other.send(CAN_EFF_FLAG | 0x1401'552A, {1, 2, 3, 4, 5, 6, 7, 8});
  other.send(0x7FF);
  other.send(CAN_EFF_FLAG | CAN_RTR_FLAG | 5);
  CHECK(expect<Received>(*bus).frame ==
        Frame{.id = 0x1401'552A, .size = 8, .data = {1, 2, 3, 4, 5, 6, 7, 8}});
  CHECK(expect<Received>(*bus).frame == Frame{.id = 0x7FF, .extended = false, .size = 8});
  CHECK(expect<Received>(*bus).frame == Frame{.id = 5, .remote = true, .size = 8});
}

TEST_CASE("two blactl on one interface see each other's frames as Received") {
  const Interface interface;
  const auto one = interface.open();
  const auto two = interface.open();
  CHECK(one->send(frame(1)).value());
  CHECK(expect<Received>(*two).frame == frame(1));
  CHECK(expect<Sent>(*one).frame == frame(1));
}

TEST_CASE("more frames than one read takes arrive in order") {
  const Interface interface;
  const auto bus = interface.open();
  Other other;
  for (std::uint32_t id = 0; id < 100; ++id) {
    other.send(CAN_EFF_FLAG | id);
  }
  for (std::uint32_t id = 0; id < 100; ++id) {
    CHECK(expect<Received>(*bus).frame.id == id);
  }
}

TEST_CASE("frames of CAN FD are passed over") {
  const Interface interface;
  const auto bus = interface.open();
  Other other;
  other.send_flexible_rate(1);
  other.send(CAN_EFF_FLAG | 2);
  CHECK(expect<Received>(*bus).frame.id == 2);
}

TEST_CASE("the socket does not block, is not inherited, and has room for seconds of a full bus") {
  const Interface interface;
  const auto bus = interface.open();
  CHECK((fcntl(bus->descriptor(), F_GETFL) & O_NONBLOCK) != 0);
  CHECK((fcntl(bus->descriptor(), F_GETFD) & FD_CLOEXEC) != 0);
  int size = 0;
  socklen_t length = sizeof size;
  REQUIRE(getsockopt(bus->descriptor(), SOL_SOCKET, SO_RCVBUF, &size, &length) == 0);
  CHECK(size == 16 << 20);
}

// --- filters ----------------------------------------------------------------------------------

TEST_CASE("the kernel lets through what the filters name, until they are taken away") {
  const Interface interface;
  const auto bus = interface.open();
  Other other;
  const std::array filters{Filter{0x0003'F200, 0x00FF'FF80}, Filter{0x0000'7F80, 0x0000'7F80}};
  REQUIRE(bus->filter(filters).has_value());
  other.send(CAN_EFF_FLAG | 0x1803'F30A);
  other.send(0x7FF);
  other.send(CAN_EFF_FLAG | CAN_RTR_FLAG | 0x1803'F20A);
  other.send(CAN_EFF_FLAG | 0x1803'F20A);
  other.send(CAN_EFF_FLAG | 0x1E01'7F8A);
  CHECK(expect<Received>(*bus).frame.id == 0x1803'F20A);
  CHECK(expect<Received>(*bus).frame.id == 0x1E01'7F8A);
  REQUIRE(bus->filter({}).has_value());
  other.send(0x7FF);
  CHECK(expect<Received>(*bus).frame.id == 0x7FF);
}

TEST_CASE("our own frames are Sent whatever the filters say") {
  const Interface interface;
  const auto bus = interface.open();
  const Filter answers{0x0000'7F80, 0x0000'7F80};
  CHECK(bus->send(frame(0x1E01'8AFF)).value());
  expect<Sent>(*bus);
  REQUIRE(bus->filter({&answers, 1}).has_value());
  for (const std::uint32_t id : {0x1E01'8AFFU, 0x1E01'8BFFU, 0x1401'557FU}) {
    CHECK(bus->send(frame(id)).value());
    CHECK(expect<Sent>(*bus).frame.id == id);
  }
}

// --- errors -----------------------------------------------------------------------------------

TEST_CASE("error frames of the controller become faults, whatever the filters say") {
  const Interface interface;
  const auto bus = interface.open();
  Other controller;
  const Filter nothing{1, extended_id_mask};
  REQUIRE(bus->filter({&nothing, 1}).has_value());
  const auto tell = [&](std::uint32_t error_class, std::array<std::uint8_t, 8> data = {}) {
    controller.send(CAN_ERR_FLAG | error_class, data);
    return expect<BusFault>(*bus).kind;
  };
  CHECK(tell(CAN_ERR_BUSOFF) == FaultKind::bus_off);
  CHECK(tell(CAN_ERR_RESTARTED) == FaultKind::restarted);
  CHECK(tell(CAN_ERR_ACK) == FaultKind::no_acknowledge);
  CHECK(tell(CAN_ERR_TX_TIMEOUT) == FaultKind::transmit_timeout);
  CHECK(tell(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_TX_PASSIVE}) == FaultKind::error_passive);
  CHECK(tell(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_WARNING}) == FaultKind::error_warning);
  CHECK(tell(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_ACTIVE}) == FaultKind::error_active);
  CHECK(tell(CAN_ERR_CRTL, {0, CAN_ERR_CRTL_RX_OVERFLOW}) == FaultKind::receive_overflow);
  CHECK(tell(CAN_ERR_PROT | CAN_ERR_BUSERROR, {0, 0, CAN_ERR_PROT_STUFF}) == FaultKind::protocol);
  controller.send(CAN_ERR_FLAG | CAN_ERR_LOSTARB);
  CHECK(tell(CAN_ERR_BUSOFF) == FaultKind::bus_off); // the lost arbitration is not told
}

TEST_CASE("a full queue takes no more frames and goes on when there is room") {
  Interface interface;
  const auto bus = interface.open();
  interface.delay(1s, 10);
  for (std::uint32_t id = 0; id < 10; ++id) {
    REQUIRE(bus->send(frame(id)).value());
  }
  CHECK_FALSE(bus->send(frame(10)).value());
  CHECK_FALSE(bus->receive().has_value());
  for (std::uint32_t id = 0; id < 10; ++id) {
    CHECK(expect<Sent>(*bus).frame.id == id);
  }
  CHECK(bus->send(frame(11)).value());
  CHECK(expect<Sent>(*bus).frame.id == 11);
}

TEST_CASE("frames that the kernel had to drop are counted before the next one") {
  const Interface interface;
  const auto bus = interface.open();
  Other other;
  Other witness;
  const int tiny = 1;
  REQUIRE(setsockopt(bus->descriptor(), SOL_SOCKET, SO_RCVBUF, &tiny, sizeof tiny) == 0);
  const auto flood = [&] {
    std::uint64_t kept = 0;
    for (std::uint32_t id = 0; id < 20; ++id) {
      other.send(CAN_EFF_FLAG | id);
      std::ignore = witness.receive(); // what reached it has reached, or missed, the bus
    }
    while (const auto event = bus->receive()) {
      REQUIRE(std::holds_alternative<Received>(*event));
      ++kept;
    }
    other.send(CAN_EFF_FLAG | 99);
    std::ignore = witness.receive();
    return 20 - kept;
  };
  const auto first = flood();
  CHECK(first > 0);
  CHECK(expect<Overflow>(*bus).lost == first);
  CHECK(expect<Received>(*bus).frame.id == 99);
  const auto second = flood();
  CHECK(expect<Overflow>(*bus).lost == first + second);
  CHECK(expect<Received>(*bus).frame.id == 99);
  CHECK_FALSE(bus->receive().has_value());
}

TEST_CASE("a frame bears the time when the kernel saw it, not when it was read") {
  const Interface interface;
  const auto bus = interface.open();
  Other other;
  const Time before = bus->now();
  const WallTime wall_before = bus->wall();
  other.send(CAN_EFF_FLAG | 1);
  const Time after = bus->now();
  usleep(200'000);
  const auto received = expect<Received>(*bus);
  constexpr Duration slack = 100ms; // clocks are read one after the other
  CHECK(received.at >= before - slack);
  CHECK(received.at <= after + slack);
  CHECK(received.wall >= wall_before);
  CHECK(received.wall <= wall_before + (after - before) + slack);
}

TEST_CASE("setting the wall clock brings no frame into the future or out of order") {
  const Interface interface;
  const auto bus = interface.open();
  Other other;
  other.send(CAN_EFF_FLAG | 1);
  const Time first = expect<Received>(*bus).at;
  other.send(CAN_EFF_FLAG | 2);
  shell("date -s @$(($(date +%s) - 3600)) >/dev/null");
  const Time second = expect<Received>(*bus).at;
  shell("date -s @$(($(date +%s) + 3600)) >/dev/null");
  CHECK(second >= first);
  CHECK(second <= bus->now());
}

// --- interfaces that are not there --------------------------------------------------------------

TEST_CASE("an interface that goes down is told once, with the command that brings it back") {
  const Interface interface;
  const auto bus = interface.open();
  Other other;
  other.send(CAN_EFF_FLAG | 1);
  shell("ip link set vcan7 down");
  auto event = next(*bus);
  if (std::holds_alternative<Received>(event)) { // may come first, or not at all
    event = next(*bus);
  }
  REQUIRE(std::holds_alternative<Gone>(event));
  const Error error = std::get<Gone>(event).error;
  CHECK(error.code == Code::interface);
  CHECK(error.message == "interface vcan7 is down");
  CHECK(contains(error.hint, "`sudo ip link set vcan7 up`"));
  const auto sent = bus->send(frame(1));
  REQUIRE_FALSE(sent.has_value());
  CHECK(sent.error().code == Code::interface);
  CHECK(sent.error().message == "interface vcan7 is down");
}

TEST_CASE("an interface that is taken away is told as gone") {
  const Interface interface;
  const auto bus = interface.open();
  shell("ip link del vcan7");
  const Error error = expect<Gone>(*bus).error;
  CHECK(error.code == Code::interface);
  CHECK(error.message == "interface vcan7 is gone");
  CHECK_FALSE(error.hint.empty());
  const auto sent = bus->send(frame(1));
  REQUIRE_FALSE(sent.has_value());
  CHECK(sent.error().message == "interface vcan7 is gone");
}

TEST_CASE("an interface that is taken away while the loop waits is gone, not only down") {
  const Interface interface;
  Loop loop(interface.open());
  shell("(sleep 0.3; ip link del vcan7) &");
  CHECK(expect<Gone>(loop).error.message == "interface vcan7 is gone");
}

TEST_CASE("opening an interface that does not exist lists those that do") {
  const Interface interface;
  shell("ip link set vcan7 down");
  const Error error = open_error("can0");
  CHECK(error.message == "there is no interface can0");
  CHECK(error.hint == "CAN interfaces of this machine: vcan0 (up), vcan7 (down)");
  CHECK(open_error("").message == "there is no interface ");
  CHECK(open_error("a-name-that-is-far-too-long").message ==
        "there is no interface a-name-that-is-far-too-long");
}

TEST_CASE("opening an interface of another kind says so") {
  const Error error = open_error("lo");
  CHECK(error.message == "lo is not a CAN interface");
  CHECK(error.hint == "CAN interfaces of this machine: vcan0 (up)");
}

TEST_CASE("opening an interface that is down says how to bring it up") {
  const Interface interface;
  shell("ip link set vcan7 down");
  const Error error = open_error("vcan7");
  CHECK(error.message == "interface vcan7 is down");
  CHECK(contains(error.hint, "`sudo ip link set vcan7 up`"));
}

TEST_CASE("an alternative name opens the interface, which is known by its own") {
  const Interface interface;
  shell("ip link property add dev vcan7 altname left-arm");
  const auto bus = SocketCan::open("left-arm");
  REQUIRE(bus.has_value());
  CHECK((*bus)->name() == "vcan7");
}

TEST_CASE("without a CAN interface the simulated bus is the advice") {
  shell("ip link del vcan0");
  const Error error = open_error("can0");
  shell("ip link add dev vcan0 type vcan && ip link set vcan0 up");
  CHECK(contains(error.hint, "this machine has no CAN interface"));
  CHECK(contains(error.hint, "-i sim:"));
}

// --- the list of interfaces -------------------------------------------------------------------

TEST_CASE("virtual interfaces are listed with kind, state and queue, without bit timing") {
  const Interface interface;
  shell("ip link set vcan7 txqueuelen 77 && ip link set vcan7 down");
  const auto all = links();
  REQUIRE(all.has_value());
  REQUIRE(all->size() == 2);
  const Link& link = all->back();
  CHECK(link.name == "vcan7");
  CHECK(link.kind == "vcan");
  CHECK_FALSE(link.is_up);
  CHECK(link.queue_length == 77);
  CHECK_FALSE(link.bit_rate.has_value());
  CHECK_FALSE(link.state.has_value());
  REQUIRE(only_one_up(*all) != nullptr);
  CHECK(only_one_up(*all)->name == "vcan0");
}

namespace {

/// A serial adapter of the kernel (slcan) on a pseudo terminal: a controller with bit timing.
class SerialController {
 public:
  SerialController() : master_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC)) {
    REQUIRE(grantpt(master_) == 0);
    REQUIRE(unlockpt(master_) == 0);
    slave_ = open(ptsname(master_), O_RDWR | O_NOCTTY | O_CLOEXEC);
    const int discipline = N_SLCAN;
    REQUIRE(ioctl(slave_, TIOCSETD, &discipline) == 0);
    std::array<char, IF_NAMESIZE> name{};
    REQUIRE(ioctl(slave_, SIOCGIFNAME, name.data()) == 0);
    name_ = name.data();
  }

  ~SerialController() {
    close(slave_);
    close(master_);
  }

  SerialController(const SerialController&) = delete;
  SerialController& operator=(const SerialController&) = delete;

  [[nodiscard]] const std::string& name() const { return name_; }

  /// Brings it up as the servos need it; what the kernel says to the adapter has to be read.
  void bring_up() {
    FILE* const ip = popen(("ip link set " + name_ + " up type can bitrate 1000000").c_str(), "r");
    std::string said;
    while (!said.ends_with("O\r")) {
      pollfd waiting{master_, POLLIN, 0};
      REQUIRE(poll(&waiting, 1, 10'000) == 1);
      std::array<char, 64> part{};
      const ssize_t size = read(master_, part.data(), part.size());
      REQUIRE(size > 0);
      said.append(part.data(), static_cast<std::size_t>(size));
    }
    REQUIRE(pclose(ip) == 0);
    CHECK(said.ends_with("S8\rO\r"));
  }

 private:
  int master_;
  int slave_ = -1;
  std::string name_;
};

Link find_link(std::string_view name) {
  const auto all = links();
  REQUIRE(all.has_value());
  const auto link = std::ranges::find(*all, name, &Link::name);
  REQUIRE(link != all->end());
  return *link;
}

} // namespace

TEST_CASE("a controller is listed with its bit rate and state") {
  SerialController adapter;
  const Link down = find_link(adapter.name());
  CHECK(down.kind == "can");
  CHECK_FALSE(down.is_up);
  CHECK_FALSE(down.bit_rate.has_value());
  CHECK(down.state == LinkState::stopped);
  adapter.bring_up();
  const Link up = find_link(adapter.name());
  CHECK(up.is_up);
  CHECK(up.bit_rate == 1'000'000U);
  CHECK(up.state == LinkState::error_active);
  CHECK(up.restart_after == 0ms);
}

TEST_CASE("opening a controller that is down tells the bit timing of the servos") {
  const SerialController adapter;
  const Error error = open_error(adapter.name());
  CHECK(error.message == "interface " + adapter.name() + " is down");
  CHECK(contains(error.hint, "`sudo ip link set " + adapter.name() +
                                 " up type can bitrate 1000000 sample-point 0.875`"));
}

// --- the loop ---------------------------------------------------------------------------------

TEST_CASE("one frame probes a silent bus, three are under way on a live one") {
  Interface interface;
  interface.delay(2s, 100);
  Loop loop(interface.open());
  for (std::uint32_t id = 0; id < 6; ++id) {
    loop.send(frame(id));
  }
  CHECK(interface.queued() == 1);
  CHECK(loop.unsent() == 6);
  CHECK(expect<Sent>(loop).frame.id == 0);
  CHECK(interface.queued() == 3);
  CHECK(loop.unsent() == 5);
  for (std::uint32_t id = 1; id < 6; ++id) {
    CHECK(expect<Sent>(loop).frame.id == id);
  }
  CHECK(loop.unsent() == 0);
  CHECK(interface.queued() == 0);
}

TEST_CASE("frames that were not handed over can be dropped; the probe stays") {
  Interface interface;
  interface.delay(500ms, 100);
  Loop loop(interface.open());
  for (std::uint32_t id = 0; id < 6; ++id) {
    loop.send(frame(id));
  }
  loop.drop_queue();
  CHECK(loop.unsent() == 1);
  CHECK(expect<Sent>(loop).frame.id == 0);
  CHECK(std::holds_alternative<DeadlineReached>(loop.next(loop.now() + 1s)));
}

TEST_CASE("a frame without an echo is told until something is heard") {
  Interface interface;
  Loop loop(interface.open());
  Other other;
  CHECK_FALSE(loop.unacknowledged_since().has_value());
  interface.delay(30s, 100);
  const Time before = loop.now();
  loop.send(frame(1));
  const Time after = loop.now();
  CHECK(std::holds_alternative<DeadlineReached>(loop.next(after + 200ms)));
  REQUIRE(loop.unacknowledged_since().has_value());
  CHECK(*loop.unacknowledged_since() >= before);
  CHECK(*loop.unacknowledged_since() <= after);
  interface.delay(0s, 100); // for later frames only
  other.send(CAN_EFF_FLAG | 2);
  const auto heard = expect<Received>(loop);
  CHECK(heard.frame.id == 2);
  REQUIRE(loop.unacknowledged_since().has_value());
  CHECK(*loop.unacknowledged_since() == heard.at);
}

TEST_CASE("an echo ends the waiting for an acknowledgement") {
  Interface interface;
  interface.delay(200ms, 100);
  Loop loop(interface.open());
  loop.send(frame(1));
  CHECK(loop.unacknowledged_since().has_value());
  expect<Sent>(loop);
  CHECK_FALSE(loop.unacknowledged_since().has_value());
}

TEST_CASE("the loop waits for room in a full queue") {
  Interface interface;
  Loop loop(interface.open());
  Other other;
  interface.delay(1s, 3);
  for (std::uint32_t id = 1; id <= 3; ++id) {
    other.send(CAN_EFF_FLAG | id);
  }
  loop.send(frame(4));
  CHECK(loop.unsent() == 1);
  CHECK_FALSE(loop.unacknowledged_since().has_value()); // it is not even under way
  for (std::uint32_t id = 1; id <= 3; ++id) {
    CHECK(expect<Received>(loop).frame.id == id);
  }
  CHECK(expect<Sent>(loop).frame.id == 4);
}

TEST_CASE("the loop tells once that the interface went down, while waiting or sending") {
  const Interface interface;
  Loop loop(interface.open());
  SECTION("while waiting") {
    shell("ip link set vcan7 down");
    CHECK(expect<Gone>(loop).error.message == "interface vcan7 is down");
  }
  SECTION("while sending") {
    shell("ip link set vcan7 down");
    loop.send(frame(1));
    CHECK(expect<Gone>(loop).error.message == "interface vcan7 is down");
  }
  loop.send(frame(2));
  CHECK(std::holds_alternative<DeadlineReached>(loop.next(loop.now() + 100ms)));
}
