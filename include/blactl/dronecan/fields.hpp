#pragma once
// The fields of a payload by their DSDL names: types are described as data, one reader walks them
// all and passes each field to a sink.

#include "blactl/dronecan/types.hpp"

#include <cstdint>
#include <string_view>

namespace blactl::dronecan {

/// Receives the fields of a payload in order, without voids. A structure is an object; so is a
/// union, with its one active member (if that is Empty, an empty object).
class FieldSink {
 public:
  virtual ~FieldSink() = default;
  FieldSink(const FieldSink&) = delete;
  FieldSink& operator=(const FieldSink&) = delete;

  virtual void begin_object() = 0;
  virtual void end_object() = 0;
  virtual void begin_array() = 0;
  virtual void end_array() = 0;
  /// The name of the member that follows.
  virtual void key(std::string_view name) = 0;

  /// `word`: the DSDL constant of this value in lower case ("operational"); empty: none.
  virtual void natural(std::uint64_t value, std::string_view word) = 0;
  virtual void integer(std::int64_t value) = 0;
  virtual void truth(bool value) = 0;
  /// float16 and float32, exactly; may be NaN or infinite.
  virtual void real(float value) = 0;
  /// A byte array that is text by its DSDL: foreign, with any bytes.
  virtual void text(std::string_view bytes) = 0;
  /// Any other byte array.
  virtual void bytes(Bytes bytes) = 0;

 protected:
  FieldSink() = default;
};

enum class FieldsResult : std::uint8_t {
  complete,
  too_short,     ///< the payload ends before the type does
  contradictory, ///< an array beyond its limit, or an invalid union tag
  unknown,       ///< the fields of this type are unknown
};

/// Passes the fields of a payload to `sink`, as one object. Unless the result is `complete`,
/// discard the part that the sink received. Trailing bytes are ignored. Never allocates. Source:
/// DroneCAN specification 3, "Data serialization", for classic CAN (tail array optimisation); the
/// DSDL of each type.
[[nodiscard]] FieldsResult write_fields(FieldSink& sink, Kind kind, std::uint16_t data_type_id,
                                        Bytes payload);

} // namespace blactl::dronecan
