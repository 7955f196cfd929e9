// Parameters: reading and writing them, saving and erasing all of them.

#include "blactl/dronecan/types.hpp"

#include "dronecan/wire.hpp"

#include <algorithm>
#include <utility>

namespace blactl::dronecan {
namespace {

constexpr std::size_t max_param_name = 92;
constexpr std::size_t max_text = 128;
constexpr std::size_t opcode_argument_bytes = 6;
constexpr std::uint16_t max_index = 0x1FFF;

// Both unions begin with the tag in the low bits of a byte; the order of the C++ alternatives is
// that of the DSDL, so tag and index() are the same.
constexpr std::uint8_t value_tag_mask = 7;
constexpr std::uint8_t numeric_tag_mask = 3;

struct ValueWriter {
  Payload& payload;

  void operator()(std::monostate) const {}

  void operator()(std::int64_t value) const { put_signed(payload, value, 8); }

  void operator()(float value) const { put_float32(payload, value); }

  void operator()(bool value) const { payload.append(value ? std::uint8_t{1} : std::uint8_t{0}); }

  void operator()(const std::string& value) const {
    put_integer(payload, std::min(value.size(), max_text), 1);
    put_text(payload, value, max_text);
  }
};

/// `above`: the bits that share the byte with the tag.
template <class Union> void put_union(Payload& payload, const Union& value, unsigned above = 0) {
  put_integer(payload, above | value.index(), 1);
  std::visit(ValueWriter{payload}, value);
}

std::optional<std::string> take_text(Reader& reader) {
  const auto size = reader.u8();
  return size > max_text ? std::nullopt : std::optional(reader.text(size));
}

/// Empty: no such tag, or a text beyond its limit. The reader records the end of the payload.
std::optional<GetSet::Value> take_value(Reader& reader, unsigned tag) {
  switch (tag) {
  case 0: return GetSet::Empty{};
  case 1: return reader.signed_integer(8);
  case 2: return reader.float32();
  case 3: return reader.u8() != 0;
  case 4: return take_text(reader);
  default: return std::nullopt;
  }
}

std::optional<GetSet::NumericValue> take_numeric(Reader& reader) {
  switch (reader.u8() & numeric_tag_mask) {
  case 0: return GetSet::Empty{};
  case 1: return reader.signed_integer(8);
  case 2: return reader.float32();
  default: return std::nullopt;
  }
}

} // namespace

// Byte 0 has the low bits of the index, byte 1 the five others above the tag.
Payload GetSet::Request::encode() const {
  const auto capped = std::min(index, max_index);
  Payload payload;
  put_integer(payload, capped, 1);
  put_union(payload, value, static_cast<unsigned>(capped >> 8U) << 3U);
  put_text(payload, name, max_param_name);
  return payload;
}

std::optional<GetSet::Request> GetSet::Request::decode(Bytes payload) {
  Reader reader(payload);
  Request request;
  const auto low = reader.u8();
  const auto high_and_tag = reader.u8();
  request.index = static_cast<std::uint16_t>((high_and_tag >> 3U) << 8U | low);
  auto value = take_value(reader, high_and_tag & value_tag_mask);
  request.name = reader.text_to_end(max_param_name);
  if (!reader.ok() || !value) {
    return std::nullopt;
  }
  request.value = *std::move(value);
  return request;
}

Payload GetSet::Response::encode() const {
  Payload payload;
  put_union(payload, value);
  put_union(payload, default_value);
  put_union(payload, max_value);
  put_union(payload, min_value);
  put_text(payload, name, max_param_name);
  return payload;
}

std::optional<GetSet::Response> GetSet::Response::decode(Bytes payload) {
  Reader reader(payload);
  auto value = take_value(reader, reader.u8() & value_tag_mask);
  auto default_value = take_value(reader, reader.u8() & value_tag_mask);
  const auto max_value = take_numeric(reader);
  const auto min_value = take_numeric(reader);
  auto name = reader.text_to_end(max_param_name);
  if (!reader.ok() || !value || !default_value || !max_value || !min_value) {
    return std::nullopt;
  }
  return Response{*std::move(value), *std::move(default_value), *max_value, *min_value,
                  std::move(name)};
}

Payload ExecuteOpcode::Request::encode() const {
  Payload payload;
  payload.append(opcode);
  put_signed(payload, argument, opcode_argument_bytes);
  return payload;
}

std::optional<ExecuteOpcode::Request> ExecuteOpcode::Request::decode(Bytes payload) {
  Reader reader(payload);
  Request request;
  request.opcode = reader.u8();
  request.argument = reader.signed_integer(opcode_argument_bytes);
  return reader.ok() ? std::optional(request) : std::nullopt;
}

Payload ExecuteOpcode::Response::encode() const {
  Payload payload;
  put_signed(payload, argument, opcode_argument_bytes);
  payload.append(ok ? true_bit : std::uint8_t{0});
  return payload;
}

std::optional<ExecuteOpcode::Response> ExecuteOpcode::Response::decode(Bytes payload) {
  Reader reader(payload);
  Response response;
  response.argument = reader.signed_integer(opcode_argument_bytes);
  response.ok = (reader.u8() & true_bit) != 0;
  return reader.ok() ? std::optional(response) : std::nullopt;
}

} // namespace blactl::dronecan
