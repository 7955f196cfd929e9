#include "blactl/dronecan/answer_watch.hpp"

#include "catch.hpp"
#include "support.hpp"

#include <algorithm>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace blactl;
using namespace blactl::dronecan;
using namespace blactl::dronecan::test;

namespace {

using Frames = std::vector<can::Frame>;

/// The answer of a unit to a question with this transfer ID.
Frames answer(std::uint8_t unit, TransferId id, std::uint8_t client = 127,
              std::uint8_t server = 11) {
  const Header header{.kind = Kind::response,
                      .priority = 30,
                      .data_type_id = GetNodeInfo::type.id,
                      .source = NodeId(server),
                      .destination = NodeId(client)};
  const auto payload = GetNodeInfo::Response{.unique_id = {unit}, .name = "servo"}.encode();
  return segment(header, id, GetNodeInfo::type.signature, payload.bytes());
}

/// The answer to a question for a parameter.
Frames value(const char* name, std::int64_t value, TransferId id) {
  const Header header{.kind = Kind::response,
                      .priority = 30,
                      .data_type_id = GetSet::type.id,
                      .source = NodeId(11),
                      .destination = NodeId(127)};
  const auto payload = GetSet::Response{.value = value, .name = name}.encode();
  return segment(header, id, GetSet::type.signature, payload.bytes());
}

/// A watch that writes down whom it reports.
struct Watch {
  void hear(const Frames& frames, Duration when = {}) {
    for (const can::Frame& frame : frames) {
      watch.receive(*decode_id(frame.id), frame, at(when));
    }
  }

  std::vector<std::string> reports; ///< "11: 1 2"
  AnswerWatch watch{{"0x38", "0x50", "0x51"}, [this](NodeId id, const std::set<UniqueId>& units) {
                      std::string report = fmt::format("{}:", id.value());
                      for (const UniqueId& unit : units) {
                        report += fmt::format(" {}", unit[0]);
                      }
                      reports.push_back(report);
                    }};
};

using Reports = std::vector<std::string>;

} // namespace

TEST_CASE("one question that two units answer shows both") {
  Watch watch;
  watch.hear(answer(1, 5));
  CHECK(watch.reports.empty());
  watch.hear(answer(2, 5), 3ms);
  CHECK(watch.reports == Reports{"11: 1 2"});
}

TEST_CASE("the second answer may come after answers to later questions") {
  Watch watch;
  watch.hear(answer(1, 5));
  watch.hear(answer(1, 6), 10ms);
  watch.hear(answer(1, 7), 20ms);
  watch.hear(answer(2, 5), 30ms);
  CHECK(watch.reports == Reports{"11: 1 2"});
}

TEST_CASE("an answer that is repeated is of the same unit") {
  Watch watch;
  watch.hear(answer(1, 5));
  watch.hear(answer(1, 5), 3ms);
  CHECK(watch.reports.empty());
}

TEST_CASE("other questions, other clients and other servers have answers of their own") {
  Watch watch;
  watch.hear(answer(1, 5));
  SECTION("another question: the unit may have been replaced since") {
    watch.hear(answer(2, 6), 3ms);
  }
  SECTION("another client") {
    watch.hear(answer(2, 5, 126), 3ms);
  }
  SECTION("another server") {
    watch.hear(answer(2, 5, 127, 12), 3ms);
  }
  CHECK(watch.reports.empty());
}

TEST_CASE("a transfer ID comes again after 2 s: that is another question") {
  Watch watch;
  watch.hear(answer(1, 5));
  watch.hear(answer(2, 5), 2s);
  CHECK(watch.reports.empty());
  watch.hear(answer(1, 5), 2s + 1999ms);
  CHECK(watch.reports == Reports{"11: 1 2"});
}

TEST_CASE("answers whose frames mix are of two units, which nobody can read") {
  Watch watch;
  const Frames one = answer(1, 5);
  const Frames other = answer(2, 5);
  REQUIRE(one.size() == other.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    watch.hear({one[i], other[i]});
  }
  CHECK(watch.reports == Reports{"11:"});
  watch.hear(answer(1, 6), 10ms);
  watch.hear(answer(2, 6), 20ms);
  CHECK(watch.reports == Reports{"11:", "11: 1 2"});
}

TEST_CASE("frames that come twice, and answers that are never ended, are of one unit") {
  Watch watch;
  Frames one = answer(1, 5);
  SECTION("each frame comes twice") {
    for (const can::Frame& frame : one) {
      watch.hear({frame, frame});
    }
  }
  SECTION("the next answer is to another question") {
    one.pop_back();
    watch.hear(one);
    watch.hear(answer(1, 6), 3ms);
  }
  SECTION("or to another client") {
    one.pop_back();
    watch.hear(one);
    watch.hear(answer(1, 5, 126), 3ms);
  }
  SECTION("or to the question that has this transfer ID the next time") {
    one.pop_back();
    watch.hear(one);
    watch.hear(answer(2, 5), 2s);
  }
  CHECK(watch.reports.empty());
}

TEST_CASE("an answer that is not whole, or not sound, is none") {
  Watch watch;
  watch.hear(answer(1, 5));
  Frames other = answer(2, 5);
  SECTION("a frame is missing") {
    other.erase(other.begin() + 2);
  }
  SECTION("the first one is missing") {
    other.erase(other.begin());
  }
  SECTION("the last one is missing") {
    other.pop_back();
  }
  SECTION("a byte is another one") {
    other[2].data[0] ^= 1U;
  }
  watch.hear(other, 3ms);
  CHECK(watch.reports.empty());
}

TEST_CASE("a frame that comes twice counts once") {
  Watch watch;
  Frames one = answer(1, 5);
  one.insert(one.begin() + 2, one[2]);
  watch.hear(one);
  watch.hear(answer(2, 5), 3ms);
  CHECK(watch.reports == Reports{"11: 1 2"});
}

TEST_CASE("two values of a parameter that does not change by itself are of two units") {
  Watch watch;
  SECTION("in answers to one question") {
    watch.hear(value("0x51", 1, 5));
    watch.hear(answer(1, 5), 1ms); // another question, with transfer IDs of its own
    watch.hear(value("0x51", 2, 5), 3ms);
    CHECK(watch.reports == Reports{"11:"});
  }
  SECTION("a repeated answer is of the same unit") {
    watch.hear(value("0x51", 1, 5));
    watch.hear(value("0x51", 1, 5), 3ms);
    CHECK(watch.reports.empty());
  }
  SECTION("in answers to two questions: the unit may have been replaced") {
    watch.hear(value("0x51", 1, 5));
    watch.hear(value("0x51", 2, 6), 3ms);
    CHECK(watch.reports.empty());
  }
  SECTION("another parameter has another value") {
    watch.hear(value("0x50", 1, 5));
    watch.hear(value("0x51", 2, 5), 70ms);
    CHECK(watch.reports.empty());
  }
  SECTION("a measured value may be another one when the unit answers again") {
    watch.hear(value("0x08", 1, 5));
    watch.hear(value("0x08", 2, 5), 3ms);
    CHECK(watch.reports.empty());
  }
  SECTION("what is set may be set anew until the transfer ID comes again") {
    watch.hear(value("0x38", 1, 5));
    watch.hear(value("0x08", 0, 23), 50ms); // others were asked, and not all of them answered
    watch.hear(value("0x38", 2, 5), 70ms);
    CHECK(watch.reports.empty());
  }
}

TEST_CASE("frames of any bytes are heard without harm, and an endless answer fills no memory") {
  Watch watch;
  const auto id = answer(1, 5).front().id;
  std::minstd_rand random(7);
  const auto byte = [&random] { return static_cast<std::uint8_t>(random() >> 8U); };
  for (int i = 0; i < 20'000; ++i) {
    can::Frame frame{.id = id, .size = static_cast<std::uint8_t>(1 + byte() % 8)};
    std::ranges::generate(frame.data, byte);
    watch.hear({frame});
  }
  can::Frame frame{.id = id, .size = 8, .data = {}};
  for (unsigned i = 0; i < 1000; ++i) {
    frame.data[7] = static_cast<std::uint8_t>((i == 0 ? 0x80U : 0U) | (i % 2) << 5U | 9U);
    watch.hear({frame});
  }
  CHECK(std::ranges::all_of(watch.reports, [](const std::string& told) { return told == "11:"; }));
  watch.hear(answer(1, 6));
  watch.reports.clear();
  watch.hear(answer(1, 5));
  watch.hear(answer(2, 5), 3ms);
  CHECK(watch.reports == Reports{"11: 1 2"});
}
