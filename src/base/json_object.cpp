// Checked access to values: converts what a reader asks for and records the faults.

#include "blactl/base/json_reader.hpp"
#include "blactl/base/text.hpp"
#include "blactl/base/texts.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace blactl::json {
namespace {

constexpr std::size_t max_listed_faults = 100;

std::string describe(Kind kind) {
  switch (kind) {
  case Kind::null: return say<texts::kind_null>();
  case Kind::boolean: return say<texts::kind_boolean>();
  case Kind::integer: return say<texts::kind_integer>();
  case Kind::real: return say<texts::kind_number>();
  case Kind::string: return say<texts::kind_string>();
  case Kind::array: return say<texts::kind_array>();
  case Kind::object: return say<texts::kind_object>();
  }
  return {};
}

/// Whether `value` is of `kind`; adds a fault if not.
bool expect(const Value& value, Kind kind, Faults& faults) {
  if (value.kind == kind) {
    return true;
  }
  faults.add(value, say<texts::json_wrong_kind>(describe(kind), describe(value.kind)));
  return false;
}

/// Whether min <= number <= max; adds a fault if not.
template <class Number>
bool within(Number number, Number min, Number max, const Value& value, Faults& faults) {
  if (number < min) {
    faults.add(value, say<texts::json_below>(number, min));
  } else if (number > max) {
    faults.add(value, say<texts::json_above>(number, max));
  } else {
    return true;
  }
  return false;
}

template <class Words> std::string join(const Words& words) {
  std::string all;
  for (const auto& word : words) {
    all += (all.empty() ? "" : ", ") + std::string(word);
  }
  return all;
}

std::optional<std::string> as_word(const Value& value, Faults& faults,
                                   std::initializer_list<std::string_view> words) {
  auto text = as_string(value, faults);
  if (text && std::ranges::find(words, *text) == words.end()) {
    faults.add(value, words.size() == 1 ? say<texts::json_other_word>(*text, *words.begin())
                                        : say<texts::json_no_such_word>(*text, join(words)));
    return std::nullopt;
  }
  return text;
}

std::span<const Value* const> as_array(const Value& value, Faults& faults) {
  if (!expect(value, Kind::array, faults)) {
    return {};
  }
  return value.items;
}

} // namespace

std::string Value::pointer() const {
  if (parent == nullptr) {
    return {};
  }
  std::string path = parent->pointer() + '/';
  if (parent->kind == Kind::array) {
    return path + std::to_string(index);
  }
  for (const char c : key) {
    if (c == '~') {
      path += "~0";
    } else if (c == '/') {
      path += "~1";
    } else {
      path += c;
    }
  }
  return path;
}

void Faults::add(std::size_t line, std::string pointer, std::string reason) {
  faults_.push_back({line, std::move(pointer), std::move(reason)});
}

Result<void> Faults::result() const {
  if (faults_.empty()) {
    return {};
  }
  std::vector<Fault> sorted = faults_;
  std::ranges::stable_sort(sorted, {}, &Fault::line);
  const std::size_t listed = std::min(sorted.size(), max_listed_faults);
  std::string message;
  for (std::size_t i = 0; i < listed; ++i) {
    const Fault& fault = sorted[i];
    message += i == 0 ? "" : "\n";
    message += fmt::format("{}:{}: {}: {}", printable(file_), fault.line,
                           fault.pointer.empty() ? "/" : printable(fault.pointer),
                           printable(fault.reason));
  }
  if (listed < sorted.size()) {
    message += '\n' + say<texts::json_more_faults>(sorted.size() - listed);
  }
  return fail(Code::bad_file, std::move(message), say<texts::json_hint>());
}

std::optional<std::string> as_string(const Value& value, Faults& faults) {
  if (!expect(value, Kind::string, faults)) {
    return std::nullopt;
  }
  return value.text;
}

std::optional<std::int64_t> as_integer(const Value& value, Faults& faults, std::int64_t min,
                                       std::int64_t max) {
  if (!expect(value, Kind::integer, faults) || !within(value.integer, min, max, value, faults)) {
    return std::nullopt;
  }
  return value.integer;
}

std::optional<double> as_number(const Value& value, Faults& faults, double min, double max) {
  if (value.kind != Kind::integer && !expect(value, Kind::real, faults)) {
    return std::nullopt;
  }
  if (!within(value.real, min, max, value, faults)) {
    return std::nullopt;
  }
  return value.real;
}

std::optional<bool> as_boolean(const Value& value, Faults& faults) {
  if (!expect(value, Kind::boolean, faults)) {
    return std::nullopt;
  }
  return value.boolean;
}

Object::Object(const Value& value, Faults& faults) : faults_(&faults) {
  if (expect(value, Kind::object, faults)) {
    value_ = &value;
  }
}

bool Object::has(std::string_view key) const {
  return value_ != nullptr &&
         std::ranges::find(value_->items, key, &Value::key) != value_->items.end();
}

const Value* Object::optional_any(std::string_view key) {
  if (value_ == nullptr) {
    return nullptr;
  }
  if (std::ranges::find(known_, key) == known_.end()) {
    known_.emplace_back(key);
  }
  const auto found = std::ranges::find(value_->items, key, &Value::key);
  if (found == value_->items.end()) {
    return nullptr;
  }
  asked_.push_back(*found);
  return *found;
}

const Value* Object::any(std::string_view key) {
  const Value* value = optional_any(key);
  if (value == nullptr && value_ != nullptr) {
    faults_->add(*value_, say<texts::json_missing>(key));
  }
  return value;
}

std::string Object::string(std::string_view key) {
  const Value* value = any(key);
  return value == nullptr ? std::string{} : as_string(*value, *faults_).value_or("");
}

std::string Object::word(std::string_view key, std::initializer_list<std::string_view> words) {
  const Value* value = any(key);
  return value == nullptr ? std::string{} : as_word(*value, *faults_, words).value_or("");
}

std::int64_t Object::integer(std::string_view key, std::int64_t min, std::int64_t max) {
  const Value* value = any(key);
  return value == nullptr ? 0 : as_integer(*value, *faults_, min, max).value_or(0);
}

double Object::number(std::string_view key, double min, double max) {
  const Value* value = any(key);
  return value == nullptr ? 0 : as_number(*value, *faults_, min, max).value_or(0);
}

bool Object::boolean(std::string_view key) {
  const Value* value = any(key);
  return value != nullptr && as_boolean(*value, *faults_).value_or(false);
}

std::span<const Value* const> Object::array(std::string_view key) {
  const Value* value = any(key);
  return value == nullptr ? std::span<const Value* const>{} : as_array(*value, *faults_);
}

Object Object::object(std::string_view key) {
  const Value* value = any(key);
  return value == nullptr ? Object(*faults_) : Object(*value, *faults_);
}

std::optional<std::string> Object::optional_string(std::string_view key) {
  const Value* value = optional_any(key);
  return value == nullptr ? std::nullopt : as_string(*value, *faults_);
}

std::optional<std::string> Object::optional_word(std::string_view key,
                                                 std::initializer_list<std::string_view> words) {
  const Value* value = optional_any(key);
  return value == nullptr ? std::nullopt : as_word(*value, *faults_, words);
}

std::optional<std::int64_t> Object::optional_integer(std::string_view key, std::int64_t min,
                                                     std::int64_t max) {
  const Value* value = optional_any(key);
  return value == nullptr ? std::nullopt : as_integer(*value, *faults_, min, max);
}

std::optional<double> Object::optional_number(std::string_view key, double min, double max) {
  const Value* value = optional_any(key);
  return value == nullptr ? std::nullopt : as_number(*value, *faults_, min, max);
}

std::optional<bool> Object::optional_boolean(std::string_view key) {
  const Value* value = optional_any(key);
  return value == nullptr ? std::nullopt : as_boolean(*value, *faults_);
}

std::span<const Value* const> Object::optional_array(std::string_view key) {
  const Value* value = optional_any(key);
  return value == nullptr ? std::span<const Value* const>{} : as_array(*value, *faults_);
}

Object Object::optional_object(std::string_view key) {
  const Value* value = optional_any(key);
  return value == nullptr ? Object(*faults_) : Object(*value, *faults_);
}

std::span<const Value* const> Object::members() {
  if (value_ == nullptr) {
    return {};
  }
  asked_ = value_->items;
  return value_->items;
}

void Object::finish() {
  if (value_ == nullptr) {
    return;
  }
  for (const Value* item : value_->items) {
    // A duplicate key has its own fault already.
    if (std::ranges::find(asked_, item->key, &Value::key) == asked_.end()) {
      faults_->add(*item, known_.empty() ? say<texts::json_unknown_among_none>()
                                         : say<texts::json_unknown>(join(known_)));
    }
  }
}

} // namespace blactl::json
