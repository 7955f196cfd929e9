#include "blactl/dronecan/fields.hpp"

#include "dronecan/dsdl.hpp"

#include <array>
#include <bit>

namespace blactl::dronecan {
namespace {

using dsdl::Count;
using dsdl::Field;
using dsdl::Meaning;
using dsdl::Shape;

/// Takes numbers of any width off a payload. Beyond its end every bit is 0 and ok() becomes false.
class BitReader {
 public:
  explicit BitReader(Bytes payload) : payload_(payload) {}

  [[nodiscard]] bool ok() const { return ok_; }

  [[nodiscard]] std::size_t left() const { return payload_.size() * 8 - at_; }

  /// The next `width` bits (0..64): little-endian by bytes, each byte from its most significant bit
  /// on; a partial byte is the top of the number.
  std::uint64_t take(std::size_t width) {
    if (width > left()) {
      fail();
      return 0;
    }
    std::uint64_t value = 0;
    unsigned shift = 0;
    for (; width >= 8; width -= 8, shift += 8) {
      value |= static_cast<std::uint64_t>(take_bits(8)) << shift;
    }
    return width == 0 ? value : value | static_cast<std::uint64_t>(take_bits(width)) << shift;
  }

  /// `size` whole bytes: in place if they are aligned, else in `scratch`.
  Bytes take_bytes(std::size_t size, std::span<std::uint8_t> scratch) {
    if (size * 8 > left()) {
      fail();
      return {};
    }
    if (at_ % 8 == 0) {
      const auto bytes = payload_.subspan(at_ / 8, size);
      at_ += size * 8;
      return bytes;
    }
    const auto bytes = scratch.first(size);
    for (auto& byte : bytes) {
      byte = static_cast<std::uint8_t>(take_bits(8));
    }
    return bytes;
  }

  void fail() {
    ok_ = false;
    at_ = payload_.size() * 8;
  }

 private:
  /// Takes 1..8 bits, which must be present.
  unsigned take_bits(std::size_t width) {
    const auto offset = at_ % 8;
    const auto* byte = payload_.data() + at_ / 8;
    at_ += width;
    const unsigned next = offset + width > 8 ? byte[1] : 0U;
    const unsigned both = static_cast<unsigned>(byte[0]) << 8U | next;
    return (both >> (16 - offset - width)) & ((1U << width) - 1);
  }

  Bytes payload_;
  std::size_t at_ = 0; ///< in bits
  bool ok_ = true;
};

/// Elements of at least one byte at the end of a payload have no length of their own.
constexpr std::size_t smallest_tail_element = 8;

std::size_t size_in_bits(const Field& field) {
  if (field.shape != Shape::structure) {
    return field.width;
  }
  std::size_t size = 0;
  for (const Field& inner : field.fields) {
    size += size_in_bits(inner);
  }
  return size;
}

class Walker {
 public:
  Walker(Bytes payload, FieldSink& sink) : reader_(payload), sink_(sink) {}

  FieldsResult walk(std::span<const Field> fields) {
    write_structure(fields, true);
    if (contradictory_) {
      return FieldsResult::contradictory;
    }
    return reader_.ok() ? FieldsResult::complete : FieldsResult::too_short;
  }

 private:
  [[nodiscard]] bool good() const { return reader_.ok() && !contradictory_; }

  /// `tail`: nothing follows it in the payload.
  void write_structure(std::span<const Field> fields, bool tail) {
    sink_.begin_object();
    for (const Field& field : fields) {
      if (field.name.empty()) {
        (void)reader_.take(field.width);
        continue;
      }
      sink_.key(field.name);
      write(field, tail && &field == &fields.back());
      if (!good()) {
        return;
      }
    }
    sink_.end_object();
  }

  void write(const Field& field, bool tail) {
    if (field.count == Count::one) {
      write_one(field, tail);
      return;
    }
    const auto count = take_count(field, tail);
    if (!good()) {
      return;
    }
    if (field.meaning != Meaning::numbers) {
      write_bytes(field, count);
      return;
    }
    sink_.begin_array();
    for (std::size_t i = 0; i < count && good(); ++i) {
      write_one(field, false);
    }
    sink_.end_array();
  }

  std::size_t take_count(const Field& field, bool tail) {
    if (field.count == Count::fixed) {
      return field.limit;
    }
    const auto element = size_in_bits(field);
    std::size_t count = 0;
    if (tail && element >= smallest_tail_element) {
      count = reader_.left() / element;
      if (reader_.left() % element >= 8) {
        reader_.fail(); // a partial element, more than the padding of the last byte
      }
    } else {
      count = reader_.take(static_cast<std::size_t>(std::bit_width(field.limit)));
    }
    contradictory_ = contradictory_ || count > field.limit;
    return count;
  }

  void write_bytes(const Field& field, std::size_t size) {
    std::array<std::uint8_t, 256> scratch; // NOLINT(cppcoreguidelines-pro-type-member-init)
    const auto bytes = reader_.take_bytes(size, scratch);
    if (!good()) {
      return;
    }
    if (field.meaning == Meaning::text) {
      // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes as characters
      sink_.text({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    } else {
      sink_.bytes(bytes);
    }
  }

  void write_one(const Field& field, bool tail) {
    switch (field.shape) {
    case Shape::structure: write_structure(field.fields, tail); break;
    case Shape::choice: write_choice(field.fields); break;
    case Shape::nothing: write_structure({}, false); break;
    default: write_number(field, reader_.take(field.width));
    }
  }

  void write_choice(std::span<const Field> members) {
    const auto tag = reader_.take(static_cast<std::size_t>(std::bit_width(members.size() - 1)));
    if (tag >= members.size()) {
      contradictory_ = true;
      return;
    }
    write_structure(members.subspan(tag, 1), false);
  }

  void write_number(const Field& field, std::uint64_t bits) {
    const auto unused = 64U - field.width;
    switch (field.shape) {
    case Shape::truth: sink_.truth(bits != 0); break;
    case Shape::integer:
      sink_.integer(std::bit_cast<std::int64_t>(bits << unused) >> unused);
      break;
    case Shape::real:
      sink_.real(field.width == 16 ? from_float16(static_cast<std::uint16_t>(bits))
                                   : std::bit_cast<float>(static_cast<std::uint32_t>(bits)));
      break;
    default:
      sink_.natural(bits, bits < field.words.size() ? field.words[bits] : std::string_view());
    }
  }

  BitReader reader_;
  FieldSink& sink_;
  bool contradictory_ = false;
};

} // namespace

FieldsResult write_fields(FieldSink& sink, Kind kind, std::uint16_t data_type_id, Bytes payload) {
  const auto* fields = dsdl::find_fields(kind, data_type_id);
  return fields == nullptr ? FieldsResult::unknown : Walker(payload, sink).walk(*fields);
}

} // namespace blactl::dronecan
