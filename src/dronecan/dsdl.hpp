#pragma once
// DSDL as data: the description of data types for the field reader.

#include "blactl/dronecan/ids.hpp"

#include <cstdint>
#include <span>
#include <string_view>

namespace blactl::dronecan::dsdl {

enum class Shape : std::uint8_t { nothing, natural, integer, truth, real, structure, choice };

/// The number of elements of a field.
enum class Count : std::uint8_t { one, fixed, up_to };

/// The meaning of an array of bytes.
enum class Meaning : std::uint8_t { numbers, text, bytes };

/// A field, or a member of a union.
struct Field {
  std::string_view name{};
  Shape shape = Shape::nothing; ///< of one element; `nothing`: void, or the type Empty
  std::uint8_t width = 0;       ///< in bits, of a number or void
  Count count = Count::one;
  std::uint16_t limit = 1;                   ///< of the array
  Meaning meaning = Meaning::numbers;        ///< of the array
  std::span<const Field> fields{};           ///< of a structure; the members of a union
  std::span<const std::string_view> words{}; ///< constants of the values 0, 1, …
};

constexpr Field natural(std::string_view name, std::uint8_t width,
                        std::span<const std::string_view> words = {}) {
  return {.name = name, .shape = Shape::natural, .width = width, .words = words};
}

constexpr Field integer(std::string_view name, std::uint8_t width) {
  return {.name = name, .shape = Shape::integer, .width = width};
}

constexpr Field truth(std::string_view name) {
  return {.name = name, .shape = Shape::truth, .width = 1};
}

/// 16 or 32 bits.
constexpr Field real(std::string_view name, std::uint8_t width) {
  return {.name = name, .shape = Shape::real, .width = width};
}

constexpr Field padding(std::uint8_t width) {
  return {.width = width};
}

constexpr Field empty(std::string_view name) {
  return {.name = name};
}

constexpr Field structure(std::string_view name, std::span<const Field> fields) {
  return {.name = name, .shape = Shape::structure, .fields = fields};
}

constexpr Field choice(std::string_view name, std::span<const Field> members) {
  return {.name = name, .shape = Shape::choice, .fields = members};
}

constexpr Field up_to(std::uint16_t limit, Field element, Meaning meaning = Meaning::numbers) {
  element.count = Count::up_to;
  element.limit = limit;
  element.meaning = meaning;
  return element;
}

constexpr Field text(std::string_view name, std::uint16_t limit) {
  return up_to(limit, natural(name, 8), Meaning::text);
}

constexpr Field bytes(std::string_view name, std::uint16_t limit) {
  return up_to(limit, natural(name, 8), Meaning::bytes);
}

constexpr Field fixed_bytes(std::string_view name, std::uint16_t size) {
  auto field = bytes(name, size);
  field.count = Count::fixed;
  return field;
}

/// The fields of a message, or of one direction of a service; null: unknown.
[[nodiscard]] const std::span<const Field>* find_fields(Kind kind, std::uint16_t data_type_id);

} // namespace blactl::dronecan::dsdl
