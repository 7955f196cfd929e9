#pragma once
// The picture of a station on a terminal, and its bell.

#include "blactl/base/error.hpp"
#include "blactl/fleet/line/station.hpp"
#include "blactl/state/ledger_record.hpp"

#include "cli/line/station_picture.hpp"
#include "cli/output/reporter.hpp"
#include "cli/output/screen.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

namespace blactl::cli {

class StationView {
 public:
  /// `reporter` outlives this: its notes are shown, and again when the screen is gone.
  StationView(std::unique_ptr<Screen> screen, const Reporter& reporter, std::string title);
  ~StationView();
  StationView(const StationView&) = delete;
  StationView& operator=(const StationView&) = delete;

  /// As StationPicture::enter().
  void enter(fleet::StationStage stage, std::optional<std::int64_t> serial_number);
  void wait_for_label();

  /// The one that counts or is being typed, and how many were read ahead.
  void show_label(std::string label, std::size_t waiting);

  /// A line that is no label was read; empty: one that is has followed.
  void refuse_label(const std::string& line);

  /// The bus is not there: its adapter is away, or something else.
  void lose_bus(bool is_away);

  /// The run ends with the present servo.
  void stop();

  /// `is_repeating`: as that of the station; `is_occupied`: a servo is on the bench.
  void take(const state::LedgerRecord& record, const std::optional<Error>& reason,
            bool is_repeating, bool is_occupied);

  /// As StationPicture::join().
  void join(const state::LedgerRecord& record, const std::optional<Error>& reason);

  /// Rings what is still to be rung, and moves what moves; called some times a second.
  void tick();

  void draw();

  /// What was typed since the last call, with the ends of lines.
  [[nodiscard]] std::string typed();

 private:
  void ring(int times);

  std::unique_ptr<Screen> screen_;
  const Reporter& reporter_;
  StationPicture picture_;
  std::string held_;     ///< notes
  std::size_t told_ = 0; ///< so much of them is not shown any more
  int bells_ = 0;        ///< still to be rung
};

} // namespace blactl::cli
