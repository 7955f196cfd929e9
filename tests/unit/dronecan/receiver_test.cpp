#include "blactl/base/crc16.hpp"

#include "allocations.hpp"
#include "catch.hpp"
#include "support.hpp"

#include <fstream>
#include <map>
#include <numeric>
#include <random>

using namespace blactl;
using namespace blactl::dronecan;
using namespace blactl::dronecan::test;
using blactl::test::allocations;

namespace {

using enum ReceiveError;
using Errors = std::vector<ReceiveError>;
using Payloads = std::vector<std::string>;
using ByteVector = std::vector<std::uint8_t>;

Header message_from(std::uint8_t node, std::uint16_t type = ActuatorStatus::type.id) {
  return {.data_type_id = type, .source = NodeId(node)};
}

ByteVector bytes_of(std::size_t size, std::uint8_t value) {
  return ByteVector(size, value);
}

/// The frames of a transfer whose payload is 1, 2, 3...
std::vector<can::Frame> counting(const Header& header, TransferId id, std::size_t size) {
  ByteVector payload(size);
  std::iota(payload.begin(), payload.end(), std::uint8_t{1});
  const auto signature = known_signature(header.kind, header.data_type_id);
  return segment(header, id, signature.value_or(0), payload);
}

/// The frames of a transfer whose payload is `size` bytes of `value`.
std::vector<can::Frame> transfer(const Header& header, TransferId id, std::size_t size,
                                 std::uint8_t value = 0xAB) {
  const auto signature = known_signature(header.kind, header.data_type_id);
  return segment(header, id, signature.value_or(0), bytes_of(size, value));
}

const std::string ab_8 = "ABABABABABABABAB";

} // namespace

TEST_CASE("a transfer bears the time of its first frame and is delivered with its last") {
  Ear ear;
  const auto frames = transfer(message_from(5), 3, 20);
  REQUIRE(frames.size() == 4);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    CHECK(ear.heard.empty());
    ear.hear(frames[i], i * 100ms);
  }
  REQUIRE(ear.heard.size() == 1);
  CHECK(ear.heard[0].at == at(0ms));
  CHECK(ear.heard[0].crc_checked);
}

TEST_CASE("a repeated transfer ID is refused for 2 s after the transfer began") {
  const auto first = transfer(message_from(5), 3, 4);
  Ear ear;
  ear.hear(first, 0s).hear(first, 2s);
  CHECK(ear.heard.size() == 1);
  CHECK(ear.errors == Errors{transfer_id});
  ear.hear(first, 2s + 1us);
  CHECK(ear.heard.size() == 2);
  CHECK(ear.errors == Errors{transfer_id});
}

TEST_CASE("each repeated transfer is reported once, however many frames it has") {
  const auto frames = transfer(message_from(5), 3, 50);
  Ear ear;
  ear.hear(frames, 0ms).hear(frames, 100ms).hear(frames, 200ms);
  CHECK(ear.heard.size() == 1);
  CHECK(ear.errors == Errors{transfer_id, transfer_id});
}

TEST_CASE("transfer IDs may jump") {
  Ear ear;
  for (const auto id : {0, 5, 4, 20, 31, 0}) {
    ear.hear(transfer(message_from(5), static_cast<TransferId>(id), 4));
  }
  // One back (4 after 5) is a jump; only the last one again is a repetition.
  CHECK(ear.heard.size() == 6);
  ear.hear(transfer(message_from(5), 0, 4));
  CHECK(ear.heard.size() == 6);
}

TEST_CASE("senders, destinations and types do not disturb each other", "[requirement-13]") {
  std::vector<std::vector<can::Frame>> transfers;
  for (std::uint8_t node = 1; node <= 100; ++node) {
    transfers.push_back(transfer(message_from(node), 7, 30, node));
  }
  const auto response = [](std::uint8_t source, std::uint8_t destination) {
    return Header{.kind = Kind::response,
                  .data_type_id = GetSet::type.id,
                  .source = NodeId(source),
                  .destination = NodeId(destination)};
  };
  transfers.push_back(transfer(response(1, 126), 7, 30));
  transfers.push_back(transfer(response(1, 127), 7, 30));
  transfers.push_back(transfer(message_from(1, ArrayCommand::type.id), 7, 30));
  Ear ear(listener, 128);
  for (std::size_t i = 0; i < transfers.front().size(); ++i) {
    for (const auto& frames : transfers) {
      ear.hear(frames[i]);
    }
  }
  CHECK(ear.heard.size() == transfers.size());
  CHECK(ear.errors.empty());
}

TEST_CASE("a service is heard by its addressee and by a listener") {
  const Header header{.kind = Kind::request,
                      .data_type_id = GetSet::type.id,
                      .source = NodeId(10),
                      .destination = NodeId(20)};
  const auto frames = transfer(header, 0, 10);
  CHECK(Ear(NodeId(20)).hear(frames).heard.size() == 1);
  CHECK(Ear(listener).hear(frames).heard.size() == 1);
  CHECK(Ear(NodeId(21)).hear(frames).heard.empty());
  CHECK(Ear(NodeId(21)).hear(frames).errors.empty());
}

TEST_CASE("what is no DroneCAN is ignored without a complaint") {
  const auto good = transfer(message_from(5), 3, 4).front();
  std::vector<can::Frame> frames(6, good);
  frames[0].extended = false;
  frames[1].remote = true;
  frames[2].size = 0;
  frames[3].size = 9;
  frames[4].id = 0x1E018A80; // a service from node 0
  frames[5].id = good.id | 0x8000'0000;
  Ear ear;
  ear.hear(frames);
  CHECK(ear.heard.empty());
  CHECK(ear.errors.empty());
}

TEST_CASE("every anonymous frame is delivered, whatever its transfer ID") {
  Ear ear;
  for (int i = 0; i < 3; ++i) {
    ear.hear("1EEE8100#0144C08B635E05C0");
  }
  REQUIRE(ear.heard.size() == 3);
  CHECK(ear.heard[0].header.source == anonymous);
  CHECK(ear.heard[0].header.data_type_id == Allocation::type.id);
  CHECK(ear.heard[0].payload == "0144C08B635E05");
  CHECK(ear.errors.empty());
}

TEST_CASE("anonymous frames take no session") {
  Ear ear(listener, 1);
  const auto frames = transfer(message_from(5), 3, 8);
  ear.hear(frames[0]).hear("1EEE8100#0144C08B635E05C0").hear(frames[1]);
  CHECK(ear.heard.size() == 2);
}

TEST_CASE("an anonymous frame of several, or with a toggle bit, is not delivered") {
  Ear ear;
  ear.hear("1EEE8100#0144C08B635E0580").hear("1EEE8100#0144C08B635E0540");
  CHECK(ear.errors.empty());
  ear.hear("1EEE8100#0144C08B635E05E0");
  CHECK(ear.errors == Errors{toggle});
  CHECK(ear.heard.empty());
}

TEST_CASE("a transfer that stops is a timeout when its sender goes on") {
  const auto frames = transfer(message_from(5), 3, 20);
  Ear ear;
  ear.hear(frames[0], 0s).hear(frames[1], 1s);
  SECTION("with the rest of it") {
    ear.hear(frames[2], 2s + 1us).hear(frames[3], 2s + 2us);
    CHECK(ear.heard.empty());
    CHECK(ear.complaints == std::vector{Ear::Complaint(timeout, frames[2].id, at(2s + 1us))});
  }
  SECTION("with another, even of the same ID") {
    ear.hear(transfer(message_from(5), 3, 20), 3s);
    CHECK(ear.heard.size() == 1);
    CHECK(ear.errors == Errors{timeout});
  }
  SECTION("but not within the 2 s") {
    ear.hear(frames[2], 2s).hear(frames[3], 2s);
    CHECK(ear.heard.size() == 1);
    CHECK(ear.errors.empty());
  }
}

TEST_CASE("a transfer that stops for ever is a timeout when one asks") {
  const auto header = Header{.priority = 9, .data_type_id = 1010, .source = NodeId(77)};
  const auto frames = transfer(header, 3, 20);
  Ear ear;
  ear.hear(frames[0], 5s);
  ear.receiver().expire(at(7s));
  CHECK(ear.errors.empty());
  ear.receiver().expire(at(7s + 1us));
  CHECK(ear.complaints == std::vector{Ear::Complaint(timeout, frames[0].id, at(7s))});
  ear.receiver().expire(never);
  ear.hear(frames[1], 7s + 1us).hear(frames[2], 7s + 2us);
  CHECK(ear.errors.size() == 1);
}

TEST_CASE("at the end of a log everything unfinished is a timeout") {
  Ear ear;
  ear.hear(transfer(message_from(1), 0, 8).front());
  ear.hear(transfer(message_from(2), 0, 8).front());
  ear.hear(transfer(message_from(3), 0, 8));
  ear.receiver().expire(never);
  CHECK(ear.errors == Errors{timeout, timeout});
}

TEST_CASE("a lost first frame is one complaint") {
  const auto first = transfer(message_from(5), 3, 50);
  const auto second = transfer(message_from(5), 4, 50);
  Ear ear;
  SECTION("from a sender that was never heard") {}
  SECTION("from a sender whose transfer ID was expected") {
    ear.hear(transfer(message_from(5), 2, 50));
  }
  SECTION("from a sender whose transfer ID was not expected") {
    ear.hear(transfer(message_from(5), 10, 50));
  }
  const auto before = ear.heard.size();
  ear.hear(std::span(first).subspan(1));
  CHECK(ear.heard.size() == before);
  CHECK(ear.errors == Errors{missing_start});
  ear.hear(second);
  CHECK(ear.heard.size() == before + 1);
  CHECK(ear.errors.size() == 1);
}

TEST_CASE("two lost first frames are one complaint, though toggle and transfer ID fit") {
  Ear ear;
  ear.hear(transfer(message_from(5), 2, 50));
  const auto frames = transfer(message_from(5), 3, 50);
  ear.hear(std::span(frames).subspan(2));
  CHECK(ear.heard.size() == 1);
  CHECK(ear.errors == Errors{missing_start});
}

TEST_CASE("whichever frame of a transfer is lost, it costs one complaint and no other transfer") {
  for (std::size_t lost = 0; lost < 8; ++lost) {
    INFO("frame " << lost);
    auto frames = counting(message_from(5), 3, 50);
    REQUIRE(frames.size() == 8);
    frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(lost));
    Ear ear;
    ear.hear(transfer(message_from(5), 2, 50)).hear(frames).hear(transfer(message_from(5), 4, 50));
    CHECK(ear.heard.size() == 2);
    CHECK(ear.errors == Errors{lost == 0 ? missing_start : lost == 7 ? transfer_id : toggle});
  }
}

TEST_CASE("whichever frame of a transfer comes twice, nothing is lost and nothing is said") {
  for (std::size_t twice = 0; twice < 8; ++twice) {
    auto frames = counting(message_from(5), 3, 50);
    frames.insert(frames.begin() + static_cast<std::ptrdiff_t>(twice), frames[twice]);
    Ear ear;
    ear.hear(frames).hear(transfer(message_from(5), 4, 50));
    CHECK(ear.heard.size() == 2);
    CHECK(ear.errors.empty());
  }
}

TEST_CASE("frames before the last that are not full break their transfer") {
  for (std::size_t i = 0; i < 8; ++i) {
    INFO("frame " << i);
    auto frames = transfer(message_from(5), 3, 50);
    auto& frame = frames[i];
    frame.data[frame.size - 2U] = frame.data[frame.size - 1U];
    --frame.size;
    Ear ear;
    ear.hear(frames).hear(transfer(message_from(5), 4, 50));
    CHECK(ear.heard.size() == 1);
    CHECK(ear.errors == Errors{i == 7 ? crc : truncated});
  }
}

TEST_CASE("a frame may be its tail byte only, where it is the last") {
  // 12 bytes fill two frames; their sender ended with an empty third.
  const auto header = message_from(5);
  auto frames = transfer(header, 3, 12);
  REQUIRE(frames.size() == 2);
  frames[1].data[7] &= 0xBF;
  frames.push_back(frame(frames[0].id, ByteVector{0x40 | 3}));
  Ear ear;
  ear.hear(frames);
  CHECK(ear.heard.size() == 1);
}

TEST_CASE("payloads up to the capacity are delivered, longer ones are truncated") {
  Ear ear;
  ear.hear(transfer(message_from(5), 0, Receiver::capacity));
  REQUIRE(ear.heard.size() == 1);
  CHECK(ear.heard[0].payload.size() == 2 * Receiver::capacity);
  ear.hear(transfer(message_from(5), 1, Receiver::capacity + 1));
  ear.hear(transfer(message_from(5), 2, 5000));
  CHECK(ear.heard.size() == 1);
  CHECK(ear.errors == Errors{truncated, truncated});
  ear.hear(transfer(message_from(5), 3, 8));
  CHECK(ear.heard.size() == 2);
}

TEST_CASE("an unknown type of several frames is delivered unchecked, without the CRC") {
  Ear ear;
  ear.hear(transfer(message_from(5, 20001), 0, 8)).hear(transfer(message_from(5, 20001), 1, 3));
  CHECK(ear.payloads() == Payloads{ab_8, "ABABAB"});
  CHECK_FALSE(ear.heard[0].crc_checked);
  CHECK(ear.heard[1].crc_checked);
}

TEST_CASE("an unknown type is not delivered where a frame is missing") {
  // Of equal bytes a frame is like the last but one, so that a lost frame looks like a second copy.
  for (const auto& whole :
       {counting(message_from(5, 20001), 3, 50), transfer(message_from(5, 20001), 3, 50)}) {
    for (std::size_t lost = 0; lost < whole.size(); ++lost) {
      INFO("frame " << lost);
      auto frames = whole;
      frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(lost));
      Ear ear;
      ear.hear(transfer(message_from(5, 20001), 2, 1)).hear(frames);
      ear.hear(transfer(message_from(5, 20001), 4, 1));
      CHECK(ear.heard.size() == 2);
      CHECK(ear.errors.size() == 1);
    }
  }
}

TEST_CASE("a lost frame that looks like a second copy is found by the CRC") {
  for (std::size_t lost = 2; lost < 6; ++lost) {
    auto frames = transfer(message_from(5), 3, 50);
    frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(lost));
    Ear ear;
    ear.hear(frames);
    CHECK(ear.heard.empty());
    CHECK(ear.errors == Errors{crc});
  }
}

TEST_CASE("a transfer that starts again under its own ID is not mixed up with itself") {
  const auto old = transfer(message_from(5, 20001), 3, 50, 0x11);
  const auto young = transfer(message_from(5, 20001), 3, 50, 0x22);
  for (std::size_t n = 1; n < 8; ++n) {
    Ear ear;
    ear.hear(std::span(old).first(n)).hear(young);
    CHECK(ear.heard.empty());
    CHECK(ear.errors == Errors{transfer_id});
  }
}

TEST_CASE("a full receiver forgets the session that was idle longest") {
  Ear ear(listener, 2);
  const auto one = transfer(message_from(1), 0, 8);
  const auto two = transfer(message_from(2), 0, 8);
  const auto three = transfer(message_from(3), 0, 8);
  ear.hear(one[0]).hear(two[0]).hear(one[0]); // an echo keeps a session alive, too
  ear.hear(three[0]).hear(three[1]).hear(one[1]).hear(two[1]);
  REQUIRE(ear.heard.size() == 2);
  CHECK(ear.heard[0].header.source == NodeId(3));
  CHECK(ear.heard[1].header.source == NodeId(1));
  CHECK(ear.errors == Errors{missing_start});
}

TEST_CASE("a receiver without callbacks receives") {
  Receiver receiver(1, listener, {});
  for (const auto& frame : transfer(message_from(5), 3, 50)) {
    receiver.receive(frame, at(0s));
    receiver.receive(frame, at(0s));
  }
  receiver.expire(never);
}

TEST_CASE("receiving never allocates") {
  std::size_t heard = 0;
  std::size_t errors = 0;
  Receiver receiver(16, listener,
                    {.transfer = [&heard](const Transfer&) { ++heard; },
                     .error = [&errors](ReceiveError, std::uint32_t, Time) { ++errors; },
                     .signature = known_signature});
  std::vector<can::Frame> frames;
  for (std::uint8_t node = 1; node < 100; ++node) {
    for (const std::size_t size : {0U, 7U, 8U, 300U, 2000U}) {
      const auto more = transfer(message_from(node), static_cast<TransferId>(size % 32), size);
      frames.insert(frames.end(), more.begin(), more.end());
    }
  }
  frames.push_back(frame("1EEE8100#0144C08B635E05C0"));
  const auto before = allocations();
  for (const auto& frame : frames) {
    receiver.receive(frame, at(0s));
  }
  receiver.expire(never);
  CHECK(allocations() == before);
  CHECK(heard == 99 * 4 + 1);
  CHECK(errors == 99);
}

TEST_CASE("memory is bounded, however many keys are heard") {
  std::mt19937 random(4);
  std::size_t delivered = 0;
  const auto before = allocations();
  Receiver receiver(1000, listener, {.transfer = [&delivered](const Transfer&) { ++delivered; }});
  const auto constructed = allocations();
  CHECK(constructed - before < 32);
  for (int i = 0; i < 100'000; ++i) {
    can::Frame frame{.id = static_cast<std::uint32_t>(random()) & can::extended_id_mask, .size = 8};
    frame.data.fill(static_cast<std::uint8_t>(i));
    receiver.receive(frame, at(i * 1us));
  }
  CHECK(allocations() == constructed);
  CHECK(delivered > 0);
}

namespace {

/// Resident memory of this process in KiB.
long resident_kib() {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;) {
    if (word == "VmRSS:") {
      long kib = 0;
      status >> kib;
      return kib;
    }
  }
  return 0;
}

/// The pseudo code of the specification, word for word, with the CRC at its end: what the
/// receiver must not differ from.
class PseudoCode {
 public:
  /// The payload, where the frame completes a good transfer.
  std::optional<ByteVector> receive(const can::Frame& frame, Time now, std::uint64_t signature) {
    const auto tail = frame.data[frame.size - 1U];
    const bool first_frame = (tail & 0x80) != 0;
    const bool last_frame = (tail & 0x40) != 0;
    const bool frame_toggle = (tail & 0x20) != 0;
    const int id = tail & 0x1F;
    const bool tid_timed_out = now - this_transfer_timestamp_ > 2s;
    const bool not_previous_tid = ((current_transfer_id_ - id) & 31) > 1;
    if (!initialized_ || tid_timed_out || (first_frame && not_previous_tid)) {
      initialized_ = true;
      current_transfer_id_ = id;
      payload_.clear();
      frames_ = 0;
      toggle_ = false;
      if (!first_frame) {
        current_transfer_id_ = (current_transfer_id_ + 1) % 32;
        return std::nullopt;
      }
    }
    if (frame_toggle != toggle_ || id != current_transfer_id_) {
      return std::nullopt;
    }
    if (first_frame) {
      this_transfer_timestamp_ = now;
    }
    toggle_ = !toggle_;
    payload_.insert(payload_.end(), frame.data.begin(), frame.data.begin() + frame.size - 1);
    ++frames_;
    if (!last_frame) {
      return std::nullopt;
    }
    const auto result = frames_ == 1 && first_frame ? std::optional(payload_) : checked(signature);
    current_transfer_id_ = (current_transfer_id_ + 1) % 32;
    toggle_ = false;
    payload_.clear();
    frames_ = 0;
    return result;
  }

 private:
  [[nodiscard]] std::optional<ByteVector> checked(std::uint64_t signature) const {
    if (payload_.size() < 2) {
      return std::nullopt;
    }
    const ByteVector payload(payload_.begin() + 2, payload_.end());
    const auto crc = payload_[0] | (payload_[1] << 8);
    return crc16(payload, base_crc(signature)) == crc ? std::optional(payload) : std::nullopt;
  }

  bool initialized_ = false;
  Time this_transfer_timestamp_;
  int current_transfer_id_ = 0;
  bool toggle_ = false;
  ByteVector payload_;
  int frames_ = 0;
};

/// Full frames of true transfers of a few lengths, by a sender and a bus that do everything wrong.
class BadSender {
 public:
  explicit BadSender(unsigned seed) : random_(seed) {}

  std::vector<can::Frame> next() {
    if (chance(70)) {
      id_ = static_cast<TransferId>((id_ + (chance(85) ? 1U : random_() % 32)) % 32);
    }
    auto frames =
        transfer(message_from(5), id_, random_() % 25, static_cast<std::uint8_t>(random_()));
    const auto any = [this, &frames] {
      return frames.begin() + static_cast<std::ptrdiff_t>(random_() % frames.size());
    };
    if (chance(15)) {
      frames.erase(any());
    }
    if (chance(15) && !frames.empty()) {
      const auto frame = *any();
      frames.insert(any(), frame);
    }
    if (chance(5) && !frames.empty()) {
      std::iter_swap(any(), any());
    }
    if (chance(5) && !frames.empty()) {
      auto& frame = *any();
      frame.data[frame.size - 1U] ^= static_cast<std::uint8_t>(1U << (random_() % 8));
    }
    return frames;
  }

  /// Between two frames: mostly short.
  Duration pause() { return chance(97) ? 200us : Duration(random_() % 3'000'000); }

 private:
  bool chance(unsigned percent) { return random_() % 100 < percent; }

  std::mt19937 random_;
  TransferId id_ = 0;
};

} // namespace

TEST_CASE("a receiver agrees with the pseudo code of the specification, whatever comes") {
  for (unsigned seed = 0; seed < 200; ++seed) {
    INFO("seed " << seed);
    BadSender sender(seed);
    PseudoCode model;
    Ear ear;
    Payloads expected;
    Duration now{};
    for (int i = 0; i < 200; ++i) {
      for (const auto& frame : sender.next()) {
        now += sender.pause();
        ear.hear(frame, now);
        if (const auto payload = model.receive(frame, at(now), ActuatorStatus::type.signature)) {
          expected.push_back(hex(*payload));
        }
      }
    }
    REQUIRE(ear.payloads() == expected);
  }
}

TEST_CASE("a large receiver costs memory only where transfers of several frames are heard") {
  constexpr std::size_t sessions = 32'768; // 32 MiB of buffers
  const auto before = resident_kib();
  Receiver receiver(sessions, listener, {});
  for (std::uint16_t type = 0; type < 1000; ++type) {
    receiver.receive(transfer(message_from(5, type), 0, 4).front(), at(0s));
  }
  CHECK(resident_kib() - before < 4096);
}
