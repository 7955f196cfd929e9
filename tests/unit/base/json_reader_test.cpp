#include "blactl/base/json_reader.hpp"
#include "blactl/base/text.hpp"

#include "catch.hpp"

#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>

using namespace blactl;
using json::Kind;

namespace {

/// All faults of a text that is read as JSON and no further.
std::string faults(std::string_view text) {
  auto document = json::parse(text, "f.json");
  const auto result = document ? document->faults().result() : std::unexpected(document.error());
  if (!result) {
    CHECK(result.error().code == Code::bad_file);
    CHECK_FALSE(result.error().hint.empty());
  }
  return result ? "" : result.error().message;
}

json::Document parsed(std::string_view text) {
  auto document = json::parse(text, "f.json");
  REQUIRE(document);
  return std::move(*document);
}

std::string message(json::Document& document) {
  const auto result = document.faults().result();
  return result ? "" : result.error().message;
}

/// A file that goes with the test.
class File {
 public:
  explicit File(const std::string& text) {
    std::string name = (std::filesystem::temp_directory_path() / "blactl-test-XXXXXX").string();
    const int descriptor = mkstemp(name.data());
    REQUIRE(descriptor >= 0);
    close(descriptor);
    path_ = name;
    std::ofstream(path_, std::ios::binary) << text;
  }

  File(const File&) = delete;
  File& operator=(const File&) = delete;

  ~File() { std::filesystem::remove(path_); }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

} // namespace

TEST_CASE("values keep their kind, exact number, text, line and place") {
  const json::Document document = parsed("{\n"
                                         "  \"a\": 1,\n"
                                         "  \"b\": [true,\n"
                                         "    -2.50,\n"
                                         "    null\n"
                                         "  ],\n"
                                         "  \"c/d~e\": {\"\": \"原点\\n\"}\n"
                                         "}\n");
  const json::Value& root = document.root();
  CHECK(root.kind == Kind::object);
  CHECK(root.pointer().empty());
  REQUIRE(root.items.size() == 3);
  const json::Value& a = *root.items[0];
  CHECK(a.kind == Kind::integer);
  CHECK(a.integer == 1);
  CHECK(a.real == 1.0);
  CHECK(a.line == 2);
  CHECK(a.pointer() == "/a");
  const json::Value& b = *root.items[1];
  CHECK(b.line == 3);
  REQUIRE(b.items.size() == 3);
  CHECK(b.items[0]->boolean);
  CHECK(b.items[0]->line == 3);
  CHECK(b.items[1]->kind == Kind::real);
  CHECK(b.items[1]->real == -2.5);
  CHECK(b.items[1]->text == "-2.50");
  CHECK(b.items[1]->line == 4);
  CHECK(b.items[1]->pointer() == "/b/1");
  CHECK(b.items[2]->kind == Kind::null);
  CHECK(b.items[2]->line == 5);
  const json::Value& inner = *root.items[2]->items[0];
  CHECK(inner.text == "原点\n");
  CHECK(inner.line == 7);
  CHECK(inner.pointer() == "/c~1d~0e/");
}

TEST_CASE("the line of a number at the end of a line is its own") {
  const json::Document document = parsed("[\n1\n,\n2.5\n,\n3]");
  CHECK(document.root().items[0]->line == 2);
  CHECK(document.root().items[1]->line == 4);
  CHECK(document.root().items[2]->line == 6);
}

TEST_CASE("a document may be moved") {
  json::Document first = parsed(R"({"a": ["b"]})");
  const json::Document second = std::move(first);
  CHECK(second.root().items[0]->items[0]->text == "b");
  CHECK(second.root().items[0]->items[0]->pointer() == "/a/0");
}

TEST_CASE("integers of 64 bits are exact, larger ones are faults") {
  const json::Document document =
      parsed("[9223372036854775807, -9223372036854775808, 9007199254740993, -0]");
  CHECK(document.root().items[0]->integer == std::numeric_limits<std::int64_t>::max());
  CHECK(document.root().items[1]->integer == std::numeric_limits<std::int64_t>::min());
  CHECK(document.root().items[2]->integer == 9007199254740993);
  CHECK(document.root().items[3]->integer == 0);
  CHECK(faults("[9223372036854775808]") ==
        "f.json:1: /0: 9223372036854775808 does not fit in 64 bits");
  CHECK(faults("[1,\n-99999999999999999999999]") ==
        "f.json:2: /1: -99999999999999999999999 does not fit in 64 bits");
}

TEST_CASE("what is not JSON is told with its line") {
  const std::pair<const char*, const char*> cases[] = {
      {"", "f.json:1: /: not valid JSON: "},
      {"   \n ", "f.json:2: /: not valid JSON: "},
      {"{\"a\": 1,}", "f.json:1: /: not valid JSON: "},
      {"{\"a\": [1,\n 2\n 3]}", "f.json:3: /a: not valid JSON: "},
      {"{'a': 1}", "f.json:1: /: not valid JSON: "},
      {"[01]", "f.json:1: /: not valid JSON: "},
      {"[1.]", "f.json:1: /: not valid JSON: "},
      {"[+1]", "f.json:1: /: not valid JSON: "},
      {"[NaN]", "f.json:1: /: not valid JSON: "},
      {"[Infinity]", "f.json:1: /: not valid JSON: "},
      {"[1e999]", "f.json:1: /: not valid JSON: "},
      {"[] []", "f.json:1: /: not valid JSON: "},
      {"[\"a\nb\"]", "f.json:"},
      {"[] // comment", "f.json:1: /: not valid JSON: "},
      {"[\"\\ud800\"]", "f.json:1: /: not valid JSON: "},
      {"[\"a", "f.json:1: /: not valid JSON: "},
  };
  for (const auto& [text, beginning] : cases) {
    INFO(text);
    const std::string found = faults(text);
    INFO(found);
    CHECK(found.starts_with(beginning));
    CHECK(found.find("json.exception") == std::string::npos);
  }
}

TEST_CASE("what is wrong with a file that is not JSON is told by its name and line") {
  const std::pair<const char*, const char*> cases[] = {
      {"{\"a\": 1,\n}",
       "f.json:1: /: not valid JSON: trailing comma: there must be none after the last item"},
      {"{\"a\": [1,\n2 ,\n\n]}",
       "f.json:2: /a: not valid JSON: trailing comma: there must be none after the last item"},
      {"{\"a\": 1\n\"b\": 2}", "f.json:2: /: not valid JSON: a comma is missing before \"b\""},
      {"[1\n2]", "f.json:2: /: not valid JSON: a comma is missing before 2"},
      {"[1 true]", "f.json:1: /: not valid JSON: a comma is missing before true"},
      {"[{} {}]", "f.json:1: /: not valid JSON: a comma is missing before {"},
      {"[01]", "f.json:1: /: not valid JSON: 01 does not belong here"},
      {"[1.]", "f.json:1: /: not valid JSON: 1. does not belong here"},
      {"[NaN]", "f.json:1: /: not valid JSON: NaN does not belong here"},
      {"[1e999]", "f.json:1: /: not valid JSON: 1e999 does not belong here"},
      {"[] []", "f.json:1: /: not valid JSON: [ does not belong here"},
      {"[1}", "f.json:1: /: not valid JSON: } does not belong here"},
      {"[,1]", "f.json:1: /: not valid JSON: , does not belong here"},
      {"{\"a\" 1}", "f.json:1: /: not valid JSON: a colon is missing between a key and its value"},
      {"{'a': 1}", "f.json:1: /: not valid JSON: keys and strings need double quotes"},
      {"{a: 1}", "f.json:1: /: not valid JSON: keys and strings need double quotes"},
      {"{\n// all\n}", "f.json:2: /: not valid JSON: JSON has no comments"},
      {"[\n\"a\nb\"]", "f.json:2: /: not valid JSON: a string does not end in its line"},
      {"[\"\\q\"]", "f.json:1: /: not valid JSON: a wrong escape sequence (\\) in a string"},
      {"[1,", "f.json:1: /: not valid JSON: the file ends before it is complete"},
      {"", "f.json:1: /: not valid JSON: the file ends before it is complete"},
  };
  for (const auto& [text, told] : cases) {
    INFO(text);
    CHECK(faults(text) == told);
  }
  set_language(Language::japanese);
  const std::string japanese = faults("[1,\n]");
  set_language(Language::english);
  CHECK(japanese == "f.json:1: /: JSON として正しくありません: "
                    "末尾のカンマが余分です (最後の項目の後には不要)");
}

TEST_CASE("bad UTF-8 and zero bytes are faults, and reach nobody's terminal") {
  for (const std::string text : {"[\"\xFF\"]", "[\"\xC0\xAF\"]", "[\"\xED\xA0\x80\"]", "\xFF"}) {
    const std::string found = faults(text);
    CHECK(found.starts_with("f.json:1: /: not valid JSON: "));
    CHECK(found.find(text[0] == '[' ? text[2] : text[0]) == std::string::npos);
  }
  CHECK(faults(std::string_view("{}\0[1]", 6)) ==
        "f.json:1: /: not valid JSON: it contains a zero byte");
  CHECK(faults("[\"\x1B[31m\"]").find('\x1B') == std::string::npos);
}

TEST_CASE("keys that occur twice are all told") {
  CHECK(faults("{\"a\": 1,\n\"b\": {\"c\": 1,\n\"c\": 2},\n\"a\": 3,\n\"a\": 4}") ==
        "f.json:3: /b/c: this key occurs twice; it is also in line 2\n"
        "f.json:4: /a: this key occurs twice; it is also in line 1\n"
        "f.json:5: /a: this key occurs twice; it is also in line 4");
}

TEST_CASE("nesting has a limit") {
  const auto nested = [](std::size_t depth) {
    return std::string(depth, '[') + std::string(depth, ']');
  };
  CHECK(faults(nested(json::max_depth)).empty());
  CHECK(faults(nested(json::max_depth + 1)).find("nested deeper than 32 levels") !=
        std::string::npos);
  CHECK(faults(std::string(1'000'000, '[')).find("nested deeper") != std::string::npos);
}

TEST_CASE("a hopeless file is not listed to its end") {
  std::string text = "{";
  for (int i = 0; i < 1000; ++i) {
    text += "\"a\": 1,\n";
  }
  const std::string found = faults(text + "\"a\": 1}");
  CHECK(std::count(found.begin(), found.end(), '\n') == 100);
  CHECK(found.ends_with("\n… and 900 more"));
}

TEST_CASE("objects give what is asked for") {
  json::Document document = parsed(
      R"({"s": "x", "i": -5, "n": 2, "r": 0.5, "t": true, "a": [1, 2], "o": {"k": 1}, "w": "on"})");
  json::Object root(document.root(), document.faults());
  CHECK(root.exists());
  CHECK(root.string("s") == "x");
  CHECK(root.integer("i") == -5);
  CHECK(root.number("n", 0, 10) == 2.0);
  CHECK(root.number("r", 0, 1) == 0.5);
  CHECK(root.boolean("t"));
  CHECK(root.array("a").size() == 2);
  json::Object inner = root.object("o");
  CHECK(inner.integer("k", 1, 1) == 1);
  inner.finish();
  CHECK(root.word("w", {"on", "off"}) == "on");
  CHECK(root.has("w"));
  CHECK_FALSE(root.has("x"));
  CHECK_FALSE(root.optional_string("x"));
  CHECK_FALSE(root.optional_integer("x"));
  CHECK_FALSE(root.optional_number("x", 0, 1));
  CHECK_FALSE(root.optional_boolean("x"));
  CHECK_FALSE(root.optional_word("x", {"on"}));
  CHECK(root.optional_array("x").empty());
  CHECK_FALSE(root.optional_object("x").exists());
  CHECK(root.optional_any("x") == nullptr);
  root.finish();
  CHECK(message(document).empty());
}

TEST_CASE("every fault of a file is collected, in the order of its lines") {
  json::Document document = parsed("{\n"
                                   "\"extra\": 1,\n"
                                   "\"string\": 1,\n"
                                   "\"integer\": 1.0,\n"
                                   "\"small\": -1,\n"
                                   "\"number\": 1.5,\n"
                                   "\"boolean\": null,\n"
                                   "\"word\": \"maybe\",\n"
                                   "\"array\": {},\n"
                                   "\"object\": [],\n"
                                   "\"items\": [1, \"two\"]\n"
                                   "}");
  json::Object root(document.root(), document.faults());
  CHECK(root.string("string").empty());
  CHECK(root.integer("integer") == 0);
  CHECK_FALSE(root.optional_integer("small", 0, 5));
  CHECK(root.number("number", 0, 1) == 0);
  CHECK_FALSE(root.boolean("boolean"));
  CHECK(root.word("word", {"on", "off"}).empty());
  CHECK(root.array("array").empty());
  json::Object object = root.object("object");
  CHECK_FALSE(object.exists());
  CHECK(object.string("inside").empty()); // no further fault
  object.finish();
  for (const json::Value* item : root.array("items")) {
    static_cast<void>(json::as_string(*item, document.faults()));
  }
  CHECK(root.string("missing").empty());
  root.finish();
  CHECK(message(document) ==
        "f.json:1: /: \"missing\" is missing\n"
        "f.json:2: /extra: this key is not known; known here: string, integer, small, number, "
        "boolean, word, array, object, items, missing\n"
        "f.json:3: /string: must be a string, not an integer\n"
        "f.json:4: /integer: must be an integer, not a number\n"
        "f.json:5: /small: -1 is less than 0\n"
        "f.json:6: /number: 1.5 is more than 1\n"
        "f.json:7: /boolean: must be true or false, not null\n"
        "f.json:8: /word: \"maybe\" is none of: on, off\n"
        "f.json:9: /array: must be an array, not an object\n"
        "f.json:10: /object: must be an object, not an array\n"
        "f.json:11: /items/0: must be a string, not an integer");
}

TEST_CASE("a value of the wrong kind is told in Japanese without blanks between the words") {
  json::Document document = parsed("{\"integer\": \"1\",\n\"boolean\": null,\n\"string\": true}");
  json::Object root(document.root(), document.faults());
  set_language(Language::japanese);
  static_cast<void>(root.integer("integer"));
  static_cast<void>(root.boolean("boolean"));
  static_cast<void>(root.string("string"));
  set_language(Language::english);
  CHECK(message(document) ==
        "f.json:1: /integer: 整数でなければなりません (文字列になっています)\n"
        "f.json:2: /boolean: true または false の値でなければなりません (null 値になっています)\n"
        "f.json:3: /string: 文字列でなければなりません (true または false の値になっています)");
}

TEST_CASE("objects whose keys are data give their members") {
  json::Document document = parsed(R"({"angle_limit_cw": "90deg", "0x45": 7})");
  json::Object settings(document.root(), document.faults());
  std::string found;
  for (const json::Value* value : settings.members()) {
    found += value->key + '=' +
             (value->kind == Kind::integer ? std::to_string(value->integer) : value->text) + ' ';
  }
  CHECK(found == "angle_limit_cw=90deg 0x45=7 ");
  settings.finish();
  CHECK(message(document).empty());
}

TEST_CASE("a document that is no object is one fault") {
  json::Document document = parsed("[]");
  json::Object root(document.root(), document.faults());
  CHECK_FALSE(root.exists());
  CHECK(root.integer("a", 1, 2) == 0);
  CHECK(root.members().empty());
  root.finish();
  CHECK(message(document) == "f.json:1: /: must be an object, not an array");
}

TEST_CASE("foreign text in faults is made fit for a terminal") {
  json::Document document = parsed("{\"\\u001b[31m\": 1}");
  json::Object root(document.root(), document.faults());
  root.finish();
  CHECK(message(document) == "f.json:1: /\\x1b[31m: this key is not known; none is expected here");
}

TEST_CASE("files are read whole, and what cannot be read says why") {
  const File file("{\"a\": 1}");
  const auto document = json::parse_file(file.path());
  REQUIRE(document);
  CHECK(document->root().items[0]->integer == 1);

  const auto missing = json::parse_file("/nonexistent/a.json");
  REQUIRE_FALSE(missing);
  CHECK(missing.error().code == Code::bad_file);
  CHECK(missing.error().message == "cannot read /nonexistent/a.json: No such file or directory");

  const auto directory = json::parse_file(std::filesystem::temp_directory_path());
  REQUIRE_FALSE(directory);
  CHECK(directory.error().message.find("Is a directory") != std::string::npos);

  const File broken("[");
  const auto error = json::parse_file(broken.path());
  REQUIRE_FALSE(error);
  CHECK(error.error().message.starts_with(broken.path().string() + ":1: /: not valid JSON: "));
}

TEST_CASE("files beyond the limit are refused") {
  const std::string text = '[' + std::string(json::max_file_bytes, ' ') + ']';
  CHECK(json::parse(text, "f.json").error().message == "f.json is larger than 4 MiB");
  const File file(text);
  const auto document = json::parse_file(file.path());
  REQUIRE_FALSE(document);
  CHECK(document.error().code == Code::bad_file);
  CHECK(document.error().message.find("is larger than 4 MiB") != std::string::npos);
}

TEST_CASE("of every scalar it is known where it stands in the text") {
  const std::string text =
      "{ \"a\\\"b\" : -12,\"c\":[true ,null,\"x\\u0041\"],\r\n \"d\": {\"e\": 1.50e3}, \"f\":7}\n";
  const json::Document document = parsed(text);
  std::vector<std::string> found;
  const auto collect = [&](const auto& self, const json::Value& value) -> void {
    if (value.kind != Kind::array && value.kind != Kind::object) {
      found.push_back(text.substr(value.begin, value.end - value.begin));
    }
    for (const json::Value* item : value.items) {
      self(self, *item);
    }
  };
  collect(collect, document.root());
  CHECK(found == std::vector<std::string>{"-12", "true", "null", "\"x\\u0041\"", "1.50e3", "7"});
}
