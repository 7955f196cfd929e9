#include "blactl/dronecan/allocator.hpp"
#include "blactl/sim/servo/allocatee.hpp"

#include "catch.hpp"
#include "support.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::dronecan;
using namespace blactl::dronecan::test;

namespace {

/// A unique ID of which every byte tells the unit and its place.
constexpr UniqueId unit(std::uint8_t number) {
  UniqueId unique_id{};
  for (std::size_t i = 0; i < unique_id.size(); ++i) {
    unique_id[i] = static_cast<std::uint8_t>(number * 16 + i);
  }
  return unique_id;
}

/// Gives the units of a list their IDs, and writes down who was given one.
class Book final : public AllocationTable {
 public:
  [[nodiscard]] bool serves(Bytes prefix) const override {
    return std::ranges::any_of(ids, [&](const auto& entry) {
      return std::ranges::equal(Bytes(entry.first).first(prefix.size()), prefix);
    });
  }

  [[nodiscard]] std::optional<NodeId> assign(const UniqueId& unique_id, NodeId wish) override {
    assigned.push_back(unique_id);
    preferred = wish;
    const auto it = ids.find(unique_id);
    return it != ids.end() ? it->second : std::nullopt;
  }

  std::map<UniqueId, std::optional<NodeId>> ids;
  std::vector<UniqueId> assigned;
  NodeId preferred{};
};

/// An allocator on a bench: time is told by hand, its answers are decoded.
class Bench {
 public:
  explicit Bench(NodeId local = NodeId(127))
      : node(local, local.is_unicast() ? &ids_ : nullptr, {.name = "blactl"},
             {.send = [this](const can::Frame& frame) { frames_.push_back(frame); },
              .transfer = {},
              .error = {}}) {
    node.advance(now);
  }

  void pass(Duration duration) {
    now += duration;
    allocator.advance(now);
  }

  void hear(const Allocation& message, NodeId source = anonymous) {
    const Payload payload = message.encode();
    allocator.receive({.header = {.kind = Kind::message,
                                  .priority = 24,
                                  .data_type_id = Allocation::type.id,
                                  .source = source},
                       .payload = payload.bytes(),
                       .at = now});
    allocator.advance(now); // as a session does, as soon as a frame was taken
  }

  /// A part of a request (table 2-7): 0 the first six bytes, 1 the next six, 2 the last four.
  void ask(const UniqueId& unique_id, std::size_t part) { hear(request(unique_id, part)); }

  static Allocation request(const UniqueId& unique_id, std::size_t part) {
    Allocation request{.first_part_of_unique_id = part == 0,
                       .size = static_cast<std::uint8_t>(part < 2 ? 6 : 4)};
    std::copy_n(unique_id.begin() + static_cast<std::ptrdiff_t>(6 * part), request.size,
                request.unique_id.begin());
    return request;
  }

  /// The answers since the last call.
  std::vector<Allocation> answers() {
    Ear ear;
    for (const can::Frame& frame : std::exchange(frames_, {})) {
      ear.hear(frame);
    }
    REQUIRE(ear.errors.empty());
    std::vector<Allocation> all;
    for (const auto& heard : ear.heard) {
      REQUIRE(heard.header.data_type_id == Allocation::type.id);
      CHECK(heard.header.source == node.id());
      const auto answer = Allocation::decode(unhex(heard.payload));
      REQUIRE(answer);
      all.push_back(*answer);
    }
    return all;
  }

  /// The whole exchange at once; the ID that was given.
  std::optional<NodeId> allocate(const UniqueId& unique_id) {
    std::vector<Allocation> heard;
    for (std::size_t part = 0; part < 3; ++part) {
      ask(unique_id, part);
      pass(100ms); // of courtesy, if it is the first time
      for (const Allocation& answer : answers()) {
        heard.push_back(answer);
      }
    }
    if (heard.size() != 3 || heard.back().unique_id != unique_id) {
      return std::nullopt;
    }
    return NodeId(heard.back().node_id);
  }

  Time now = at(0ms);
  Book book;

 private:
  std::array<TransferIds::Slot, TransferIds::slots> table_{};
  TransferIds ids_{table_};
  std::vector<can::Frame> frames_;

 public:
  Node node;
  Allocator allocator{node, book};
};

/// The answer to the parts of the unique ID heard so far (table 2-8).
Allocation answer(const UniqueId& unique_id, std::uint8_t size, std::uint8_t node_id = 0) {
  Allocation answer{.node_id = node_id, .size = size};
  std::copy_n(unique_id.begin(), size, answer.unique_id.begin());
  return answer;
}

using Answers = std::vector<Allocation>;
using Lines = std::vector<std::string>;

constexpr UniqueId first = unit(1);
constexpr UniqueId second = unit(2);

} // namespace

TEST_CASE("an exchange has three parts, each answered with all that was heard so far",
          "[requirement-34][requirement-35]") {
  Bench bench;
  bench.book.ids[first] = NodeId(20);
  bench.ask(first, 0);
  bench.pass(100ms);
  CHECK(bench.answers() == Answers{answer(first, 6)});
  bench.pass(300ms);
  bench.ask(first, 1);
  CHECK(bench.answers() == Answers{answer(first, 12)});
  CHECK(bench.book.assigned.empty());
  bench.pass(400ms);
  bench.ask(first, 2);
  CHECK(bench.answers() == Answers{answer(first, 16, 20)});
  CHECK(bench.book.assigned == std::vector{first});
  CHECK(bench.allocator.next_deadline() == never);
}

TEST_CASE("the answers are these frames, of our own ID and in the order of the exchange") {
  std::vector<can::Frame> frames;
  std::array<TransferIds::Slot, TransferIds::slots> slots{};
  TransferIds ids(slots);
  Node node(NodeId(1), &ids, {},
            {.send = [&](const can::Frame& frame) { frames.push_back(frame); },
             .transfer = {},
             .error = {}});
  Book book;
  UniqueId unique_id{};
  std::ranges::copy(unhex("44C08B635E05F4BC1096DF11A8BA5447"), unique_id.begin());
  book.ids[unique_id] = NodeId(20);
  Allocator allocator(node, book);
  for (std::size_t part = 0; part < 3; ++part) {
    const Payload payload = Bench::request(unique_id, part).encode();
    allocator.receive({.header = {.data_type_id = Allocation::type.id},
                       .payload = payload.bytes(),
                       .at = at(part * 200ms)});
    allocator.advance(at(part * 200ms + 100ms));
  }
  // Specification 6, but for the priority (table 2-8) and the transfer IDs.
  CHECK(texts(frames) == Lines{"18000101#0044C08B635E05C0", "18000101#05B00044C08B6381",
                               "18000101#5E05F4BC1096DF21", "18000101#1141",
                               "18000101#E00D2844C08B6382", "18000101#5E05F4BC1096DF22",
                               "18000101#11A8BA544742"});
}

TEST_CASE("before its first answer it waits 100 ms, later no more") {
  Bench bench;
  bench.book.ids[first] = NodeId(20);
  bench.book.ids[second] = NodeId(21);
  bench.ask(first, 0);
  CHECK(bench.allocator.next_deadline() == bench.now + 100ms);
  bench.pass(99ms);
  CHECK(bench.answers().empty());
  bench.pass(1ms);
  CHECK(bench.answers().size() == 1);
  for (std::size_t part = 1; part < 3; ++part) {
    bench.ask(first, part);
    CHECK(bench.answers().size() == 1);
  }
  bench.pass(10s);
  bench.ask(second, 0);
  CHECK(bench.answers().size() == 1);
}

TEST_CASE("a servo may take all of its 400 ms after the first answer, which came late",
          "[requirement-38]") {
  Bench bench;
  bench.book.ids[first] = NodeId(20);
  bench.ask(first, 0);
  bench.pass(100ms);
  CHECK(bench.answers().size() == 1);
  bench.pass(401ms); // and a millisecond on the bus
  bench.ask(first, 1);
  CHECK(bench.answers() == Answers{answer(first, 12)});
}

TEST_CASE("another allocator that is heard makes this one silent for good") {
  Bench bench;
  bench.book.ids[first] = NodeId(20);
  SECTION("before the first request") {
    bench.hear(answer(second, 6), NodeId(5));
  }
  SECTION("in the 100 ms of courtesy") {
    bench.ask(first, 0);
    bench.pass(50ms);
    bench.hear(answer(first, 6), NodeId(5));
    CHECK(bench.allocator.next_deadline() == never);
  }
  SECTION("in the midst of an exchange") {
    bench.ask(first, 0);
    bench.pass(100ms);
    CHECK(bench.answers().size() == 1);
    bench.hear(answer(first, 6), NodeId(5));
  }
  bench.pass(100ms);
  CHECK(bench.answers().empty());
  CHECK(bench.allocator.other() == NodeId(5));
  CHECK_FALSE(bench.allocate(first));
  bench.pass(1h);
  CHECK_FALSE(bench.allocate(first));
  CHECK(bench.book.assigned.empty());
}

TEST_CASE("our own answer, heard again, is no other allocator") {
  Bench bench;
  bench.book.ids[first] = NodeId(20);
  bench.hear(answer(first, 6), NodeId(127));
  CHECK_FALSE(bench.allocator.other());
  CHECK(bench.allocate(first) == NodeId(20));
}

TEST_CASE("other messages are none of its business") {
  Bench bench;
  bench.book.ids[first] = NodeId(20);
  const Payload payload = Bench::request(first, 0).encode();
  const auto [kind, id] = GENERATE(std::pair(Kind::message, NodeStatus::type.id),
                                   std::pair(Kind::request, Allocation::type.id));
  bench.allocator.receive({.header = {.kind = kind, .data_type_id = id, .source = NodeId(9)},
                           .payload = payload.bytes(),
                           .at = bench.now});
  CHECK_FALSE(bench.allocator.other());
  CHECK(bench.allocator.next_deadline() == never);
}

TEST_CASE("the same unique ID gets the same node ID again", "[requirement-37]") {
  Bench bench;
  bench.book.ids[first] = NodeId(20);
  bench.book.ids[second] = NodeId(21);
  CHECK(bench.allocate(first) == NodeId(20));
  CHECK(bench.allocate(second) == NodeId(21));
  bench.pass(10s);
  CHECK(bench.allocate(first) == NodeId(20));
}

TEST_CASE("a unit that the table does not serve is not answered, at no part") {
  Bench bench;
  bench.book.ids[first] = NodeId(20);
  CHECK_FALSE(bench.allocate(second));
  SECTION("whose first six bytes are those of a unit that is served") {
    UniqueId cousin = first;
    cousin[8] ^= 1U;
    bench.ask(cousin, 0);
    bench.pass(100ms);
    CHECK(bench.answers().size() == 1); // it may be the one
    bench.ask(cousin, 1);
    CHECK(bench.answers().empty());
    bench.ask(first, 1); // which has heard the same answer, and goes on
    CHECK(bench.answers() == Answers{answer(first, 12)});
  }
  SECTION("whose first twelve are") {
    UniqueId cousin = first;
    cousin[15] ^= 1U;
    bench.ask(cousin, 0);
    bench.pass(100ms);
    bench.ask(cousin, 1);
    CHECK(bench.answers().size() == 2);
    bench.ask(cousin, 2);
    CHECK(bench.answers().empty());
    CHECK(bench.book.assigned.empty());
  }
}

TEST_CASE("a unit that the table gives no ID after all gets no answer") {
  Bench bench;
  bench.book.ids[first] = std::nullopt;
  bench.book.ids[second] = NodeId(21);
  CHECK_FALSE(bench.allocate(first));
  CHECK(bench.book.assigned == std::vector{first});
  CHECK(bench.allocate(second) == NodeId(21)); // and stands in nobody's way
}

TEST_CASE("an ID that no unit may have is never assigned", "[requirement-41]") {
  Bench bench;
  bench.book.ids[first] = GENERATE(NodeId(0), NodeId(127)); // nobody's, and ours
  for (std::size_t part = 0; part < 3; ++part) {
    bench.ask(first, part);
    bench.pass(100ms);
  }
  const auto answers = bench.answers();
  CHECK(std::ranges::none_of(answers, [](const Allocation& each) { return each.size == 16; }));
}

TEST_CASE("a part that does not come next changes nothing", "[requirement-36]") {
  Bench bench;
  bench.book.ids[first] = NodeId(20);
  bench.book.ids[second] = NodeId(21);
  bench.ask(first, 0);
  bench.pass(100ms);
  CHECK(bench.answers().size() == 1);
  SECTION("the first part of another unit") {
    bench.ask(second, 0);
  }
  SECTION("the second part of another unit") {
    bench.ask(second, 1);
  }
  SECTION("the last part of this one") {
    bench.ask(first, 2);
  }
  SECTION("a part of a size that no part has") {
    Allocation wrong = Bench::request(first, 1);
    wrong.size = GENERATE(std::uint8_t{0}, std::uint8_t{4}, std::uint8_t{5}, std::uint8_t{7});
    bench.hear(wrong);
  }
  CHECK(bench.answers().empty());
  bench.ask(first, 1);
  CHECK(bench.answers() == Answers{answer(first, 12)});
}

TEST_CASE("nobody begins in the middle") {
  Bench bench;
  bench.book.ids[first] = NodeId(20);
  bench.ask(first, 1);
  bench.ask(first, 2);
  bench.pass(1s);
  CHECK(bench.answers().empty());
  CHECK(bench.allocate(first) == NodeId(20));
}

TEST_CASE("an exchange that stopped is forgotten after 500 ms, not before", "[requirement-38]") {
  Bench bench;
  bench.book.ids[first] = NodeId(20);
  bench.book.ids[second] = NodeId(21);
  REQUIRE(bench.allocate(second)); // the courtesy is over
  bench.ask(first, 0);
  CHECK(bench.answers().size() == 1);
  SECTION("until then the others wait") {
    bench.pass(500ms);
    bench.ask(second, 0);
    CHECK(bench.answers().empty());
    bench.ask(first, 1);
    CHECK(bench.answers() == Answers{answer(first, 12)});
  }
  SECTION("then another one may begin") {
    bench.pass(501ms);
    bench.ask(second, 0);
    CHECK(bench.answers() == Answers{answer(second, 6)});
  }
  SECTION("then the unit itself begins anew") {
    bench.pass(501ms);
    bench.ask(first, 1);
    CHECK(bench.answers().empty());
    bench.ask(first, 0);
    CHECK(bench.answers() == Answers{answer(first, 6)});
  }
  SECTION("what others ask meanwhile does not prolong it") {
    bench.pass(400ms);
    bench.ask(second, 0);
    bench.pass(101ms);
    bench.ask(second, 0);
    CHECK(bench.answers() == Answers{answer(second, 6)});
  }
  SECTION("each part begins the time anew") {
    bench.pass(400ms);
    bench.ask(first, 1);
    bench.pass(400ms);
    bench.ask(first, 2);
    CHECK(bench.answers().back() == answer(first, 16, 20));
  }
}

TEST_CASE("servos that ask at once each get their own ID, whatever the order of their parts",
          "[requirement-36]") {
  // Two may share the beginning of their unique IDs: they were made one after the other.
  const std::size_t alike = GENERATE(std::size_t{0}, std::size_t{6}, std::size_t{15});
  const std::uint64_t seed = GENERATE(range(std::uint64_t{1}, std::uint64_t{21}));
  Bench bench;
  std::vector<std::pair<UniqueId, std::unique_ptr<sim::Allocatee>>> servos;
  for (std::uint8_t number = 1; number <= 3; ++number) {
    UniqueId unique_id = unit(number);
    std::copy_n(first.begin(), alike, unique_id.begin());
    bench.book.ids[unique_id] = NodeId(static_cast<std::uint8_t>(10 + number));
    servos.emplace_back(unique_id,
                        std::make_unique<sim::Allocatee>(unique_id, seed * 10 + number, bench.now));
  }
  std::map<UniqueId, NodeId> got;
  const auto tell = [&](const Allocation& message, bool is_request, const void* sender) {
    for (auto& [unique_id, servo] : servos) {
      if (servo.get() != sender && !got.contains(unique_id)) {
        if (const auto id = servo->receive(message, is_request, bench.now)) {
          got[unique_id] = *id;
        }
      }
    }
  };
  while (got.size() < servos.size() && bench.now < at(60s)) {
    Time next = bench.allocator.next_deadline();
    for (const auto& [unique_id, servo] : servos) {
      next = got.contains(unique_id) ? next : std::min(next, servo->next_deadline());
    }
    bench.pass(next - bench.now);
    for (auto& [unique_id, servo] : servos) {
      const auto asked = got.contains(unique_id) ? std::nullopt : servo->advance(bench.now);
      if (asked) {
        tell(*asked, true, servo.get());
        bench.hear(*asked);
      }
    }
    for (const Allocation& answer : bench.answers()) {
      tell(answer, false, nullptr);
    }
  }
  INFO("seed " << seed << ", alike " << alike);
  REQUIRE(got.size() == 3);
  for (const auto& [unique_id, id] : got) {
    CHECK(bench.book.ids[unique_id] == id);
  }
}
