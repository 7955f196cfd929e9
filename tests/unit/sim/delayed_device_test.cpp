#include "blactl/sim/node/delayed_device.hpp"

#include "unit/sim/support.hpp"

#include <chrono>
#include <set>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using testing::frame;
using testing::text;

namespace {

/// Answers every frame with one that carries its number.
class Echo final : public Device {
 public:
  explicit Echo(std::vector<std::string> answer) : answer_(std::move(answer)) {}

  void receive(const can::Frame&, Time) override {
    for (const std::string& line : answer_) {
      can::Frame sent = frame(line);
      sent.data[0] = count_;
      send(sent);
    }
    ++count_;
  }

  [[nodiscard]] Time next_deadline() const override { return never; }

  void advance(Time) override {}

 private:
  std::vector<std::string> answer_;
  std::uint8_t count_ = 0;
};

const can::Frame question = frame("1E0B8BFF#C0");
const std::vector<std::string> response{"1E0B7F8B#0022334455667780", "1E0B7F8B#001140"};
const std::vector<std::string> message{"1001550B#0000000000000000", "1001550B#00C0"};

/// What leaves a device that is asked `times` times at once, over a long time.
std::vector<can::Frame> sent(const std::vector<std::string>& answer, const SendingFaults& faults,
                             int times) {
  DelayedDevice device(std::make_unique<Echo>(answer), faults, 1);
  testing::Bench bench(device);
  for (int i = 0; i < times; ++i) {
    bench.deliver({question});
  }
  return bench.run(10s);
}

} // namespace

TEST_CASE("jitter delays whole transfers and keeps the order of one device") {
  DelayedDevice device(std::make_unique<Echo>(response), {.jitter = 5ms}, 1);
  testing::Bench bench(device);
  bench.deliver({question, question, question});
  std::vector<can::Frame> all;
  std::set<std::int64_t> times;
  for (int i = 0; i < 5000; ++i) {
    const auto now = bench.run(1us);
    CHECK(now.size() % response.size() == 0); // frames of one transfer stay together
    if (!now.empty()) {
      times.insert(bench.now().time_since_epoch().count());
    }
    all.insert(all.end(), now.begin(), now.end());
  }
  REQUIRE(all.size() == 6);
  CHECK(times.size() > 1);
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(all[i].data[0] == i / 2);
  }
}

TEST_CASE("a late answer comes when others have long passed it") {
  DelayedDevice device(std::make_unique<Echo>(response), {.late_answers = 0.5, .late_by = 2s}, 1);
  testing::Bench bench(device);
  for (int i = 0; i < 40; ++i) {
    bench.deliver({question});
  }
  const auto soon = bench.run(1s).size() / 2;
  const auto late = bench.run(2s).size() / 2;
  CHECK(soon + late == 40);
  CHECK(soon > 10);
  CHECK(late > 10);
}

TEST_CASE("a double answer is the same frames again") {
  const auto frames = sent(response, {.double_answers = 1}, 1);
  REQUIRE(frames.size() == 4);
  CHECK(frames[0] == frames[2]);
  CHECK(frames[1] == frames[3]);
}

TEST_CASE("messages are neither late nor doubled") {
  CHECK(sent(message, {.late_answers = 1, .late_by = 20s, .double_answers = 1}, 3).size() == 6);
}
