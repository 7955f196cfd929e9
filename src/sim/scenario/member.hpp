#pragma once
// One key of a JSON object and the member of a struct that it is for: a table of them is a reader.
//
//   constexpr Member<Shaft> members[]{
//       {"stuck", to<&Shaft::stuck>},
//       {"delay", up_to_seconds<&Shaft::delay, 10>},
//   };
//   read_whole(object, members, shaft, faults);

#include "blactl/base/json_reader.hpp"

#include "sim/scenario/scenario_values.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <type_traits>

namespace blactl::sim {

/// What is left out, or wrong, leaves the member as it is.
template <class T> struct Member {
  std::string_view key;
  void (*read)(json::Object& object, std::string_view key, T& into, json::Faults& faults);
};

template <class T> using Members = std::span<const Member<std::type_identity_t<T>>>;

/// Reads the keys of a table.
template <class T>
void read_members(json::Object& object, Members<T> members, T& into, json::Faults& faults) {
  for (const Member<T>& member : members) {
    member.read(object, member.key, into, faults);
  }
}

/// Reads an object that has no other keys. One that is not there changes nothing.
template <class T>
void read_whole(json::Object object, Members<T> members, T& into, json::Faults& faults) {
  read_members(object, members, into, faults);
  object.finish();
}

/// A text as an argument of a template.
template <std::size_t size> struct Literal {
  char text[size];

  consteval Literal(const char (&from)[size]) { std::ranges::copy(from, text); }
};

template <class Value, class T> T owner_of(Value T::*);
template <auto member> using Owner = decltype(owner_of(member));
template <auto member>
using ValueOf = std::remove_reference_t<decltype(std::declval<Owner<member>&>().*member)>;

// How a member is read.

/// An integer from `min` to `max`.
template <auto member, std::int64_t min, std::int64_t max>
void integer(json::Object& object, std::string_view key, Owner<member>& into, json::Faults&) {
  if (const auto number = object.optional_integer(key, min, max)) {
    into.*member = static_cast<ValueOf<member>>(*number);
  }
}

/// A number from `min` to `max`.
template <auto member, std::int64_t min, std::int64_t max>
void number(json::Object& object, std::string_view key, Owner<member>& into, json::Faults&) {
  if (const auto number = object.optional_number(key, min, max)) {
    into.*member = static_cast<ValueOf<member>>(*number);
  }
}

/// A time of 0 to `longest` seconds, by the grammar of values.
template <auto member, std::int64_t longest>
void up_to_seconds(json::Object& object, std::string_view key, Owner<member>& into,
                   json::Faults& faults) {
  if (const auto time = read_duration(object, key, std::chrono::seconds(longest), faults)) {
    into.*member = *time;
  }
}

/// A rate from 1 to `max` Hz, as the time from one to the next.
template <auto member, std::int64_t max>
void rate(json::Object& object, std::string_view key, Owner<member>& into, json::Faults&) {
  if (const auto hz = object.optional_number(key, 1, max)) {
    into.*member = Duration(static_cast<Duration::rep>(Duration::period::den / *hz));
  }
}

/// One of the words of an enumeration that counts from 0, in its order.
template <auto member, Literal... all>
void word(json::Object& object, std::string_view key, Owner<member>& into, json::Faults&) {
  const auto given = object.optional_word(key, {all.text...});
  int value = 0;
  for (const std::string_view one : {std::string_view(all.text)...}) {
    into.*member = given == one ? static_cast<ValueOf<member>>(value) : into.*member;
    ++value;
  }
}

/// What the type of the member says: true or false, or an integer of its range.
template <auto member>
void to(json::Object& object, std::string_view key, Owner<member>& into, json::Faults& faults) {
  using Value = ValueOf<member>;
  if constexpr (std::is_integral_v<Value> && !std::is_same_v<Value, bool>) {
    integer<member, 0, std::numeric_limits<Value>::max()>(object, key, into, faults);
  } else if (const auto flag = object.optional_boolean(key)) {
    const bool given = *flag;
    into.*member = given;
  }
}

} // namespace blactl::sim
