#pragma once
// The screen of a station, to be read from two metres, also by who reads neither language: the
// verdict by colour, symbol, word and sound; what to do now by colour, symbol and place. Up and at
// the top: something has to go; down and at the bottom: something has to come (contract, section
// 6).

#include "blactl/base/error.hpp"
#include "blactl/fleet/line/station.hpp"
#include "blactl/state/ledger_record.hpp"

#include "cli/line/line_totals.hpp"
#include "cli/output/screen.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace blactl::cli {

/// What the operator shall do.
enum class LineDeed : std::uint8_t {
  connect,
  scan,
  leave,
  hands_off,
  bring_back, ///< it has gone too early
  take_off,
  plug_in, ///< the adapter
  mend,    ///< the bus
};

/// What is to be seen; its methods tell what has happened.
struct StationPicture {
  std::string title{};
  LineTotals totals{};
  LineDeed deed = LineDeed::connect;
  std::optional<state::LedgerRecord> last{}; ///< until the next servo is recognised
  std::optional<Error> reason{};
  std::optional<state::LedgerRecord> joined{}; ///< of several, while the last result stands
  std::optional<Error> joined_reason{};
  bool is_repeating = false;      ///< as Station::is_repeating()
  bool has_successor = false;     ///< another one lies there already: nobody takes off the last one
  std::string label{};            ///< that counts, or is being typed; shown in place of the note
  std::size_t waiting_labels = 0; ///< that were read ahead
  std::string bad_label{};        ///< the last one, if it was none: it has to be read again
  std::string note{};             ///< the last one
  std::optional<std::int64_t> gone{}; ///< the number of the one that has gone too early
  bool is_stopping = false;           ///< the present servo is the last one
  std::size_t beat = 0;               ///< of what moves

  /// `serial_number`: as Station::StageHook.
  void enter(fleet::StationStage stage, std::optional<std::int64_t> serial_number = {});
  void take(const state::LedgerRecord& record, const std::optional<Error>& why, bool is_again,
            bool is_occupied);

  /// Another one has come beside the last one, whose result stands until it has left.
  void join(const state::LedgerRecord& record, const std::optional<Error>& why);

  /// Whether it goes on without the operator.
  [[nodiscard]] bool is_busy() const;

  /// Called some times a second; returns whether something has moved.
  [[nodiscard]] bool tick();

  /// Whether all that are on the bench have to go.
  [[nodiscard]] bool are_several() const;

  /// How often the bell rings for the last record.
  [[nodiscard]] int bells() const;
};

/// The picture on a screen of this size.
[[nodiscard]] std::vector<ScreenLine> lines_of(const StationPicture& picture, std::size_t width,
                                               std::size_t height);

} // namespace blactl::cli
