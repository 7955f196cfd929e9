// What apply and get cost of the bus: counted in bits of the simulated one, at 1 Mbit/s a
// microsecond each.

#include "blactl/can/frame_bits.hpp"
#include "blactl/can/log_reader.hpp"
#include "blactl/dronecan/transfer.hpp"
#include "blactl/dronecan/types.hpp"

#include "catch.hpp"
#include "cli/mixed_fleet.hpp"
#include "cli/scene.hpp"

#include <array>
#include <iostream>
#include <map>
#include <string>
#include <vector>

using namespace blactl;
using test::MixedFleet;

namespace {

/// One question and its answer.
struct Exchange {
  enum class Kind : std::uint8_t { read, write, order, other };

  Kind kind = Kind::other;
  bool is_setting = false;  ///< a read of 0x20 to 0x46
  bool after_write = false; ///< since the last write to this node nothing was saved
  std::size_t bits = 0;
  WallTime begin{}, end{};
};

/// "0x38": the name in a question of one frame; empty: it has more.
std::string name_in(const can::Frame& frame) {
  constexpr std::size_t before = 2, after = 1; // index and tag; tail byte
  const auto bytes = frame.payload();
  return bytes.size() <= before + after ? std::string()
                                        : std::string(bytes.begin() + before, bytes.end() - after);
}

/// What the bus carried while a command ran.
class BusTime {
 public:
  explicit BusTime(const std::string& log) {
    const auto reader = can::LogReader::open(log);
    REQUIRE(reader);
    while (const auto line = (*reader)->next()) {
      take(line->frame, line->at);
    }
  }

  struct Sum {
    std::size_t count = 0, bits = 0;
  };

  template <class Predicate> [[nodiscard]] Sum sum(Predicate predicate) const {
    Sum sum;
    for (const Exchange& each : exchanges_) {
      if (predicate(each)) {
        ++sum.count;
        sum.bits += each.bits;
      }
    }
    return sum;
  }

  /// How much of the time between the first and the last of these nothing was sent: in pieces, as
  /// restarts come in between.
  template <class Predicate> [[nodiscard]] double stretch(Predicate predicate) const {
    using namespace std::chrono_literals;
    Duration elapsed{}, busy{};
    WallTime begin{}, end{};
    const auto close = [&] {
      elapsed += end - begin;
      for (auto frame = frames_.upper_bound(begin); frame != frames_.end() && frame->first <= end;
           ++frame) {
        busy += Duration(static_cast<Duration::rep>(frame->second));
      }
    };
    for (const Exchange& each : exchanges_) {
      if (!predicate(each)) {
        continue;
      }
      if (each.begin - end > 20ms) {
        close();
        begin = each.begin;
      }
      end = std::max(end, each.end);
    }
    close();
    return static_cast<double>(elapsed.count()) / static_cast<double>(busy.count());
  }

 private:
  void take(const can::Frame& frame, WallTime at) {
    const std::size_t bits = can::frame_length(frame) + can::intermission_bits;
    frames_.emplace(at, bits);
    const auto header = dronecan::decode_id(frame.id);
    if (!header || header->kind == dronecan::Kind::message) {
      return;
    }
    const bool is_request = header->kind == dronecan::Kind::request;
    const auto node = is_request ? header->destination : header->source;
    constexpr std::uint8_t start_of_transfer = 0x80;
    if (is_request && (frame.payload().back() & start_of_transfer) != 0) {
      begin(node, header->data_type_id, frame, at);
    }
    if (const auto open = open_.find(node); open != open_.end()) {
      exchanges_[open->second].bits += bits;
      exchanges_[open->second].end = at;
    }
  }

  void begin(dronecan::NodeId node, std::uint16_t type, const can::Frame& frame, WallTime at) {
    using Kind = Exchange::Kind;
    Exchange exchange{.begin = at};
    if (type == dronecan::ExecuteOpcode::type.id) {
      exchange.kind = Kind::order;
      unsaved_[node] = false;
    } else if (type == dronecan::GetSet::type.id) {
      // A question that writes has several frames, one that reads has one.
      const std::string name = name_in(frame);
      constexpr std::uint8_t end_of_transfer = 0x40;
      const bool is_read = (frame.payload().back() & end_of_transfer) != 0;
      exchange.kind = is_read ? Kind::read : Kind::write;
      exchange.is_setting = is_read && name >= "0x20" && name <= "0x46";
      exchange.after_write = unsaved_[node];
      unsaved_[node] = unsaved_[node] || !is_read;
    }
    open_[node] = exchanges_.size();
    exchanges_.push_back(exchange);
  }

  std::vector<Exchange> exchanges_; ///< in the order in which they begin
  std::map<dronecan::NodeId, std::size_t> open_;
  std::map<dronecan::NodeId, bool> unsaved_;
  std::multimap<WallTime, std::size_t> frames_; ///< bits by the time of their end
};

std::size_t values_of(const nlohmann::ordered_json& document) {
  std::size_t values = 0;
  for (const auto& entry : document["servos"]) {
    values += entry["set"].size();
  }
  return values;
}

} // namespace

TEST_CASE("who was only just switched on is waited for, and read once") {
  constexpr int servos = 120;
  constexpr int configuration = 34;
  test::Scene scene;
  for (int id = 1; id <= servos; ++id) {
    scene.servo("BLA21-12U-AB", id);
  }
  const test::Bench bench;
  const std::string log = (bench.folder() / "get.log").string();
  REQUIRE(scene.run(bench, {"get", "-n", "all", "--record", log}).status == 0);
  const auto read = BusTime(log).sum([](const Exchange& each) { return each.is_setting; });
  std::cout << "get of " << servos << " young servos: " << read.count << " settings read\n";
  CHECK(read.count * 100 <= std::size_t{110} * servos * configuration);
  CHECK(read.count >= std::size_t{servos} * configuration);
}

// The bounds, in exchanges; one costs what it costs on this bus, on the average.
//
//   N     servos
//   V     values that the file changes, of all servos
//   M     moves to a node ID for the time being: one for every two that exchange theirs
//   C     34, what is configured in one servo: a complete read (0x20 to 0x46)
//
//   writing  V + M            every value once; a move on the way writes one more ID
//   reading  N * C            before: what each holds
//            (N + M) * C      after each save: whether ROM has it all
//            M * C            where a servo has moved to, before it goes on
//
// Who somebody is (GetNodeInfo, 0x50 to 0x53) and what only judges (commands, angle, temperature,
// voltage, faults) is no configuration: that is in the sum of all bits.
TEST_CASE("apply writes and reads within 1.10 times of what the bus makes necessary") {
  constexpr int servos = 64;
  constexpr int configuration = 34;
  MixedFleet fleet(servos);
  const auto document = fleet.changed();
  const std::string log = fleet.path("apply.log");
  const auto result = fleet.run({"apply", fleet.file(document), "-y", "--json", "--record", log});
  INFO(result.err);
  REQUIRE(result.status == 0);
  const BusTime bus(log);
  using Kind = Exchange::Kind;
  const auto is_write = [](const Exchange& each) { return each.kind == Kind::write; };
  const auto is_reading = [](const Exchange& each) { return each.is_setting; };
  const auto written = bus.sum(is_write);
  const auto proven =
      bus.sum([](const Exchange& each) { return each.kind == Kind::read && each.after_write; });
  const auto read =
      bus.sum([](const Exchange& each) { return each.is_setting && !each.after_write; });

  const auto values = static_cast<double>(values_of(document));
  const double moves = servos / 2.0;
  const double write_bits = static_cast<double>(written.bits) / static_cast<double>(written.count);
  const double read_bits = static_cast<double>(read.bits) / static_cast<double>(read.count);
  const double writing_bound = (values + moves) * write_bits;
  const double reading_bound = (2 * servos + 2 * moves) * configuration * read_bits;
  const double writing = static_cast<double>(written.bits + proven.bits) / writing_bound;
  const double reading = static_cast<double>(read.bits) / reading_bound;
  const double writing_time = bus.stretch(is_write);
  const double reading_time = bus.stretch(is_reading);
  const auto all = bus.sum([](const Exchange&) { return true; });
  std::cout << "apply of " << servos << " servos, " << values << " values: " << written.count
            << " writes of " << write_bits << " bits, " << writing << " of the bound, and "
            << writing_time << " of the time that the bus was busy then; " << read.count
            << " reads of " << read_bits << " bits, " << reading << " of the bound, and "
            << reading_time << " of the time; " << all.bits << " bits in all\n";
  constexpr double most = 1.10;
  CHECK(writing <= most);
  CHECK(reading <= most);
  CHECK(writing_time <= most);
  CHECK(reading_time <= most);
  CHECK(writing >= 1);
  CHECK(reading >= 1);
}
