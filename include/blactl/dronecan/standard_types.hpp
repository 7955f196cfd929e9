#pragma once
// The standard data types by name, ID and signature, so that a listener can name a transfer and
// check its CRC.

#include "blactl/dronecan/ids.hpp"

#include <cstdint>
#include <span>

namespace blactl::dronecan {

/// The types of the DSDL namespaces uavcan and dronecan that have a default data type ID below
/// 20000, where the range of the vendors begins: messages before services, each ascending by ID. (A
/// vendor's ID has a meaning only among a few devices; a wrong guess would turn a good transfer
/// into a CRC error.)
[[nodiscard]] std::span<const DataType> standard_types();

/// The standard type with this ID; null: none.
[[nodiscard]] const DataType* find_standard_type(Kind kind, std::uint16_t data_type_id);

} // namespace blactl::dronecan
