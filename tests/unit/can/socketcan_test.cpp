#include "blactl/can/socketcan.hpp"

#include "can/kernel_frame.hpp"
#include "catch.hpp"

#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;

namespace {

using Kinds = std::vector<FaultKind>;

struct ErrorFrame : can_frame {
  explicit ErrorFrame(std::uint32_t classes) : can_frame{} {
    can_id = CAN_ERR_FLAG | classes;
    len = CAN_ERR_DLC;
  }

  ErrorFrame& byte(std::size_t at, unsigned value) {
    data[at] = static_cast<std::uint8_t>(value);
    return *this;
  }
};

/// Whether a raw socket with these filters gets a frame with this ID (linux/can.h).
bool passes(const std::vector<can_filter>& filters, std::uint32_t kernel_id) {
  for (const can_filter& filter : filters) {
    if ((kernel_id & filter.can_mask) == (filter.can_id & filter.can_mask)) {
      return true;
    }
  }
  return false;
}

/// What socket() says about CAN in the kernel that runs this test; 0: it has CAN.
int can_of_this_kernel() {
  const int descriptor = ::socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
  if (descriptor < 0) {
    return errno;
  }
  close(descriptor);
  return 0;
}

Time at(Duration since_boot) {
  return Time(since_boot);
}

} // namespace

TEST_CASE("an error frame of each class tells its fault") {
  CHECK(faults(ErrorFrame(CAN_ERR_BUSOFF)) == Kinds{FaultKind::bus_off});
  CHECK(faults(ErrorFrame(CAN_ERR_TX_TIMEOUT)) == Kinds{FaultKind::transmit_timeout});
  CHECK(faults(ErrorFrame(CAN_ERR_ACK)) == Kinds{FaultKind::no_acknowledge});
  CHECK(faults(ErrorFrame(CAN_ERR_RESTARTED)) == Kinds{FaultKind::restarted});
  CHECK(faults(ErrorFrame(CAN_ERR_PROT).byte(2, CAN_ERR_PROT_STUFF)) == Kinds{FaultKind::protocol});
  CHECK(faults(ErrorFrame(CAN_ERR_BUSERROR)) == Kinds{FaultKind::protocol});
}

TEST_CASE("an error frame of the controller tells its worst state only") {
  const auto controller = [](unsigned bits) {
    return faults(ErrorFrame(CAN_ERR_CRTL).byte(1, bits));
  };
  CHECK(controller(CAN_ERR_CRTL_RX_OVERFLOW) == Kinds{FaultKind::receive_overflow});
  CHECK(controller(CAN_ERR_CRTL_TX_WARNING) == Kinds{FaultKind::error_warning});
  CHECK(controller(CAN_ERR_CRTL_RX_WARNING) == Kinds{FaultKind::error_warning});
  CHECK(controller(CAN_ERR_CRTL_TX_PASSIVE) == Kinds{FaultKind::error_passive});
  CHECK(controller(CAN_ERR_CRTL_RX_PASSIVE) == Kinds{FaultKind::error_passive});
  CHECK(controller(CAN_ERR_CRTL_ACTIVE) == Kinds{FaultKind::error_active});
  CHECK(controller(CAN_ERR_CRTL_TX_WARNING | CAN_ERR_CRTL_TX_PASSIVE) ==
        Kinds{FaultKind::error_passive});
  CHECK(controller(CAN_ERR_CRTL_RX_OVERFLOW | CAN_ERR_CRTL_RX_WARNING) ==
        Kinds{FaultKind::receive_overflow, FaultKind::error_warning});
}

TEST_CASE("a missing acknowledgement is told whichever way the driver reports it") {
  CHECK(faults(ErrorFrame(CAN_ERR_PROT | CAN_ERR_BUSERROR).byte(3, CAN_ERR_PROT_LOC_ACK)) ==
        Kinds{FaultKind::no_acknowledge});
  CHECK(faults(ErrorFrame(CAN_ERR_ACK | CAN_ERR_CRTL).byte(1, CAN_ERR_CRTL_TX_PASSIVE)) ==
        Kinds{FaultKind::no_acknowledge, FaultKind::error_passive});
  // Both ways at once are one missing acknowledgement.
  CHECK(faults(ErrorFrame(CAN_ERR_ACK | CAN_ERR_PROT).byte(3, CAN_ERR_PROT_LOC_ACK)) ==
        Kinds{FaultKind::no_acknowledge});
}

TEST_CASE("the return to error-active is told whichever way the driver reports it") {
  CHECK(faults(ErrorFrame(CAN_ERR_PROT).byte(2, CAN_ERR_PROT_ACTIVE)) ==
        Kinds{FaultKind::error_active});
}

TEST_CASE("lost arbitration, counters and details without their class are no faults") {
  CHECK(faults(ErrorFrame(CAN_ERR_LOSTARB).byte(0, 5)).empty());
  CHECK(faults(ErrorFrame(CAN_ERR_CNT).byte(6, 100).byte(7, 3)).empty());
  CHECK(faults(ErrorFrame(CAN_ERR_LOSTARB).byte(1, CAN_ERR_CRTL_TX_PASSIVE)).empty());
  CHECK(faults(ErrorFrame(CAN_ERR_CRTL)).empty());
}

TEST_CASE("several faults in one error frame are told with the gravest first") {
  CHECK(faults(ErrorFrame(CAN_ERR_RESTARTED | CAN_ERR_CRTL | CAN_ERR_BUSOFF)
                   .byte(1, CAN_ERR_CRTL_TX_PASSIVE)) ==
        Kinds{FaultKind::bus_off, FaultKind::error_passive, FaultKind::restarted});
}

TEST_CASE("frames survive the way to the kernel and back") {
  const Frame extended{.id = 0x1401'552A, .size = 3, .data = {0xD2, 0x04, 0xC0}};
  const Frame standard{.id = 0x7FF, .extended = false, .size = 0};
  const Frame remote{.id = 0x1FFF'FFFF, .remote = true, .size = 8};
  CHECK(to_kernel(extended).can_id == 0x9401'552A);
  CHECK(to_kernel(extended).len == 3);
  CHECK(to_kernel(standard).can_id == 0x7FF);
  CHECK(to_kernel(remote).can_id == 0xDFFF'FFFF);
  CHECK(from_kernel(to_kernel(extended)) == extended);
  CHECK(from_kernel(to_kernel(standard)) == standard);
  CHECK(from_kernel(to_kernel(remote)) == remote);
}

TEST_CASE("an impossible length in a frame is cut to eight bytes") {
  can_frame raw{};
  raw.can_id = CAN_EFF_FLAG | 1;
  raw.len = 200;
  CHECK(from_kernel(raw).size == 8);
  CHECK(to_kernel(Frame{.id = 1, .size = 200}).len == 8);
}

TEST_CASE("a filter passes extended data frames that agree with it, and nothing else") {
  const Filter status{.id = 0x0003'F200, .mask = 0x00FF'FF80};
  const auto filters = kernel_filters({&status, 1}, std::nullopt);
  REQUIRE(filters.size() == 1);
  CHECK(filters[0].can_id == 0x8003'F200);
  CHECK(filters[0].can_mask == 0xC0FF'FF80);
  CHECK(passes(filters, CAN_EFF_FLAG | 0x1803'F20A));
  CHECK_FALSE(passes(filters, CAN_EFF_FLAG | 0x1803'F30A));
  CHECK_FALSE(passes(filters, CAN_EFF_FLAG | CAN_RTR_FLAG | 0x1803'F20A));

  const Filter anything{.id = 0, .mask = 0};
  CHECK(passes(kernel_filters({&anything, 1}, std::nullopt), CAN_EFF_FLAG | 7));
  CHECK_FALSE(passes(kernel_filters({&anything, 1}, std::nullopt), 7)); // a standard frame
}

TEST_CASE("no filters pass everything, standard and remote frames too") {
  const auto filters = kernel_filters({}, Filter{1, extended_id_mask});
  CHECK(passes(filters, CAN_EFF_FLAG | 0x1803'F20A));
  CHECK(passes(filters, 0x7FF));
  CHECK(passes(filters, CAN_RTR_FLAG | 0x7FF));
}

TEST_CASE("more filters than a socket takes pass everything") {
  const std::vector<Filter> most(CAN_RAW_FILTER_MAX - 1, Filter{1, extended_id_mask});
  CHECK_FALSE(passes(kernel_filters(most, Filter{1, extended_id_mask}), CAN_EFF_FLAG | 2));
  const std::vector<Filter> too_many(CAN_RAW_FILTER_MAX, Filter{1, extended_id_mask});
  CHECK(passes(kernel_filters(too_many, Filter{1, extended_id_mask}), CAN_EFF_FLAG | 2));
}

TEST_CASE("echoes pass beside the filters, and one filter learns what they have in common") {
  const Filter answers{.id = 0x0000'7F80, .mask = 0x0000'7F80};
  std::optional<Filter> echoes;
  CHECK(widen(echoes, 0x1E01'8AFF)); // a request of node 127 to node 10
  CHECK_FALSE(widen(echoes, 0x1E01'8AFF));
  CHECK(widen(echoes, 0x1E01'8BFF)); // and to node 11
  const auto filters = kernel_filters({&answers, 1}, echoes);
  CHECK(passes(filters, CAN_EFF_FLAG | 0x1E01'8AFF));
  CHECK(passes(filters, CAN_EFF_FLAG | 0x1E01'8BFF));
  CHECK_FALSE(passes(filters, CAN_EFF_FLAG | 0x1E01'8AFE)); // of node 126
}

TEST_CASE("the time stamp of a frame moves to the bus clock") {
  const WallTime noon(1'800'000'000s);
  CHECK(bus_time(noon - 300us, at(50s), noon, at(0s)) == at(50s - 300us));
}

TEST_CASE("a wall clock that somebody sets leaves frames in order and in the past") {
  const WallTime noon(1'800'000'000s);
  CHECK(bus_time(noon + 1h, at(50s), noon, at(49s)) == at(50s));
  CHECK(bus_time(noon - 1h, at(50s), noon, at(49s)) == at(49s));
}

TEST_CASE("opening an interface that cannot be opened says why and what to do") {
  const auto bus = SocketCan::open("no\x1b[2Jcan");
  REQUIRE_FALSE(bus.has_value());
  const Error& error = bus.error();
  CAPTURE(error.message, error.hint);
  CHECK(error.message.find("no\\x1b[2Jcan") != std::string::npos);
  CHECK_FALSE(error.hint.empty());
  switch (can_of_this_kernel()) {
  case 0:
    CHECK(error.code == Code::interface);
    CHECK(error.message.starts_with("there is no interface"));
    break;
  case EPERM:
  case EACCES: CHECK(error.code == Code::permission); break;
  default:
    CHECK(error.code == Code::interface);
    CHECK(error.message.starts_with("this kernel has no CAN"));
    CHECK(error.hint.find("sudo modprobe can_raw") != std::string::npos);
    CHECK(error.hint.find("-i sim:") != std::string::npos);
    break;
  }
}
