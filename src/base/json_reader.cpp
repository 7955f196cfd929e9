// From JSON text to values with lines and pointers: nlohmann's SAX parser with a counting iterator.

#include "blactl/base/json_reader.hpp"

#include "blactl/base/read_file.hpp"
#include "blactl/base/text.hpp"
#include "blactl/base/texts.hpp"

#include "base/json_syntax.hpp"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iterator>
#include <memory>

namespace blactl::json {
namespace {

/// Reads the text and informs the builder of the parser's position.
class CountingIterator {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  CountingIterator(const char* at, const char** reached) : at_(at), reached_(reached) {}

  reference operator*() const { return *at_; }

  CountingIterator& operator++() {
    *reached_ = ++at_;
    return *this;
  }

  CountingIterator operator++(int) {
    CountingIterator old = *this;
    ++*this;
    return old;
  }

  friend bool operator==(const CountingIterator& a, const CountingIterator& b) {
    return a.at_ == b.at_;
  }

 private:
  const char* at_;
  const char** reached_;
};

/// Receives the parser's events. The names are nlohmann's.
class Builder {
 public:
  Builder(std::string_view text, std::string file)
      : text_(text), counted_(text.data()), reached_(text.data()), faults_(std::move(file)) {}

  const char** reached() { return &reached_; }

  bool null() {
    add_scalar(Kind::null);
    return true;
  }

  bool boolean(bool value) {
    add_scalar(Kind::boolean).boolean = value;
    return true;
  }

  bool number_integer(std::int64_t value) {
    Value& made = add_scalar(Kind::integer);
    made.integer = value;
    made.real = static_cast<double>(value);
    return true;
  }

  bool number_unsigned(std::uint64_t value) {
    if (value > static_cast<std::uint64_t>(highest)) {
      too_big(add_scalar(Kind::integer), std::to_string(value));
      return true;
    }
    return number_integer(static_cast<std::int64_t>(value));
  }

  bool number_float(double value, const std::string& digits) {
    // The parser treats integers beyond 64 bits as reals.
    if (digits.find_first_of(".eE") == std::string::npos) {
      too_big(add_scalar(Kind::integer), digits);
      return true;
    }
    Value& made = add_scalar(Kind::real);
    made.real = value;
    made.text = digits;
    return true;
  }

  bool string(std::string& value) {
    add_scalar(Kind::string).text = std::move(value);
    return true;
  }

  template <class Bytes> bool binary(const Bytes&) { return false; }

  bool start_object(std::size_t) { return open(Kind::object); }

  bool key(std::string& value) {
    key_ = std::move(value);
    read_ = position();
    return true;
  }

  bool end_object() {
    report_duplicates(*open_.back());
    open_.pop_back();
    return true;
  }

  bool start_array(std::size_t) { return open(Kind::array); }

  bool end_array() {
    open_.pop_back();
    return true;
  }

  template <class Exception>
  bool parse_error(std::size_t, const std::string& token, const Exception& exception) {
    const auto taken = static_cast<std::size_t>(reached_ - text_.data());
    SyntaxFault fault = explain_syntax(text_, taken, token, exception.what());
    stop(fault.line, say<texts::json_invalid>(fault.reason));
    return false;
  }

  /// A fault after which nothing more can be read.
  void stop(std::string reason) { stop(line(), std::move(reason)); }

  void stop(std::size_t line, std::string reason) {
    broken_ = true;
    faults_.add(line, open_.empty() ? "" : open_.back()->pointer(), std::move(reason));
  }

  Result<Document> result() {
    if (broken_) {
      return std::unexpected(faults_.result().error());
    }
    return Document(std::move(values_), std::move(faults_));
  }

 private:
  /// The line of the token that the parser has just read. After a number it has already taken the
  /// next character, so a line ends here only if something follows.
  std::size_t line() {
    const char* end = reached_ == counted_ ? reached_ : reached_ - 1;
    if (end > counted_) {
      line_ += static_cast<std::size_t>(std::count(counted_, end, '\n'));
      counted_ = end;
    }
    return line_;
  }

  [[nodiscard]] std::size_t position() const {
    return static_cast<std::size_t>(reached_ - text_.data());
  }

  /// Between two tokens there is nothing but these; of a number the parser has already taken the
  /// next character.
  Value& add_scalar(Kind kind) {
    constexpr std::string_view between = " \t\r\n,:[]{}";
    Value& value = add(kind);
    value.begin = text_.find_first_not_of(between, read_);
    value.end = position();
    if (kind == Kind::integer || kind == Kind::real) {
      value.end = std::min(text_.find_first_of(between, value.begin), text_.size());
    }
    read_ = value.end;
    return value;
  }

  Value& add(Kind kind) {
    Value& value = values_->emplace_back();
    value.kind = kind;
    value.line = line();
    if (!open_.empty()) {
      Value& parent = *open_.back();
      value.parent = &parent;
      value.index = parent.items.size();
      value.key = std::move(key_);
      parent.items.push_back(&value);
    }
    key_.clear();
    return value;
  }

  bool open(Kind kind) {
    Value& value = add(kind);
    if (open_.size() == max_depth) {
      stop(say<texts::json_too_deep>(max_depth));
      return false;
    }
    open_.push_back(&value);
    return true;
  }

  void too_big(const Value& value, const std::string& digits) {
    faults_.add(value, say<texts::json_integer_too_big>(digits));
  }

  void report_duplicates(const Value& object) {
    std::vector<const Value*> sorted = object.items;
    std::ranges::stable_sort(sorted, {},
                             [](const Value* value) -> std::string_view { return value->key; });
    for (std::size_t i = 1; i < sorted.size(); ++i) {
      if (sorted[i]->key == sorted[i - 1]->key) {
        faults_.add(*sorted[i], say<texts::json_duplicate>(sorted[i - 1]->line));
      }
    }
  }

  std::string_view text_;
  std::size_t read_ = 0; ///< the end of the last key or scalar
  const char* counted_;  ///< line_ counts the line ends before here
  const char* reached_;  ///< behind the last character that the parser took
  std::size_t line_ = 1;
  std::unique_ptr<std::deque<Value>> values_ = std::make_unique<std::deque<Value>>();
  std::vector<Value*> open_; ///< the arrays and objects around the next value
  std::string key_;
  Faults faults_;
  bool broken_ = false;
};

} // namespace

Result<Document> parse(std::string_view text, std::string file) {
  if (text.size() > max_file_bytes) {
    return fail(Code::bad_file, say<texts::file_too_large>(printable(file), max_file_bytes >> 20U),
                say<texts::file_hint>());
  }
  Builder builder(text, std::move(file));
  const CountingIterator begin(std::to_address(text.begin()), builder.reached());
  const CountingIterator end(std::to_address(text.end()), builder.reached());
  const bool complete = nlohmann::json::sax_parse(begin, end, &builder);
  // The parser takes a zero byte for the end of the file, and would ignore what follows it.
  if (complete && text.find('\0') != std::string_view::npos) {
    builder.stop(say<texts::json_zero_byte>());
  }
  return builder.result();
}

Result<Document> parse_file(const std::filesystem::path& path) {
  const auto text = read_file(path, max_file_bytes);
  return text ? parse(*text, path.string()) : std::unexpected(text.error());
}

} // namespace blactl::json
