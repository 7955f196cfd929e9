#include "blactl/base/text.hpp"

#include "catch.hpp"
#include "cli/output/faults_view.hpp"
#include "unit/bla/built_in.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

using namespace blactl;
using bla::FaultBit;
using fleet::FaultState;
using test::built_in;

namespace {

/// Servo 11, of which these bits are set.
FaultState servo_with(const std::vector<const FaultBit*>& bits) {
  bla::Values values;
  for (const bla::Address reg : bla::fault_registers) {
    values[reg] = 0;
  }
  for (const FaultBit* bit : bits) {
    values[bit->reg] |= std::int64_t{1} << bit->bit;
  }
  FaultState servo;
  servo.snapshot.servo.id = dronecan::NodeId(11);
  for (const auto& [address, raw] : values) {
    servo.snapshot.readings.push_back({built_in().find(address), raw});
  }
  servo.faults = bla::faults(values, built_in());
  return servo;
}

std::string faults_text(const FaultState& servo) {
  return cli::text(std::span(&servo, 1), bla::Level::notice, cli::Page{.width = 80});
}

std::size_t widest(std::string_view text) {
  std::size_t width = 0;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    width = std::max(width, cli::display_width(text.substr(0, end)));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
  }
  return width;
}

/// The text without the places where lines were broken.
std::string in_one(std::string_view text) {
  std::string all;
  for (const char c : text) {
    all += c == '\n' || c == ' ' ? "" : std::string(1, c);
  }
  return all;
}

bool holds_words(const std::string& text, std::string_view words) {
  return text.find(in_one(words)) != std::string::npos;
}

/// Every bit of `bits` is told in full, in the language of the session, and nothing stands out.
void check_bits(const std::vector<const FaultBit*>& bits) {
  const std::string text = faults_text(servo_with(bits));
  const std::string all = in_one(text);
  CHECK(widest(text) <= 80);
  for (const FaultBit* bit : bits) {
    INFO(bit->reg.name() << '.' << int{bit->bit});
    CHECK(holds_words(all, choose(bit->text_en, bit->text_ja)));
    CHECK(holds_words(all, choose(bit->condition_en, bit->condition_ja)));
    CHECK(holds_words(all, choose(bit->action_en, bit->action_ja)));
    CHECK(holds_words(all, fmt::format("[{}.{} {}]", bit->reg.name(), bit->bit, bit->code)));
  }
}

void check_every_bit() {
  std::size_t pairs = 0;
  const auto known = built_in().fault_bits();
  for (const FaultBit& one : known) {
    check_bits({&one});
    for (const FaultBit& other : known) {
      if (&one < &other) {
        check_bits({&one, &other});
        ++pairs;
      }
    }
  }
  CHECK(pairs == known.size() * (known.size() - 1) / 2);
}

} // namespace

TEST_CASE("every fault bit, alone and beside every other, is told within 80 columns") {
  SECTION("in English") {
    check_every_bit();
  }
  SECTION("in Japanese") {
    set_language(Language::japanese);
    check_every_bit();
    set_language(Language::english);
  }
}

TEST_CASE("a servo whose NodeStatus reports what no register shows is not told to have no faults") {
  FaultState servo = servo_with({});
  servo.health = dronecan::Health::ok;
  CHECK_FALSE(servo.unexplained_health());
  CHECK(holds_words(in_one(faults_text(servo)), "no faults"));
  servo.health = dronecan::Health::warning;
  CHECK(servo.unexplained_health() == bla::Level::warning);
  servo.health = dronecan::Health::critical;
  CHECK(servo.unexplained_health() == bla::Level::failure);
  CHECK_FALSE(holds_words(in_one(faults_text(servo)), "no faults"));
  CHECK(holds_words(in_one(faults_text(servo)), "its health is critical"));
}
