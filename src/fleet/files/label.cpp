#include "blactl/fleet/files/label.hpp"

#include "blactl/base/json_reader.hpp"
#include "blactl/base/text.hpp"

#include "fleet/files/settings_reader.hpp"
#include "fleet/files/texts.hpp"

#include <charconv>
#include <system_error>
#include <utility>

namespace blactl::fleet {

namespace {

/// Scanners end lines in different ways.
std::string_view without_blanks(std::string_view line) {
  constexpr std::string_view blanks = " \t\r\n";
  const auto first = line.find_first_not_of(blanks);
  return first == line.npos ? std::string_view()
                            : line.substr(first, line.find_last_not_of(blanks) - first + 1);
}

/// Decimal, 32 bits. Empty: invalid.
std::optional<std::int64_t> serial_number_of(std::string_view text) {
  std::uint32_t number = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc() && rest == text.data() + text.size();
  return is_number ? std::optional<std::int64_t>(number) : std::nullopt;
}

Result<Label> read_label_object(std::string_view text, std::size_t number,
                                const bla::Profiles& profiles) {
  constexpr std::int64_t most_of_32_bits = 0xFFFFFFFF;
  auto document = json::parse(text, say<texts::label_line>(number));
  if (!document) {
    return std::unexpected(document.error());
  }
  json::Object object(document->root(), document->faults());
  Label label{.text = std::string(text),
              .serial_number = object.optional_integer("serial_number", 0, most_of_32_bits),
              .servo_id = object.optional_integer("servo_id"),
              .static_node_id = object.optional_integer("static_node_id"),
              .work_order = object.optional_string("work_order"),
              .operator_name = object.optional_string("operator")};
  object.finish();
  for (const auto& [name, id] :
       {std::pair("servo_id", label.servo_id), std::pair("static_node_id", label.static_node_id)}) {
    if (id) {
      (void)check_id(document->root(), name, *id, profiles, document->faults());
    }
  }
  if (const auto fine = document->faults().result(); !fine) {
    return std::unexpected(fine.error());
  }
  return label;
}

} // namespace

Result<Label> parse_label(std::string_view line, std::size_t number,
                          const bla::Profiles& profiles) {
  const std::string_view text = without_blanks(line);
  if (text.starts_with('{')) {
    return read_label_object(text, number, profiles);
  }
  if (const auto serial_number = serial_number_of(text)) {
    return Label{.text = std::string(text), .serial_number = serial_number};
  }
  return fail(Code::bad_file, say<texts::label_wrong>(number, printable(text)),
              say<texts::label_wrong_hint>());
}

} // namespace blactl::fleet
