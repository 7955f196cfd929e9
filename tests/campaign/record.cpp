#include "record.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <string_view>
#include <utility>

namespace blactl::campaign {
namespace {

constexpr std::uint16_t restart_node = 5, execute_opcode = 10, get_set = 11;
constexpr std::uint16_t node_status = 341, array_command = 1010, arming_status = 1100;
constexpr std::uint8_t fully_armed = 255, every_servo = 255;

/// Before the payload of a transfer of several frames.
constexpr std::size_t crc_bytes = 2;
constexpr std::uint8_t integer_tag = 1;

bool is_own(const OnWire& frame) {
  const std::uint8_t id = frame.source();
  return id == 127 || id == 126 || id == 9;
}

bool tells(const OnWire& frame) {
  return frame.is_service() ? !frame.is_request() : frame.type() == node_status;
}

/// The address in "0x38"; empty: none.
std::optional<std::uint8_t> address_in(std::string_view name) {
  unsigned address = 0;
  if (name.size() != 4 || !name.starts_with("0x")) {
    return std::nullopt;
  }
  const auto [end, error] = std::from_chars(name.data() + 2, name.data() + 4, address, 16);
  return error == std::errc{} && end == name.data() + 4
             ? std::optional(static_cast<std::uint8_t>(address))
             : std::nullopt;
}

/// Of a request of GetSet without its CRC: 13 bits of index, 3 of tag, the value, the name.
std::optional<SentWrite> write_in(const std::vector<std::uint8_t>& payload, const OnWire& first) {
  constexpr std::size_t head = 2 + 8;
  if (payload.size() <= head || (payload[1] & 7) != integer_tag) {
    return std::nullopt;
  }
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < 8; ++i) {
    value |= std::uint64_t{payload[2 + i]} << 8 * i;
  }
  const std::string name(payload.begin() + head, payload.end());
  const auto address = address_in(name);
  return address ? std::optional(SentWrite{first.at, first.destination(), *address,
                                           static_cast<std::int64_t>(value)})
                 : std::nullopt;
}

template <class Is> Time first_of(const std::vector<OnWire>& frames, Is is) {
  const auto found = std::ranges::find_if(frames, is);
  return found != frames.end() ? found->at : never;
}

} // namespace

std::uint16_t OnWire::type() const {
  return is_service() ? frame.id >> 16 & 0xFF : frame.id >> 8 & 0xFFFF;
}

bool OnWire::is_order() const {
  return is_request() && starts() && is_own(*this) &&
         (type() == restart_node || type() == execute_opcode);
}

/// A write takes several frames, of which the first begins with two bytes of CRC.
bool OnWire::is_change() const {
  return is_order() || (is_request() && starts() && is_own(*this) && type() == get_set &&
                        frame.size == 8 && (frame.data[3] & 7) == integer_tag);
}

std::vector<OnWire> Record::changes() const {
  std::vector<OnWire> found;
  std::ranges::copy_if(frames_, std::back_inserter(found), &OnWire::is_change);
  return found;
}

std::vector<SentWrite> Record::writes() const {
  std::vector<SentWrite> found;
  std::map<std::uint64_t, std::pair<OnWire, std::vector<std::uint8_t>>> begun;
  for (const OnWire& frame : frames_) {
    if (!frame.is_request() || frame.type() != get_set || !is_own(frame)) {
      continue;
    }
    const std::uint64_t key = std::uint64_t{frame.frame.id} << 8 | (frame.tail() & 0x1F);
    if (frame.starts()) {
      begun.insert_or_assign(key, std::pair(frame, std::vector<std::uint8_t>()));
    }
    const auto known = begun.find(key);
    if (known == begun.end()) {
      continue;
    }
    auto& [first, bytes] = known->second;
    bytes.insert(bytes.end(), frame.frame.data.begin(),
                 frame.frame.data.begin() + frame.frame.size - 1);
    if (frame.ends() && !frame.starts() && bytes.size() > 2) {
      bytes.erase(bytes.begin(), bytes.begin() + 2);
      if (const auto write = write_in(bytes, first)) {
        found.push_back(*write);
      }
    }
  }
  return found;
}

Time Record::last_told_by(const std::set<std::uint8_t>& nodes) const {
  Time last{};
  for (const OnWire& frame : frames_) {
    if (tells(frame) && nodes.contains(frame.source())) {
      last = frame.at;
    }
  }
  return last;
}

Time Record::first_told_by(const std::set<std::uint8_t>& nodes) const {
  return first_of(
      frames_, [&](const OnWire& frame) { return tells(frame) && nodes.contains(frame.source()); });
}

bool Record::shows_two_on(const std::set<std::uint8_t>& nodes) const {
  constexpr Duration last_moment = std::chrono::milliseconds(50);
  std::map<std::uint8_t, std::map<std::uint8_t, std::uint8_t>> uptimes; // by node and priority
  std::map<std::uint8_t, std::uint8_t> priorities;                      // of its last one
  for (const OnWire& frame : frames_) {
    if (frame.is_service() || frame.type() != node_status || !nodes.contains(frame.source()) ||
        frame.frame.size == 0 || frame.at > end() - last_moment) {
      continue;
    }
    const auto priority = static_cast<std::uint8_t>(frame.frame.id >> 24 & 0x1F);
    auto& known = uptimes[frame.source()];
    const auto run = known.find(priority);
    const std::uint8_t uptime_s = frame.frame.data[0];
    if (run != known.end() && priorities[frame.source()] != priority &&
        uptime_s == run->second + 1) {
      return true;
    }
    known[priority] = uptime_s;
    priorities[frame.source()] = priority;
  }
  return false;
}

Time Record::armed_at() const {
  return first_of(frames_, [](const OnWire& frame) {
    return !frame.is_service() && frame.type() == arming_status && frame.frame.size > 0 &&
           frame.frame.data[0] == fully_armed;
  });
}

Time Record::driven_at() const {
  return first_of(frames_, [](const OnWire& frame) {
    return !frame.is_service() && frame.type() == array_command && !is_own(frame) &&
           frame.starts() && frame.frame.data[frame.ends() ? 0 : crc_bytes] == every_servo;
  });
}

} // namespace blactl::campaign
