// A value as it may be typed, of the register that the first byte says. What is taken for one is
// printed, and typed so it is the same value again.

#include "blactl/bla/value.hpp"

#include "fuzz.hpp"

using namespace blactl;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) {
    return 0;
  }
  const auto registers = fuzz::built_in().registers();
  const bla::Parameter& parameter = registers[*data % registers.size()];
  if (!parameter.writable()) {
    return -1; // nobody types what only a servo says
  }
  const std::string_view text = fuzz::as_text(data + 1, size - 1);
  (void)bla::parse_value(parameter, bla::NamedBy::address, text);
  const auto typed = bla::parse_value(parameter, bla::NamedBy::name, text);
  if (!typed || !bla::check_range(parameter, typed->raw, typed->pwm_mode)) {
    return 0;
  }
  (void)bla::display(parameter, typed->raw, typed->pwm_mode);
  const auto again = bla::parse_value(parameter, bla::NamedBy::name,
                                      bla::input_text(parameter, typed->raw, typed->pwm_mode));
  fuzz::require(again && again->raw == typed->raw);
  return 0;
}
