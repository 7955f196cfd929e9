#pragma once
// The text of PEAK's TRC logs (PCAN-View, PCAN-Explorer, and others that write their format) from
// version 1.1 to 2.1.
//
//   ;$FILEVERSION=2.1
//   ;$STARTTIME=41766.4648963872
//   ;$COLUMNS=N,O,T,B,I,d,R,L,D
//         1      1059.900 DT 1  1401552A Rx -  8    D2 04 00 00 00 07 00 C0
//
// Source: the examples of PEAK-System's "PEAK CAN TRC File Format"; trc.py of python-can; of error
// frames peak-trc.c of Wireshark.

#include "blactl/base/time.hpp"
#include "blactl/can/log_line.hpp"

#include "can/log/log_words.hpp"

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace blactl::can {

/// Reads a TRC log line by line. Its bus 1 is the interface "can1"; versions without buses have
/// "can".
///
/// Frames are read only where the version and, from 2.0 on, the columns are known. Frames of CAN
/// FD, and what the log says of the adapter, are LogLine::Kind::other.
class TrcLog {
 public:
  /// Whether a TRC log from version 1.1 on begins so.
  [[nodiscard]] static bool begins(std::string_view line);

  /// Empty: not a line of a TRC log. A trailing line end is allowed. The strings are valid until
  /// the next call. Never allocates.
  [[nodiscard]] std::optional<LogLine> parse(std::string_view line);

 private:
  /// The words of a line up to its data, by the letter of their column.
  class Fields;

  [[nodiscard]] bool take_keyword(std::string_view line);
  [[nodiscard]] bool take_version(std::string_view version);
  [[nodiscard]] bool take_start(std::string_view days);
  [[nodiscard]] bool take_columns(std::string_view list);
  void set_columns(std::string_view columns);

  [[nodiscard]] std::string_view columns() const { return {letters_.data(), columns_size_}; }

  [[nodiscard]] std::optional<LogLine> message(std::string_view text);
  [[nodiscard]] bool take_frame(const Fields& fields, Words& data, bool is_remote, LogLine& line);
  [[nodiscard]] bool take_first_version(const Fields& fields, Words& data, LogLine& line);
  [[nodiscard]] bool take_second_version(const Fields& fields, Words& data, LogLine& line);

  static constexpr std::size_t most_columns = 9;

  bool has_types_ = false; ///< a column tells the type of a message: from version 2.0 on
  std::array<char, most_columns> letters_{}; ///< of the columns, as in PEAK's document
  std::size_t columns_size_ = 0;             ///< 0: not known
  std::optional<WallTime> start_;
  ChannelName channel_;
};

} // namespace blactl::can
