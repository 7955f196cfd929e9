#include "blactl/sim/servo/allocatee.hpp"

#include "catch.hpp"

#include <algorithm>
#include <optional>
#include <vector>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using dronecan::Allocation;

namespace {

using Numbers = std::initializer_list<std::uint8_t>;

constexpr dronecan::UniqueId unique_id{0x00, 0x11, 0x22, 0x33, 0x44, 0x55, 0x66, 0x77,
                                       0x88, 0x99, 0xAA, 0xBB, 0xCC, 0xDD, 0xEE, 0xFF};

Allocation answer(std::uint8_t size, std::uint8_t node_id = 0) {
  Allocation message;
  message.node_id = node_id;
  message.size = size;
  std::copy_n(unique_id.begin(), size, message.unique_id.begin());
  return message;
}

/// An exchange under way at `now`.
struct Exchange {
  Allocatee allocatee{unique_id, 7, Time{}};
  Time now{};

  Allocation request() {
    now = allocatee.next_deadline();
    const auto sent = allocatee.advance(now);
    REQUIRE(sent);
    return *sent;
  }

  std::optional<dronecan::NodeId> hear(const Allocation& message, bool anonymous = false) {
    now += 1ms;
    return allocatee.receive(message, anonymous, now);
  }

  [[nodiscard]] Duration until_next() const { return allocatee.next_deadline() - now; }
};

bool is_request_period(Duration duration) {
  return duration >= 600ms && duration <= 1000ms;
}

} // namespace

TEST_CASE("requirement 29: requests come every 600 to 1000 ms, at random", "[requirement-29]") {
  Exchange exchange;
  std::vector<Duration> periods{exchange.allocatee.next_deadline() - Time{}};
  for (int i = 0; i < 50; ++i) {
    exchange.request();
    periods.push_back(exchange.until_next());
  }
  CHECK(std::ranges::all_of(periods, is_request_period));
  CHECK(std::ranges::max(periods) - std::ranges::min(periods) > 200ms);
}

TEST_CASE("requirements 30, 31: three parts of 6, 6 and 4 bytes, node ID 0, the first one marked",
          "[requirement-30][requirement-31]") {
  Exchange exchange;
  const Allocation first = exchange.request();
  CHECK(first.node_id == 0);
  CHECK(first.first_part_of_unique_id);
  CHECK(first.size == 6);
  CHECK(std::equal(unique_id.begin(), unique_id.begin() + 6, first.unique_id.begin()));
  CHECK_FALSE(exchange.hear(answer(6)));
  const Allocation second = exchange.request();
  CHECK_FALSE(second.first_part_of_unique_id);
  CHECK(second.size == 6);
  CHECK(std::equal(unique_id.begin() + 6, unique_id.begin() + 12, second.unique_id.begin()));
  CHECK_FALSE(exchange.hear(answer(12)));
  const Allocation third = exchange.request();
  CHECK(third.node_id == 0);
  CHECK(third.size == 4);
  CHECK(std::equal(unique_id.begin() + 12, unique_id.end(), third.unique_id.begin()));
  CHECK(exchange.hear(answer(16, 125)) == dronecan::NodeId(125));
}

TEST_CASE("requirement 32: the second and third part follow after 0 to 400 ms",
          "[requirement-32]") {
  Duration longest{};
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    Exchange exchange{Allocatee(unique_id, seed, Time{})};
    exchange.request();
    CHECK_FALSE(exchange.hear(answer(6)));
    CHECK(exchange.until_next() <= 400ms);
    longest = std::max(longest, exchange.until_next());
  }
  CHECK(longest > 200ms);
}

TEST_CASE("requirement 33: an answer with another unique ID, or of another length, starts it over",
          "[requirement-33]") {
  for (const std::uint8_t wrong_size : Numbers{0, 5, 7, 12, 16}) {
    Exchange exchange;
    exchange.request();
    CHECK_FALSE(exchange.hear(answer(wrong_size, 33)));
    CHECK(is_request_period(exchange.until_next()));
    CHECK(exchange.request().first_part_of_unique_id);
  }
  Exchange exchange;
  exchange.request();
  Allocation other = answer(6);
  other.unique_id[5] ^= 1;
  CHECK_FALSE(exchange.hear(other));
  CHECK(exchange.request().first_part_of_unique_id);
}

TEST_CASE("requirement 33: nothing heard after a part starts it over", "[requirement-33]") {
  Exchange exchange;
  exchange.request();
  CHECK_FALSE(exchange.hear(answer(6)));
  exchange.request();
  CHECK(exchange.request().first_part_of_unique_id);
}

TEST_CASE("an answer that comes twice, of two allocators, does not stop the exchange",
          "[requirement-33]") {
  Exchange exchange;
  exchange.request();
  CHECK_FALSE(exchange.hear(answer(6)));
  const Time due = exchange.allocatee.next_deadline();
  CHECK_FALSE(exchange.hear(answer(6))); // before the next part has left
  CHECK(exchange.allocatee.next_deadline() == due);
  const Allocation second = exchange.request();
  CHECK_FALSE(second.first_part_of_unique_id);
  CHECK_FALSE(exchange.hear(answer(6))); // after it has left
  CHECK_FALSE(exchange.hear(answer(12)));
  CHECK_FALSE(exchange.hear(answer(12)));
  const Allocation third = exchange.request();
  CHECK(third.size == 4);
  CHECK_FALSE(exchange.hear(answer(12)));
  CHECK(exchange.hear(answer(16, 33)) == dronecan::NodeId(33));
}

TEST_CASE("requirement 33: an old answer of another unit, or a request, starts it over",
          "[requirement-33]") {
  for (const bool anonymous : {false, true}) {
    Exchange exchange;
    exchange.request();
    CHECK_FALSE(exchange.hear(answer(6)));
    Allocation again = answer(6);
    again.unique_id[0] = anonymous ? again.unique_id[0] : 0x77;
    CHECK_FALSE(exchange.hear(again, anonymous));
    CHECK(is_request_period(exchange.until_next()));
    CHECK(exchange.request().first_part_of_unique_id);
    CHECK_FALSE(exchange.hear(answer(12))); // of the exchange before
    CHECK(exchange.request().first_part_of_unique_id);
  }
}

TEST_CASE("an answer before the first request, and the parts of other servos, are not for it") {
  Exchange exchange;
  CHECK_FALSE(exchange.hear(answer(6)));
  CHECK(exchange.request().first_part_of_unique_id);
  CHECK_FALSE(exchange.hear(answer(6), true)); // anonymous: another servo's request
  CHECK(exchange.request().first_part_of_unique_id);
}

TEST_CASE("a complete answer without a node ID assigns nothing") {
  Exchange exchange;
  exchange.request();
  CHECK_FALSE(exchange.hear(answer(6)));
  exchange.request();
  CHECK_FALSE(exchange.hear(answer(12)));
  exchange.request();
  CHECK_FALSE(exchange.hear(answer(16, 0)));
  CHECK(exchange.request().first_part_of_unique_id);
}
