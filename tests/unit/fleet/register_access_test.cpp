#include "blactl/fleet/bus/register_access.hpp"

#include "support.hpp"

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

namespace {

constexpr bla::Address angle_limit_cw{0x38};
constexpr NodeId server{11};
constexpr bla::Width int16{.bits = 16};

} // namespace

TEST_CASE("registers are read and written by name, as patiently as asked for", "[requirement-68]") {
  const auto read = read_register(server, angle_limit_cw, {.timeout = 70ms, .retries = 5});
  CHECK(text(read) == "read 0x38");
  CHECK(read.server == server);
  CHECK(read.timeout == 70ms);
  CHECK(read.retries == 5);
  CHECK(read.priority == 30);
  CHECK(text(write_register(server, angle_limit_cw, -900, {})) == "write 0x38=-900");
}

TEST_CASE("an answer bears the register's name, or says nothing at all") {
  const auto question = read_register(server, angle_limit_cw, {});
  const auto accepts = [&](GetSet::Value value, const char* name) {
    return question.accepts(
        GetSet::Response{.value = std::move(value), .name = name}.encode().bytes());
  };
  CHECK(accepts(std::int64_t{5}, "0x38"));
  CHECK(accepts({}, "0x38"));
  CHECK(accepts({}, "")); // a failure
  CHECK_FALSE(accepts(std::int64_t{5}, "0x39"));
  CHECK_FALSE(accepts(std::int64_t{5}, ""));
  CHECK_FALSE(accepts({}, "0x39"));
  CHECK_FALSE(accepts(std::int64_t{5}, "0X38"));
  CHECK_FALSE(question.accepts({}));
}

TEST_CASE("only an integer is a register's value", "[requirement-72]") {
  Script script;
  const auto value = [&](GetSet::Value held) {
    return register_value(script.value("0x38", std::move(held)), server, angle_limit_cw, int16);
  };
  CHECK(value(std::int64_t{-5}) == -5);
  for (const GetSet::Value& other : {GetSet::Value{}, GetSet::Value{1.5F}, GetSet::Value{true},
                                     GetSet::Value{std::string("900")}}) {
    const auto refused = value(other);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == Code::refused);
    CHECK(refused.error().node_id == 11);
    const bool is_empty = std::holds_alternative<GetSet::Empty>(other);
    CHECK((refused.error().message.find("refuses 0x38") != std::string::npos) == is_empty);
  }
}

TEST_CASE("a number that the register cannot hold is no value of it, and is never cut to one") {
  Script script;
  const auto value = [&](std::int64_t wire, bla::Width width) {
    return register_value(script.value("0x38", wire), server, angle_limit_cw, width);
  };
  CHECK(value(-900, int16) == -900);
  CHECK(value(0xFC7C, int16) == -900); // the same without a sign
  CHECK(value(255, {.bits = 8, .is_signed = false}) == 255);
  CHECK(value(-1, {.bits = 8, .is_signed = false}) == 255);
  for (const std::int64_t wide :
       {(std::int64_t{1} << 32) + 900, std::int64_t{65'536}, std::int64_t{-32'769}}) {
    const auto refused = value(wide, int16);
    REQUIRE_FALSE(refused);
    CHECK(refused.error().code == Code::refused);
    CHECK(refused.error().message.find("not a value of that register") != std::string::npos);
  }
  CHECK_FALSE(value(999, {.bits = 8, .is_signed = false}));
}

TEST_CASE("what stands behind an outcome without an answer") {
  const auto code = [](const Outcome& outcome) {
    return register_value(outcome, server, angle_limit_cw, int16).error().code;
  };
  CHECK(code(Script::timed_out()) == Code::timeout);
  CHECK(code(Script::not_sent()) == Code::no_acknowledge);
  CHECK(code(Script::cancelled()) == Code::interrupted);
  CHECK(code({Outcome::Kind::not_recorded, {}, {}}) == Code::not_recorded);
  const Error error = no_answer(Script::timed_out(), server, "0x38");
  CHECK(error.message.find("0x38") != std::string::npos);
  CHECK(error.message.find("11") != std::string::npos);
  CHECK_FALSE(error.hint.empty());
}
