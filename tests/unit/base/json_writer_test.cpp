#include "blactl/base/json_writer.hpp"

#include "catch.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>

using blactl::JsonWriter;

namespace {

/// What `write` appends, compact.
template <class Write> std::string written(Write write) {
  std::string out;
  JsonWriter json(out);
  write(json);
  return out;
}

std::string text(std::string_view content) {
  return written([&](JsonWriter& json) { json.value(content); });
}

template <class T>
concept Writable = requires(JsonWriter& json, T content) { json.value(content); };

} // namespace

TEST_CASE("objects and arrays, empty and nested, with commas where they belong") {
  CHECK(written([](JsonWriter& json) {
          json.begin_object();
          json.member("a", 1);
          json.key("b");
          json.begin_array();
          json.value("x");
          json.begin_object();
          json.end_object();
          json.begin_array();
          json.end_array();
          json.value(nullptr);
          json.end_array();
          json.member("c", true);
          json.end_object();
        }) == R"({"a":1,"b":["x",{},[],null],"c":true})");
}

TEST_CASE("pretty output has one member a line, and ends without a line break") {
  std::string out;
  JsonWriter json(out, JsonWriter::Layout::pretty);
  json.begin_object();
  json.member("a", 1);
  json.key("b");
  json.begin_array();
  json.value(2);
  json.value(3);
  json.end_array();
  json.key("c");
  json.begin_object();
  json.end_object();
  json.end_object();
  CHECK(out == "{\n  \"a\": 1,\n  \"b\": [\n    2,\n    3\n  ],\n  \"c\": {}\n}");
}

TEST_CASE("text is escaped where JSON or a terminal would stumble") {
  CHECK(text(R"(a"b\c/)") == R"("a\"b\\c/")");
  CHECK(text("\n\r\t\x1b\x7f") == R"("\n\u000d\u0009\u001b\u007f")");
  CHECK(text(std::string_view("\0", 1)) == R"("\u0000")");
  CHECK(text("角度 90°") == "\"角度 90°\"");
  CHECK(written([](JsonWriter& json) {
          json.begin_object();
          json.member("a\"b", "");
          json.end_object();
        }) == R"({"a\"b":""})");
}

TEST_CASE("what a terminal obeys or text hides in is escaped, and read back") {
  CHECK(text("\u009b31m") == R"("\u009b31m")");
  CHECK(text("a\u202eb\ufeff\u2066") == R"("a\u202eb\ufeff\u2066")");
  CHECK(text("é角😀") == "\"é角😀\"");
}

TEST_CASE("text that is no UTF-8 is valid JSON all the same") {
  CHECK(text("a\xFFz") == "\"a\uFFFDz\"");
  CHECK(text("\xE8\xA7") == "\"\uFFFD\uFFFD\"");
  CHECK(text("\xC0\x80\xED\xA0\x80") == "\"\uFFFD\uFFFD\uFFFD\uFFFD\uFFFD\"");
}

TEST_CASE("whatever bytes a text has, a parser reads it") {
  std::string all;
  for (int first = 0; first < 256; ++first) {
    for (int second = 0; second < 256; second += 5) {
      all += static_cast<char>(first);
      all += static_cast<char>(second);
    }
  }
  CHECK(nlohmann::json::accept(text(all)));
}

TEST_CASE("integers of every width, up to their limits") {
  CHECK(written([](JsonWriter& json) {
          json.begin_array();
          json.value(std::uint8_t{255});
          json.value(std::int8_t{-128});
          json.value(std::numeric_limits<std::int64_t>::min());
          json.value(std::numeric_limits<std::uint64_t>::max());
          json.end_array();
        }) == "[255,-128,-9223372036854775808,18446744073709551615]");
}

TEST_CASE("what is not there is null, and numbers may be text already") {
  CHECK(written([](JsonWriter& json) {
          json.begin_array();
          json.value(std::optional<int>());
          json.value(std::optional<int>(5));
          json.value(std::optional<std::string>("x"));
          json.number("90.0");
          json.end_array();
        }) == R"([null,5,"x",90.0])");
}

TEST_CASE("a real number is read back as just itself, and what is none is null") {
  const auto real = [](double number) {
    std::string out;
    JsonWriter(out).real(number);
    return out;
  };
  CHECK(real(0.5) == "0.5");
  CHECK(real(-0.1F) == "-0.10000000149011612");
  CHECK(real(65504) == "65504");
  CHECK(real(5.960464477539063e-08) == "5.960464477539063e-08");
  CHECK(real(std::numeric_limits<double>::quiet_NaN()) == "null");
  CHECK(real(-std::numeric_limits<double>::infinity()) == "null");
}

TEST_CASE("nothing becomes true or false by accident") {
  STATIC_REQUIRE(Writable<bool>);
  STATIC_REQUIRE(Writable<std::string>);
  STATIC_REQUIRE_FALSE(Writable<double>);
  STATIC_REQUIRE_FALSE(Writable<int*>);
}
