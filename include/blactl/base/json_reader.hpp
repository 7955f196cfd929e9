#pragma once
// Strict reading of JSON files: each fault is reported with its line, JSON pointer and reason.
//
//   auto document = json::parse_file(path);
//   if (!document) { return std::unexpected(document.error()); }
//   json::Object root(document->root(), document->faults());
//   const std::string name = root.string("name");
//   const auto count = root.optional_integer("count", 1, 125).value_or(1);
//   for (const json::Value* item : root.array("servos")) {
//     json::Object servo(*item, document->faults());
//     …
//     servo.finish(); // keys that nobody asked for are faults
//   }
//   root.finish();
//   if (auto fine = document->faults().result(); !fine) { return std::unexpected(fine.error()); }
//
// A reader asks for every key it knows and continues after a fault: a missing or wrong value reads
// as empty and adds one fault. Only result(), at the end, decides whether the values may be used.

#include "blactl/base/error.hpp"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::json {

/// Larger files are refused unread, deeper nesting is a fault.
inline constexpr std::size_t max_file_bytes = 4U << 20U;
inline constexpr std::size_t max_depth = 32;

enum class Kind : std::uint8_t { null, boolean, integer, real, string, array, object };

/// A value of a file and its position. Lives as long as its Document, which may be moved.
struct Value {
  Kind kind = Kind::null;
  std::size_t line = 0;              ///< where the value begins; the first line is 1
  std::size_t begin = 0, end = 0;    ///< its bytes in the text; not of an array or an object
  const Value* parent = nullptr;     ///< the array or object around it; null for the document
  std::size_t index = 0;             ///< its place in an array
  std::string key{};                 ///< its key in an object
  bool boolean = false;              ///< Kind::boolean
  std::int64_t integer = 0;          ///< Kind::integer, exact
  double real = 0;                   ///< Kind::real, and the nearest double of an integer
  std::string text{};                ///< Kind::string; of a real its digits as in the file
  std::vector<const Value*> items{}; ///< of an array or an object, in the order of the file

  /// RFC 6901: "/servos/0/set"; "" is the whole document.
  [[nodiscard]] std::string pointer() const;
};

/// The faults found in one file.
class Faults {
 public:
  explicit Faults(std::string file) : file_(std::move(file)) {}

  /// `reason` in the language of the session; it may hold foreign text.
  void add(const Value& where, std::string reason) {
    add(where.line, where.pointer(), std::move(reason));
  }

  void add(std::size_t line, std::string pointer, std::string reason);

  [[nodiscard]] const std::string& file() const { return file_; }

  [[nodiscard]] bool empty() const { return faults_.empty(); }

  /// Whether there are more than anybody wants to know: what compares all with all may end.
  [[nodiscard]] bool are_many() const { return faults_.size() >= many; }

  /// Errors: bad_file; the message has a line "FILE:LINE: /json/pointer: reason" for every fault,
  /// in file order (if there are too many: the first hundred and the number of the others).
  [[nodiscard]] Result<void> result() const;

 private:
  struct Fault {
    std::size_t line;
    std::string pointer;
    std::string reason;
  };

  static constexpr std::size_t many = 10'000;

  std::string file_;
  std::vector<Fault> faults_;
};

/// A file that is JSON (RFC 8259, UTF-8). Duplicate keys, integers beyond 64 bits and nesting that
/// is too deep are among its faults from the start.
class Document {
 public:
  /// `values` begins with the whole document; values point to each other and never move.
  Document(std::unique_ptr<const std::deque<Value>> values, Faults faults)
      : values_(std::move(values)), faults_(std::move(faults)) {}

  [[nodiscard]] const Value& root() const { return values_->front(); }

  [[nodiscard]] Faults& faults() { return faults_; }

 private:
  std::unique_ptr<const std::deque<Value>> values_;
  Faults faults_;
};

/// `file` is the name for messages. Errors: bad_file (not JSON, not UTF-8, larger than allowed).
[[nodiscard]] Result<Document> parse(std::string_view text, std::string file);

/// "-" reads stdin. Errors: as parse(); bad_file with the system's reason if it cannot be read.
[[nodiscard]] Result<Document> parse_file(const std::filesystem::path& path);

inline constexpr std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
inline constexpr std::int64_t highest = std::numeric_limits<std::int64_t>::max();

// One value as a type; empty, with a fault, if it is of another type or outside min..max.
[[nodiscard]] std::optional<std::string> as_string(const Value& value, Faults& faults);
[[nodiscard]] std::optional<std::int64_t> as_integer(const Value& value, Faults& faults,
                                                     std::int64_t min = lowest,
                                                     std::int64_t max = highest);
[[nodiscard]] std::optional<double> as_number(const Value& value, Faults& faults, double min,
                                              double max);
[[nodiscard]] std::optional<bool> as_boolean(const Value& value, Faults& faults);

/// One object of a file, read key by key.
class Object {
 public:
  /// A value that is not an object is one fault; reading keys from it adds no others.
  Object(const Value& value, Faults& faults);

  /// False: the value is not an object, or its key is missing.
  [[nodiscard]] bool exists() const { return value_ != nullptr; }

  /// For faults that concern the object as a whole. Requires exists().
  [[nodiscard]] const Value& value() const { return *value_; }

  /// Whether the key is present; does not count as asking for it.
  [[nodiscard]] bool has(std::string_view key) const;

  // Required keys. Missing or wrong: adds a fault and returns "", 0, false or no items.
  [[nodiscard]] std::string string(std::string_view key);
  /// One of `words`, exactly.
  [[nodiscard]] std::string word(std::string_view key,
                                 std::initializer_list<std::string_view> words);
  [[nodiscard]] std::int64_t integer(std::string_view key, std::int64_t min = lowest,
                                     std::int64_t max = highest);
  /// An integer or a real.
  [[nodiscard]] double number(std::string_view key, double min, double max);
  [[nodiscard]] bool boolean(std::string_view key);
  [[nodiscard]] std::span<const Value* const> array(std::string_view key);
  [[nodiscard]] Object object(std::string_view key);
  /// A value of any kind, for example a number or a string. Missing: a fault and null.
  [[nodiscard]] const Value* any(std::string_view key);

  // Optional keys; a value of the wrong kind or out of range is still a fault.
  [[nodiscard]] std::optional<std::string> optional_string(std::string_view key);
  [[nodiscard]] std::optional<std::string>
  optional_word(std::string_view key, std::initializer_list<std::string_view> words);
  [[nodiscard]] std::optional<std::int64_t>
  optional_integer(std::string_view key, std::int64_t min = lowest, std::int64_t max = highest);
  [[nodiscard]] std::optional<double> optional_number(std::string_view key, double min, double max);
  [[nodiscard]] std::optional<bool> optional_boolean(std::string_view key);
  /// No items if absent.
  [[nodiscard]] std::span<const Value* const> optional_array(std::string_view key);
  /// Not exists() if absent.
  [[nodiscard]] Object optional_object(std::string_view key);
  /// Null if absent.
  [[nodiscard]] const Value* optional_any(std::string_view key);

  /// All members, for objects whose keys are data (`key` of each); all of them count as asked for.
  [[nodiscard]] std::span<const Value* const> members();

  /// Adds a fault for every key that was not asked for.
  void finish();

 private:
  explicit Object(Faults& faults) : faults_(&faults) {} ///< for a missing key

  const Value* value_ = nullptr;
  Faults* faults_;
  std::vector<const Value*> asked_;
  std::vector<std::string> known_; ///< keys asked for, to name them beside an unknown one
};

} // namespace blactl::json
