#include "blactl/fleet/files/params_file.hpp"

#include "blactl/base/json_reader.hpp"

#include "fleet/files/settings_reader.hpp"
#include "fleet/files/texts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>
#include <vector>

namespace blactl::fleet {

using bla::Assignment;

namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF"; // as written by some editors
constexpr std::string_view word_ends = " \t,\r";             // \r: files from Windows
constexpr std::string_view decimal_digits = "0123456789";

std::string_view without_mark(std::string_view text) {
  text.remove_prefix(text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0);
  return text;
}

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(word_ends); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(word_ends, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(word_ends, end);
  }
  return words;
}

bool is_whole(std::string_view value) {
  value.remove_prefix(value.starts_with('-') ? 1 : 0);
  return !value.empty() && value.find_first_not_of(decimal_digits) == std::string_view::npos;
}

/// Empty: it has none.
std::optional<FleetEntry> without_ids(FleetEntry entry) {
  const auto erased = std::erase_if(
      entry.set, [](const Assignment& each) { return bla::is_id(each.parameter->address); });
  return erased > 0 ? std::optional(std::move(entry)) : std::nullopt;
}

class ParamsReader {
 public:
  ParamsReader(std::string file, const bla::Profiles& profiles)
      : profiles_(profiles), faults_(std::move(file)) {}

  Result<FleetFile> read(std::string_view text) {
    while (!text.empty()) {
      const std::size_t end = std::min(text.find('\n'), text.size());
      ++line_;
      read_line(text.substr(0, end));
      text.remove_prefix(std::min(end + 1, text.size()));
    }
    if (lines_.empty() && faults_.empty()) {
      faults_.add(std::max<std::size_t>(line_, 1), {}, say<texts::params_empty>());
    }
    if (auto fine = faults_.result(); !fine) {
      return std::unexpected(fine.error());
    }
    std::ranges::sort(set_, {}, [](const Assignment& each) { return each.parameter->address; });
    FleetEntry entry{.name = {}, .match = {}, .set = std::move(set_), .about = {}};
    return FleetFile{.file = faults_.file(),
                     .servos = {entry},
                     .is_params = true,
                     .passed_over = {passed_over_.begin(), passed_over_.end()},
                     .entry_without_ids = without_ids(std::move(entry))};
  }

 private:
  void read_line(std::string_view line) {
    const auto words = words_of(line);
    if (words.empty() || words.front().starts_with('#')) {
      return;
    }
    if (words.size() != 2) {
      faults_.add(line_, std::string(words.front()), say<texts::params_no_pair>());
      return;
    }
    const auto address = bla::find_address(words[0]);
    if (!address) {
      fault(words[0], about_name(words[0]));
    } else if (profiles_.find(*address) != nullptr && !profiles_.is_setting(*address)) {
      passed_over_.insert(*address);
    } else if (!is_whole(words[1])) {
      fault(words[0], say<texts::params_not_whole>(printable(words[1])));
    } else {
      assign(*address, words[1]);
    }
  }

  void assign(bla::Address address, std::string_view value) {
    if (const auto [it, is_new] = lines_.try_emplace(address, line_); !is_new) {
      fault(address.name(), say<texts::params_twice>(it->second));
      return;
    }
    auto assignment = bla::make_assignment(profiles_, address.name(), value);
    if (assignment) {
      set_.push_back(std::move(*assignment));
    } else {
      fault(address.name(), fault_text(assignment.error()));
    }
  }

  /// The reason why it is not an address.
  [[nodiscard]] std::string about_name(std::string_view name) const {
    if (name.find_first_not_of(decimal_digits) == std::string_view::npos) {
      return say<texts::params_decimal_name>(name);
    }
    const auto known = profiles_.find(name);
    return known ? say<texts::params_own_name>((*known)->address.name())
                 : say<texts::params_unknown_name>();
  }

  void fault(std::string_view name, std::string reason) {
    faults_.add(line_, std::string(name), std::move(reason));
  }

  const bla::Profiles& profiles_;
  json::Faults faults_;
  std::size_t line_ = 0;
  std::map<bla::Address, std::size_t> lines_; ///< of each setting
  std::vector<Assignment> set_;
  std::set<bla::Address> passed_over_;
};

} // namespace

Result<FleetFile> parse_params_file(std::string_view text, std::string file,
                                    const bla::Profiles& profiles) {
  return ParamsReader(std::move(file), profiles).read(without_mark(text));
}

std::string params_file(const Snapshot& servo, const FleetFileStyle& style) {
  const auto serial = servo.servo.identity.readings().serial_number;
  // The GUI Tool reads lines of at least two words only.
  std::string text = fmt::format("# {} {} blactl {}\n", servo.servo.identity.model(),
                                 serial ? std::to_string(*serial) : "unknown", style.tool_version);
  for (const Reading& reading : servo.readings) {
    if (reading.parameter->is_setting() && reading.raw) {
      text += fmt::format("{} {}\n", reading.parameter->address.name(), *reading.raw);
    }
  }
  return text;
}

} // namespace blactl::fleet
