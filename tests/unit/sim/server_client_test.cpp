#include "sim/bus/client.hpp"
#include "sim/bus/server_client.hpp"
#include "unit/sim/support.hpp"

#include <sys/socket.h>
#include <unistd.h>

#include <array>

using namespace blactl;
using namespace blactl::sim;
using namespace std::chrono_literals;
using can::sim_wire::Kind;
using can::sim_wire::Message;
using testing::scenario;

namespace {

constexpr const char* one_servo = R"("servos": [{"model": "BLA21-12U-AB", "node_id": 11}])";
constexpr const char* full_bus =
    R"("foreign": [{"kind": "babbler", "node_id": 40, "load": 1},
                   {"kind": "node", "node_id": 41}])";

/// A client of a bus whose time moves by hand, and the far end of its socket.
class Rig {
 public:
  explicit Rig(const char* members = full_bus, Time power_on = Time{})
      : simulator_(scenario(members), power_on) {
    std::array<int, 2> ends{};
    REQUIRE(socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0, ends.data()) ==
            0);
    far_ = ends[0];
    client_.emplace(ends[1], simulator_, Clock::real);
    const Message hello{.kind = Kind::hello, .value = can::sim_wire::version};
    REQUIRE(::send(far_, &hello, sizeof hello, 0) == sizeof hello);
    client_->serve();
  }

  Rig(const Rig&) = delete;
  Rig& operator=(const Rig&) = delete;

  ~Rig() { close(far_); }

  void pass(Duration time) { simulator_.advance_to(simulator_.now() + time); }

  void send(const can::Frame& frame) {
    const Message message = can::sim_wire::with_frame(Kind::send, frame);
    REQUIRE(::send(far_, &message, sizeof message, 0) == sizeof message);
    client_->serve();
  }

  /// Reads all that there is, as a client does that runs again.
  void read() {
    for (;;) {
      Message message;
      if (recv(far_, &message, sizeof message, 0) != sizeof message) {
        if (!client_->has_backlog()) {
          return;
        }
        client_->flush();
        continue;
      }
      frames += message.kind == Kind::received ? 1U : 0U;
      sent_at = message.kind == Kind::sent ? Time(Duration(message.at)) : sent_at;
      lost = message.kind == Kind::overflow ? message.count : lost;
      in_order = in_order && (message.kind != Kind::received || message.at > last_);
      last_ = message.kind == Kind::received ? message.at : last_;
    }
  }

  [[nodiscard]] std::uint64_t on_the_bus() const { return simulator_.medium().counters().frames; }

  std::uint64_t frames = 0, lost = 0;
  bool in_order = true;
  Time sent_at{}; ///< when its last frame was on the bus

 private:
  Simulator simulator_;
  std::optional<ServerClient> client_;
  int far_ = -1;
  std::int64_t last_ = 0;
};

} // namespace

TEST_CASE("a client that does not run for two seconds of a full bus loses no frame") {
  Rig rig;
  for (int pause = 0; pause < 3; ++pause) {
    rig.pass(2s);
    rig.read();
    CHECK(rig.lost == 0);
    CHECK(rig.in_order);
    CHECK(rig.frames == rig.on_the_bus());
  }
  CHECK(rig.frames > 40'000);
}

TEST_CASE("what a client that does not run for longer has lost is counted to the frame") {
  Rig rig;
  rig.pass(4s);
  rig.read();
  CHECK(rig.frames > backlog_capacity);
  rig.pass(1ms); // it is told with the next frame
  rig.read();
  CHECK(rig.lost > 0);
  CHECK(rig.frames + rig.lost == rig.on_the_bus());
  CHECK(rig.in_order);
}

TEST_CASE("what a client sends is never on the bus before that, however late the simulator is") {
  const Time now = monotonic_now();
  Rig rig(one_servo, now - 100ms);
  rig.send(testing::frame("1E018BFF#C1"));
  rig.pass(50ms);
  rig.read();
  CHECK(rig.sent_at == Time{});
  rig.pass(10s);
  rig.read();
  CHECK(rig.sent_at > now);
}
