#pragma once
// JSON text, written front to back into one buffer.

#include <charconv>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace blactl {

/// Appends JSON to a string; commas are its business, the nesting is the caller's. (Measured: an
/// order of magnitude faster than a document model, and the order of keys is the order of calls.)
class JsonWriter {
 public:
  /// `out` outlives the writer. Pretty output is indented by two spaces, one member a line.
  enum class Layout : std::uint8_t { compact, pretty };

  explicit JsonWriter(std::string& out, Layout layout = Layout::compact)
      : out_(out), layout_(layout) {}

  void begin_object() { open('{'); }

  void end_object() { close('}'); }

  void begin_array() { open('['); }

  void end_array() { close(']'); }

  void key(std::string_view name);

  /// Controls, and what hides in text or turns its direction, are escaped: a reader gets them, a
  /// terminal does not. A byte that is not well-formed UTF-8 becomes U+FFFD.
  void value(std::string_view text);

  void value(const char* text) { value(std::string_view(text)); }

  /// A bool and nothing that only converts to one (a double, a pointer).
  template <std::same_as<bool> Truth> void value(Truth truth) { literal(truth ? "true" : "false"); }

  void value(std::nullptr_t) { literal("null"); }

  template <class Number>
    requires(std::integral<Number> && !std::same_as<Number, bool>)
  void value(Number number) {
    char digits[24];
    const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
    literal({digits, static_cast<std::size_t>(end - digits)});
  }

  template <class T> void value(const std::optional<T>& maybe) {
    maybe ? value(*maybe) : value(nullptr);
  }

  /// The shortest text that gives just this number back; NaN and infinities, which JSON does not
  /// know, are null. (A float is a double here: whoever reads the text gets one.)
  void real(double number);

  /// A number that is text already: "90.0".
  void number(std::string_view digits) { literal(digits); }

  template <class T> void member(std::string_view name, const T& content) {
    key(name);
    value(content);
  }

 private:
  void open(char bracket);
  void close(char bracket);
  void separate();
  void break_line();
  void literal(std::string_view text);

  std::string& out_;
  Layout layout_;
  int depth_ = 0;
  bool first_ = true; ///< nothing in this object or array yet
  bool after_key_ = false;
};

} // namespace blactl
