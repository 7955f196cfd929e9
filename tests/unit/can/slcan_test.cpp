#include "blactl/can/loop.hpp"
#include "blactl/can/slcan.hpp"

#include "catch.hpp"
#include "slcan_adapter.hpp"

#include <algorithm>
#include <chrono>
#include <string>
#include <vector>

using namespace blactl;
using namespace blactl::can;
using namespace std::chrono_literals;
using Lines = std::vector<std::string>;
using test::Dialect;
using test::SlcanAdapter;

namespace {

Frame frame(std::uint8_t number) {
  return {.id = 0x1001557F, .size = 1, .data = {number}};
}

std::string line(std::uint8_t number) {
  return fmt::format("T1001557F1{:02X}", number);
}

std::unique_ptr<Bus> open(const SlcanAdapter& adapter, const SlcanOptions& options = {}) {
  auto bus = Slcan::open(adapter.path(), "slcan:test", options);
  if (!bus) {
    throw std::runtime_error(bus.error().message);
  }
  return std::move(*bus);
}

/// A loop on an adapter.
struct Rig {
  explicit Rig(Dialect dialect, const SlcanOptions& options = {})
      : adapter(std::move(dialect)), loop(open(adapter, options)) {}

  /// The next event of this kind; throws when it does not come.
  template <class Wanted> Wanted expect() {
    const Time end = loop.now() + 20s;
    for (;;) {
      const Event event = loop.next(end);
      if (const auto* wanted = std::get_if<Wanted>(&event)) {
        return *wanted;
      }
      if (std::holds_alternative<DeadlineReached>(event)) {
        throw std::runtime_error("it did not happen");
      }
    }
  }

  /// How many events of this kind there are within `time`.
  template <class Wanted> std::size_t count(Duration time) {
    const Time end = loop.now() + time;
    std::size_t found = 0;
    for (;;) {
      const Event event = loop.next(end);
      if (std::holds_alternative<DeadlineReached>(event)) {
        return found;
      }
      found += std::holds_alternative<Wanted>(event) ? 1U : 0U;
    }
  }

  /// Waits until the adapter has got so many lines, and gives them.
  Lines lines(std::size_t count) {
    adapter.wait_for([&](const Lines& lines) { return lines.size() >= count; });
    return adapter.lines();
  }

  SlcanAdapter adapter;
  Loop loop;
};

const Lines full{"", "C", "S8", "O"};

Slcan& adapter_of(Rig& rig) {
  return dynamic_cast<Slcan&>(rig.loop.bus());
}

} // namespace

TEST_CASE("slcan: every dialect is opened, sent to and heard") {
  for (const Dialect& dialect : {test::lawicel(), test::canable(), test::ardupilot(),
                                 test::starter_kit(), test::fixed_rate(), test::noisy()}) {
    Rig rig(dialect);
    std::ignore = rig.expect<Opened>();
    CHECK(rig.loop.bus().is_open());
    CHECK(rig.lines(4) == full);
    rig.loop.send(frame(1));
    rig.loop.send(frame(2));
    std::ignore = rig.expect<Sent>();
    std::ignore = rig.expect<Sent>();
    const Lines lines = rig.lines(6);
    CHECK(lines[4] == line(1));
    CHECK(lines[5] == line(2));
    const Time before = rig.loop.now();
    rig.adapter.say("T1001557F107" + dialect.trailer + "\r");
    const auto received = rig.expect<Received>();
    CHECK(received.frame == frame(7));
    CHECK(received.at >= before);
    CHECK(received.at <= rig.loop.now());
  }
}

TEST_CASE("slcan: open=plain sends O alone, as the vendor's program does, and waits for nothing") {
  Rig rig(test::starter_kit(), {.opening = SlcanOpening::plain});
  CHECK(rig.loop.bus().is_open());
  rig.loop.send(frame(1));
  CHECK(rig.lines(2) == Lines{"O", line(1)});
}

TEST_CASE("slcan: ack=none does not wait either") {
  Rig rig(test::canable(), {.await_answers = false});
  CHECK(rig.loop.bus().is_open());
  CHECK(rig.lines(4) == full);
}

TEST_CASE("slcan: an adapter that answers is asked what it is, before it is opened") {
  for (const Dialect& dialect : {test::lawicel(), test::fixed_rate()}) {
    Rig rig(dialect, {.inquires = true});
    std::ignore = rig.expect<Opened>();
    CHECK(rig.lines(6) == Lines{"", "C", "V", "N", "S8", "O"});
    const bool tells = dialect.to_version != "\a";
    CHECK(adapter_of(rig).answers().version == (tells ? "1013" : ""));
    CHECK(adapter_of(rig).answers().serial_number == (tells ? "A123" : ""));
    rig.adapter.say("T1001557F107\r");
    CHECK(rig.expect<Received>().frame == frame(7));
  }
}

TEST_CASE("slcan: an adapter that answers nothing is not asked, nor one that is opened plainly") {
  Rig mute(test::canable(), {.inquires = true});
  std::ignore = mute.expect<Opened>();
  CHECK(mute.lines(4) == full);
  CHECK_FALSE(adapter_of(mute).ask_status());
  Rig plain(test::lawicel(), {.opening = SlcanOpening::plain, .inquires = true});
  CHECK(plain.lines(1) == Lines{"O"});
}

TEST_CASE("slcan: the status is asked for while it is open; a refusal refuses no frame") {
  Dialect passive = test::lawicel();
  passive.to_status = "F20\r";
  for (const Dialect& dialect : {passive, test::fixed_rate()}) {
    Rig rig(dialect);
    CHECK_FALSE(adapter_of(rig).ask_status()); // not open yet
    std::ignore = rig.expect<Opened>();
    CHECK(adapter_of(rig).ask_status());
    rig.loop.send(frame(1));
    std::ignore = rig.expect<Sent>();
    CHECK(rig.count<BusFault>(300ms) == 0);
    const auto status = adapter_of(rig).answers().status;
    CHECK(status == (dialect.to_status == "\a" ? std::nullopt : std::optional(std::uint8_t{0x20})));
  }
}

TEST_CASE("slcan: MAVLink and text are heard as such, another baud rate as nothing known") {
  const std::vector<std::pair<Dialect, ForeignSpeech>> cases{
      {test::telemetry(), ForeignSpeech::mavlink},
      {test::satellite_receiver(), ForeignSpeech::text},
      {test::wrong_baud(), ForeignSpeech::none}};
  for (const auto& [dialect, speech] : cases) {
    Rig rig(dialect);
    const auto gone = rig.expect<Gone>();
    CHECK(adapter_of(rig).speech() == speech);
    CHECK((gone.error.message.find("MAVLink") != std::string::npos) ==
          (speech == ForeignSpeech::mavlink));
  }
  Rig slcan(test::lawicel());
  std::ignore = slcan.expect<Opened>();
  CHECK(adapter_of(slcan).speech() == ForeignSpeech::none);
}

TEST_CASE("slcan: frames wait until the channel is open, and leave then") {
  Rig rig(test::canable());
  rig.loop.send(frame(1));
  CHECK(rig.loop.unsent() == 1);
  CHECK_FALSE(rig.loop.bus().is_open());
  std::ignore = rig.expect<Sent>();
  CHECK(rig.lines(5).back() == line(1));
}

TEST_CASE("slcan: an adapter that does not know S8 is used at its own rate, which is told") {
  Rig fixed(test::fixed_rate());
  CHECK(fixed.expect<Opened>().note.find("refused") != std::string::npos);
  Rig usual(test::lawicel());
  CHECK(usual.expect<Opened>().note.empty());
}

TEST_CASE("slcan: an adapter that refuses rate and channel is an error with a way out") {
  Rig rig(test::stubborn());
  const auto gone = rig.expect<Gone>();
  CHECK(gone.error.code == Code::interface);
  CHECK(gone.error.message.find(rig.adapter.path()) != std::string::npos);
  CHECK(gone.error.hint.find("open=plain") != std::string::npos);
}

TEST_CASE("slcan: a channel that is open already is used") {
  Dialect dialect = test::lawicel();
  dialect.to_open = "\a";
  Rig rig(dialect);
  CHECK(rig.expect<Opened>().note.empty());
}

TEST_CASE("slcan: frames of a channel that was left open are not heard before it is ours") {
  Dialect dialect = test::lawicel();
  dialect.greeting = "T1001557F101\rT1001557F102\r";
  Rig rig(dialect);
  std::ignore = rig.expect<Opened>();
  rig.adapter.say("T1001557F103\r");
  CHECK(rig.expect<Received>().frame == frame(3));
}

TEST_CASE("slcan: an adapter that answers frames gets a few at a time") {
  Dialect dialect = test::lawicel();
  Rig rig(dialect);
  std::ignore = rig.expect<Opened>();
  for (std::uint8_t i = 0; i < 100; ++i) {
    rig.loop.send(frame(i));
  }
  for (int i = 0; i < 100; ++i) {
    std::ignore = rig.expect<Sent>();
  }
  CHECK(rig.loop.unsent() == 0);
  const Lines lines = rig.lines(104);
  for (std::uint8_t i = 0; i < 100; ++i) {
    CHECK(lines[4U + i] == line(i));
  }
}

TEST_CASE("slcan: answers that stop coming do not stop the sending for ever") {
  Rig rig([] {
    Dialect dialect = test::lawicel();
    dialect.to_frame = "";
    return dialect;
  }());
  std::ignore = rig.expect<Opened>();
  rig.loop.send(frame(0));
  std::ignore = rig.lines(5);
  rig.adapter.say("Z\rT1001557F101\r"); // this one frame is answered, and no other
  std::ignore = rig.expect<Received>();
  for (std::uint8_t i = 1; i < 50; ++i) {
    rig.loop.send(frame(i));
  }
  CHECK(rig.lines(5).size() < 54); // it did wait
  std::size_t sent = 0;
  while (sent < 49) {
    std::ignore = rig.expect<Sent>();
    ++sent;
  }
  CHECK(rig.lines(54).back() == line(49));
}

TEST_CASE("slcan: a frame that the adapter refuses is a fault of the bus, and the next one goes") {
  Dialect dialect = test::lawicel();
  dialect.to_frame = "\a";
  Rig rig(dialect);
  std::ignore = rig.expect<Opened>();
  rig.loop.send(frame(1));
  CHECK(rig.expect<BusFault>().kind == FaultKind::transmit_timeout);
  rig.loop.send(frame(2));
  CHECK(rig.expect<BusFault>().kind == FaultKind::transmit_timeout);
  CHECK(rig.lines(6).back() == line(2));
}

TEST_CASE("slcan: gap keeps frames apart") {
  Rig rig(test::starter_kit(), {.opening = SlcanOpening::plain, .gap = 20ms});
  const Time begin = rig.loop.now();
  for (std::uint8_t i = 0; i < 6; ++i) {
    rig.loop.send(frame(i));
  }
  for (int i = 0; i < 6; ++i) {
    std::ignore = rig.expect<Sent>();
  }
  CHECK(rig.loop.now() - begin >= 100ms);
}

TEST_CASE("slcan: a bus that only makes noise breaks nothing, and costs no memory") {
  Rig rig(test::lawicel());
  std::ignore = rig.expect<Opened>();
  for (int i = 0; i < 20; ++i) {
    rig.adapter.say(std::string(20'000, static_cast<char>(0x80 + i)) + "\r");
  }
  CHECK(rig.count<Received>(200ms) == 0);
  rig.adapter.say("\rT1001557F109\r");
  CHECK(rig.expect<Received>().frame == frame(9));
}

TEST_CASE("slcan: an adapter that is pulled out is told once, in the middle of a line too") {
  Rig rig(test::lawicel());
  std::ignore = rig.expect<Opened>();
  rig.adapter.say("T1001557");
  CHECK(rig.count<Received>(20ms) == 0);
  rig.adapter.unplug();
  const auto gone = rig.expect<Gone>();
  CHECK(gone.error.code == Code::interface);
  CHECK(gone.error.message.find(rig.adapter.path()) != std::string::npos);
  CHECK_FALSE(gone.error.hint.empty());
  CHECK(rig.count<Gone>(20ms) == 0);
}

TEST_CASE("slcan: the channel is closed at the end") {
  SlcanAdapter adapter(test::lawicel());
  {
    Loop loop(open(adapter));
    while (!loop.bus().is_open()) {
      std::ignore = loop.next(loop.now() + 10s);
    }
  }
  adapter.wait_for([](const Lines& lines) { return lines == Lines{"", "C", "S8", "O", "C"}; });
  Loop again(open(adapter)); // the port is free again
  while (!again.bus().is_open()) {
    std::ignore = again.next(again.now() + 10s);
  }
  CHECK(again.bus().is_open());
}

TEST_CASE("slcan: the loop does not spin while the adapter is silent") {
  Rig rig(test::canable());
  std::ignore = rig.expect<Opened>();
  rig.loop.send(frame(1));
  timespec before{};
  timespec after{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &before);
  CHECK(rig.count<Received>(500ms) == 0);
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &after);
  const auto used = std::chrono::seconds(after.tv_sec - before.tv_sec) +
                    std::chrono::nanoseconds(after.tv_nsec - before.tv_nsec);
  CHECK(used < 100ms);
}

TEST_CASE("slcan: an adapter that says what is no slcan is told, whatever opens it") {
  for (const Dialect& dialect : {test::wrong_baud(), test::garbled(), test::satellite_receiver()}) {
    Rig rig(dialect);
    const auto gone = rig.expect<Gone>();
    CHECK(gone.error.code == Code::interface);
    CHECK(gone.error.message.find("not slcan") != std::string::npos);
    CHECK(gone.error.hint.find("?baud=") != std::string::npos);
  }
  for (const Dialect& dialect : {test::wrong_baud(), test::satellite_receiver()}) {
    Rig rig(dialect, {.opening = SlcanOpening::plain});
    CHECK(rig.expect<Gone>().error.message.find("not slcan") != std::string::npos);
  }
}

TEST_CASE("slcan: noise before the channel is open is forgiven") {
  Rig rig(test::noisy());
  std::ignore = rig.expect<Opened>();
  rig.adapter.say("T1001557F101\r");
  std::ignore = rig.expect<Received>();
  CHECK_FALSE(rig.loop.bus().silence());
}

TEST_CASE("slcan: an adapter that takes no frame at all is told, and why") {
  const std::vector<std::pair<Dialect, std::string>> cases{
      {test::closed(), "refuses to open"},
      {test::listening(), "refuses to send: frames refused 3"}};
  for (const auto& [dialect, message] : cases) {
    Rig rig(dialect);
    std::ignore = rig.expect<Opened>();
    for (std::uint8_t i = 0; i < 3; ++i) {
      rig.loop.send(frame(i));
    }
    const auto gone = rig.expect<Gone>();
    CHECK(gone.error.code == Code::interface);
    CHECK(gone.error.message.find(message) != std::string::npos);
    CHECK(gone.error.hint.find("?open=plain") != std::string::npos);
  }
}

TEST_CASE("slcan: what was heard, or refused, is known when nobody was heard") {
  Rig silent(test::canable());
  std::ignore = silent.expect<Opened>();
  CHECK(silent.loop.bus().silence()->code == Code::not_found);
  Rig closed(test::closed());
  std::ignore = closed.expect<Opened>();
  CHECK(closed.loop.bus().silence()->code == Code::interface);
  Rig fine(test::lawicel());
  std::ignore = fine.expect<Opened>();
  CHECK_FALSE(fine.loop.bus().silence());
}
