#pragma once
// The label of a servo on a production line, as typed by a scanner or a database (contract, section
// 6, "provision").

#include "blactl/base/error.hpp"
#include "blactl/bla/profile.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::fleet {

/// One line about one servo.
struct Label {
  std::string text;                                         ///< the line, without blanks around it
  std::optional<std::int64_t> serial_number{};              ///< 0x51
  std::optional<std::int64_t> servo_id{}, static_node_id{}; ///< wanted ones: 0x45, 0x46
  std::optional<std::string> work_order{},
      operator_name{}; ///< for its record, in place of the run's
};

/// Parses a serial number, or a JSON object with any of serial_number, servo_id, static_node_id,
/// work_order and operator; `number` is that of the line, for messages. Errors: bad_file: it is
/// neither, or a value is out of range.
[[nodiscard]] Result<Label> parse_label(std::string_view line, std::size_t number,
                                        const bla::Profiles& profiles);

} // namespace blactl::fleet
