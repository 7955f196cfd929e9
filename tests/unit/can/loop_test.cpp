#include "blactl/can/loop.hpp"

#include "catch.hpp"
#include "fake_bus.hpp"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <memory>
#include <string>

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;
using test::FakeBus;
using test::Wire;

namespace {

Frame frame(std::uint8_t number) {
  return {.id = 0x1001557F, .size = 1, .data = {number}};
}

/// A loop on a bus that the test writes.
struct Rig {
  Wire wire;
  Loop loop{std::make_unique<FakeBus>(wire)};

  void send(std::uint8_t first, std::uint8_t last) {
    for (std::uint8_t i = first; i <= last; ++i) {
      loop.send(frame(i));
    }
  }

  /// Takes what happens within `time`; how many events of this kind there were.
  template <class Wanted> std::size_t count(Duration time) {
    const Time end = wire.now + time;
    std::size_t found = 0;
    for (;;) {
      const Event event = loop.next(end);
      if (std::holds_alternative<DeadlineReached>(event)) {
        return found;
      }
      found += std::holds_alternative<Wanted>(event) ? 1U : 0U;
    }
  }
};

/// Both ends of a pipe.
struct Pipe {
  Pipe() { REQUIRE(pipe(ends.data()) == 0); }

  ~Pipe() {
    close_writer();
    close(ends[0]);
  }

  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void write(const std::string& text) const {
    REQUIRE(::write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size()));
  }

  void close_writer() {
    if (ends[1] >= 0) {
      close(ends[1]);
      ends[1] = -1;
    }
  }

  [[nodiscard]] int reader() const { return ends[0]; }

  std::array<int, 2> ends{};
};

int signal_number(const Event& event) {
  const auto* signal = std::get_if<Signal>(&event);
  return signal != nullptr ? signal->number : 0;
}

int ready_descriptor(const Event& event) {
  const auto* ready = std::get_if<Ready>(&event);
  return ready != nullptr ? ready->descriptor : -1;
}

} // namespace

TEST_CASE("the loop waits until the deadline, and time passes meanwhile") {
  Rig rig;
  const Time end = rig.wire.now + 1s;
  CHECK(std::holds_alternative<DeadlineReached>(rig.loop.next(end)));
  CHECK(rig.loop.now() == end);
  CHECK(std::holds_alternative<DeadlineReached>(rig.loop.next(end)));
  CHECK(rig.loop.now() == end);
}

TEST_CASE("what happens on the bus comes before a deadline that has passed") {
  Rig rig;
  rig.wire.hear(frame(1));
  const Event event = rig.loop.next(rig.wire.now - 1s);
  REQUIRE(std::holds_alternative<Received>(event));
  CHECK(std::get<Received>(event).frame == frame(1));
  CHECK(std::holds_alternative<DeadlineReached>(rig.loop.next(rig.wire.now - 1s)));
}

TEST_CASE("frames leave in order, each is echoed") {
  Rig rig;
  rig.send(1, 20);
  CHECK(rig.count<Sent>(1s) == 20);
  CHECK(rig.loop.unsent() == 0);
  REQUIRE(rig.wire.sent.size() == 20);
  for (std::uint8_t i = 1; i <= 20; ++i) {
    CHECK(rig.wire.sent[i - 1U] == frame(i));
  }
}

TEST_CASE("until something is heard one frame probes the bus, and the others stay here") {
  Rig rig;
  rig.wire.echo = Wire::Echo::by_hand;
  rig.send(1, 10);
  CHECK(rig.count<Sent>(10s) == 0);
  CHECK(rig.wire.sent.size() == 1);
  CHECK(rig.loop.unsent() == 10);
  rig.loop.drop_queue();
  CHECK(rig.loop.unsent() == 1); // the kernel has it and may still send it
}

TEST_CASE("after the first echo three frames are on their way, never more") {
  Rig rig;
  rig.wire.echo = Wire::Echo::by_hand;
  rig.send(1, 10);
  rig.wire.acknowledge(frame(1));
  CHECK(rig.count<Sent>(1s) == 1);
  CHECK(rig.wire.sent.size() == 4);
  rig.wire.acknowledge(frame(3)); // a controller may send in another order
  CHECK(rig.count<Sent>(1s) == 1);
  CHECK(rig.wire.sent.size() == 5);
  CHECK(rig.loop.unsent() == 8);
}

TEST_CASE("a frame of another node opens the window as well as an echo") {
  Rig rig;
  rig.wire.echo = Wire::Echo::by_hand;
  rig.send(1, 10);
  rig.wire.hear(frame(99));
  CHECK(rig.count<Received>(1s) == 1);
  CHECK(rig.wire.sent.size() == 3);
}

TEST_CASE("an echo that belongs to none of our frames opens no place") {
  Rig rig;
  rig.wire.echo = Wire::Echo::by_hand;
  rig.send(1, 10);
  rig.wire.acknowledge(frame(99));
  CHECK(rig.count<Sent>(1s) == 1);
  CHECK(rig.wire.sent.size() == 3);
  CHECK(rig.loop.unsent() == 10);
}

TEST_CASE("a bus without echoes tells of each frame at once") {
  Rig rig;
  rig.wire.echo = Wire::Echo::absent;
  rig.send(1, 10);
  CHECK(rig.wire.sent.size() == 10);
  CHECK(rig.loop.unsent() == 0);
  CHECK_FALSE(rig.loop.unacknowledged_since());
  CHECK(rig.count<Sent>(0s) == 10);
}

TEST_CASE("a full queue of the kernel is waited out, and nothing is lost or sent twice") {
  Rig rig;
  rig.wire.full = 50;
  const Time begin = rig.wire.now;
  rig.send(1, 5);
  CHECK(rig.wire.sent.empty());
  CHECK(rig.loop.unsent() == 5);
  CHECK_FALSE(rig.loop.unacknowledged_since()); // nothing of ours is on its way
  std::size_t echoes = 0;
  while (echoes < 5) {
    echoes += std::holds_alternative<Sent>(rig.loop.next(begin + 10s)) ? 1U : 0U;
    REQUIRE(rig.wire.now < begin + 10s);
  }
  CHECK(rig.wire.now - begin >= 20ms); // it did not spin
  CHECK(rig.wire.now - begin <= 200ms);
  REQUIRE(rig.wire.sent.size() == 5);
  CHECK(rig.wire.sent[4] == frame(5));
}

TEST_CASE("a bus that is not open yet is left alone, and gets what waits as soon as it is") {
  Rig rig;
  rig.wire.open = false;
  rig.send(1, 3);
  CHECK(rig.count<Sent>(1s) == 0);
  CHECK(rig.wire.tries == 3); // once for each send(), not again and again
  CHECK(rig.loop.unsent() == 3);
  rig.wire.happen(Opened{"noted"}, 1s);
  const Event event = rig.loop.next(never);
  REQUIRE(std::holds_alternative<Opened>(event));
  CHECK(std::get<Opened>(event).note == "noted");
  CHECK(rig.count<Sent>(1s) == 3);
  CHECK(rig.loop.unsent() == 0);
}

TEST_CASE("unacknowledged_since tells since when a frame waits on a silent bus") {
  Rig rig;
  rig.wire.echo = Wire::Echo::by_hand;
  CHECK_FALSE(rig.loop.unacknowledged_since());
  rig.wire.now += 5s;
  const Time begin = rig.wire.now;
  rig.send(1, 2);
  CHECK(rig.loop.unacknowledged_since() == begin);
  rig.wire.hear(frame(99), 3s);
  CHECK(rig.count<Received>(4s) == 1);
  CHECK(rig.loop.unacknowledged_since() == begin + 3s); // somebody is there
  rig.wire.acknowledge(frame(1));
  rig.wire.acknowledge(frame(2));
  CHECK(rig.count<Sent>(1s) == 2);
  CHECK_FALSE(rig.loop.unacknowledged_since());
}

TEST_CASE("echoes that the kernel dropped do not stop the sending for ever") {
  Rig rig;
  rig.wire.echo = Wire::Echo::by_hand;
  rig.send(1, 10);
  rig.wire.acknowledge(frame(1));
  CHECK(rig.count<Sent>(1s) == 1);
  CHECK(rig.wire.sent.size() == 4); // 2, 3 and 4 are on their way
  rig.wire.happen(Overflow{300});   // their echoes were among what was lost
  CHECK(rig.count<Overflow>(1s) == 1);
  CHECK(rig.wire.sent.size() == 7);
  CHECK(rig.loop.unsent() == 6);
}

TEST_CASE("a controller that went bus-off has forgotten the frames it had") {
  Rig rig;
  rig.wire.echo = Wire::Echo::by_hand;
  rig.send(1, 10);
  rig.wire.acknowledge(frame(1));
  CHECK(rig.count<Sent>(1s) == 1);
  rig.wire.happen(BusFault{FaultKind::bus_off, rig.wire.now});
  CHECK(rig.count<BusFault>(1s) == 1);
  CHECK(rig.wire.sent.size() == 7);
}

TEST_CASE("an interface that is away has forgotten the frames it had, and comes back") {
  Rig rig;
  rig.wire.echo = Wire::Echo::by_hand;
  rig.send(1, 3);
  CHECK(rig.loop.unacknowledged_since());
  rig.wire.happen(Away{{Code::interface, "unplugged"}});
  CHECK(std::holds_alternative<Away>(rig.loop.next(never)));
  rig.wire.happen(Back{});
  CHECK(std::holds_alternative<Back>(rig.loop.next(never)));
  CHECK(rig.wire.sent.size() >= 2);
}

TEST_CASE("faults, overflows and frames come as they are, in order") {
  Rig rig;
  rig.wire.happen(BusFault{FaultKind::error_passive, rig.wire.now});
  rig.wire.happen(Overflow{7});
  rig.wire.hear(frame(1));
  const auto fault = rig.loop.next(never);
  REQUIRE(std::holds_alternative<BusFault>(fault));
  CHECK(std::get<BusFault>(fault).kind == FaultKind::error_passive);
  const auto overflow = rig.loop.next(never);
  REQUIRE(std::holds_alternative<Overflow>(overflow));
  CHECK(std::get<Overflow>(overflow).lost == 7);
  CHECK(std::holds_alternative<Received>(rig.loop.next(never)));
}

TEST_CASE("a bus that goes is told once, and is left alone from then on") {
  Rig rig;
  rig.wire.happen(Gone{{Code::interface, "unplugged"}});
  rig.wire.hear(frame(1), 1ms);
  CHECK(std::holds_alternative<Gone>(rig.loop.next(never)));
  rig.wire.now += 1s;
  CHECK(std::holds_alternative<DeadlineReached>(rig.loop.next(rig.wire.now)));
  rig.loop.send(frame(2));
  CHECK(std::holds_alternative<DeadlineReached>(rig.loop.next(rig.wire.now)));
  CHECK(rig.wire.sent.empty());
  CHECK(rig.wire.receives_after_gone == 0);
}

TEST_CASE("a bus that refuses a frame is gone") {
  Rig rig;
  rig.wire.error = Error{Code::permission, "no"};
  rig.send(1, 3);
  const Event event = rig.loop.next(never);
  REQUIRE(std::holds_alternative<Gone>(event));
  CHECK(std::get<Gone>(event).error.code == Code::permission);
  CHECK(std::holds_alternative<DeadlineReached>(rig.loop.next(rig.wire.now)));
}

TEST_CASE("SIGINT, SIGTERM, SIGHUP and SIGWINCH are events, and come before the bus") {
  Rig rig;
  for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGWINCH}) {
    rig.wire.hear(frame(1));
    REQUIRE(raise(number) == 0);
    CHECK(signal_number(rig.loop.next(never)) == number);
    CHECK(std::holds_alternative<Received>(rig.loop.next(never)));
  }
}

TEST_CASE("who was told by nohup to live on without a terminal does so") {
  const auto before = signal(SIGHUP, SIG_IGN);
  sigset_t hangup;
  sigemptyset(&hangup);
  sigaddset(&hangup, SIGHUP);
  sigprocmask(SIG_UNBLOCK, &hangup, nullptr); // a loop before this one has blocked it
  Rig rig;
  REQUIRE(raise(SIGHUP) == 0);
  CHECK(std::holds_alternative<DeadlineReached>(rig.loop.next(rig.wire.now)));
  signal(SIGHUP, before);
}

TEST_CASE("a signal wakes the loop") {
  Loop loop(nullptr);
  const pid_t parent = getpid();
  const pid_t child = fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    usleep(20'000);
    kill(parent, SIGWINCH);
    _exit(0);
  }
  CHECK(signal_number(loop.next(loop.now() + 60s)) == SIGWINCH);
  waitpid(child, nullptr, 0);
}

TEST_CASE("writing to a pipe that nobody reads is an error of write(), not the end") {
  const Loop loop(nullptr);
  Pipe pipe;
  close(pipe.ends[0]);
  const char byte = 'x';
  CHECK(write(pipe.ends[1], &byte, 1) == -1);
  CHECK(errno == EPIPE);
  pipe.ends[0] = dup(pipe.ends[1]);
}

TEST_CASE("a watched descriptor is ready while it can be read, and when it is closed") {
  Loop loop(nullptr);
  Pipe pipe;
  loop.watch(pipe.reader());
  CHECK(std::holds_alternative<DeadlineReached>(loop.next(loop.now())));
  pipe.write("y");
  CHECK(ready_descriptor(loop.next(never)) == pipe.reader());
  CHECK(ready_descriptor(loop.next(never)) == pipe.reader()); // nobody has read it
  char byte = 0;
  REQUIRE(read(pipe.reader(), &byte, 1) == 1);
  CHECK(std::holds_alternative<DeadlineReached>(loop.next(loop.now() + 1ms)));
  pipe.close_writer();
  CHECK(ready_descriptor(loop.next(never)) == pipe.reader());
  loop.unwatch(pipe.reader());
  CHECK(std::holds_alternative<DeadlineReached>(loop.next(loop.now() + 1ms)));
}

TEST_CASE("a busy descriptor does not starve another one") {
  Loop loop(nullptr);
  const Pipe one;
  const Pipe other;
  loop.watch(one.reader());
  loop.watch(other.reader());
  one.write("x");
  other.write("x");
  const int first = ready_descriptor(loop.next(never));
  const int second = ready_descriptor(loop.next(never));
  CHECK(first != second);
}

TEST_CASE("descriptors are watched beside a bus") {
  Rig rig;
  const Pipe pipe;
  rig.loop.watch(pipe.reader());
  pipe.write("x");
  rig.wire.hear(frame(1));
  CHECK(std::holds_alternative<Received>(rig.loop.next(rig.wire.now + 1s)));
  CHECK(ready_descriptor(rig.loop.next(rig.wire.now + 1s)) == pipe.reader());
}

TEST_CASE("without a bus the loop has the time of the machine") {
  const Loop loop(nullptr);
  const Time before = loop.now();
  CHECK(loop.now() >= before);
  CHECK(loop.wall() > WallTime(std::chrono::sys_days(std::chrono::year(2020) / 1 / 1)));
}

TEST_CASE(
    "frames that waited while the process stood still have no times, unless the bus has some") {
  const bool stamps = GENERATE(false, true);
  const bool stood_in_wait = GENERATE(false, true);
  INFO(stamps << stood_in_wait);
  Rig rig;
  rig.wire.stamps = stamps;
  const auto is_timed = [&] {
    rig.wire.hear(frame(1));
    const Event event = rig.loop.next(rig.wire.now + 1s);
    REQUIRE(std::holds_alternative<Received>(event));
    return std::get<Received>(event).is_timed;
  };
  CHECK(is_timed());
  if (stood_in_wait) {
    rig.wire.oversleep = 4s;
    CHECK(std::holds_alternative<DeadlineReached>(rig.loop.next(rig.wire.now + 100ms)));
  } else {
    rig.wire.now += 4s;
  }
  CHECK(is_timed() == stamps);
  CHECK(std::holds_alternative<DeadlineReached>(rig.loop.next(rig.wire.now + 5s))); // silence
  CHECK(is_timed());
}
