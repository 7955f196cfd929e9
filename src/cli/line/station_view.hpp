#pragma once
// The screen of a station, to be read from two metres, also by who reads neither language: the
// verdict by colour, symbol, word and sound; what to do now by colour, symbol and place. Up and at
// the top: something has to go; down and at the bottom: something has to come (contract, section
// 6).

#include "blactl/base/error.hpp"
#include "blactl/fleet/line/station.hpp"
#include "blactl/state/ledger_record.hpp"

#include "cli/output/reporter.hpp"
#include "cli/output/screen.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace blactl::cli {

/// The results of a run.
struct LineTotals {
  std::map<std::string, std::uint64_t> verdicts{};
  std::map<std::string, bool> first_passed{}; ///< by unit: whether its first result was a pass

  void add(const state::LedgerRecord& record);

  /// In percent; empty: no unit has a result yet.
  [[nodiscard]] std::optional<double> first_pass_yield() const;
};

/// "pass 3 fail 0 error 1 skip 0 first pass 100.0%"
[[nodiscard]] std::string text_of(const LineTotals& totals);

/// What the operator shall do.
enum class LineDeed : std::uint8_t {
  connect,
  scan,
  leave,
  hands_off,
  take_off,
  plug_in, ///< the adapter
  mend,    ///< the bus
};

struct StationPicture {
  std::string title{};
  LineTotals totals{};
  LineDeed deed = LineDeed::connect;
  std::optional<state::LedgerRecord> last{}; ///< until the next servo is recognised
  std::optional<Error> reason{};
  std::string label{}; ///< that counts, or is being typed; shown in place of the note
  std::string note{};  ///< the last one
};

/// The picture on a screen of this size.
[[nodiscard]] std::vector<ScreenLine> lines_of(const StationPicture& picture, std::size_t width,
                                               std::size_t height);

class StationView {
 public:
  /// `reporter` outlives this: its notes are shown, and again when the screen is gone.
  StationView(std::unique_ptr<Screen> screen, const Reporter& reporter, std::string title);
  ~StationView();
  StationView(const StationView&) = delete;
  StationView& operator=(const StationView&) = delete;

  void enter(fleet::StationStage stage);
  void wait_for_label();
  void show_label(std::string label);

  /// The bus is not there: its adapter is away, or something else.
  void lose_bus(bool is_away);

  void take(const state::LedgerRecord& record, const std::optional<Error>& reason);

  /// Rings what is still to be rung; called some times a second.
  void tick();

  void draw();

  /// What was typed since the last call, with the ends of lines.
  [[nodiscard]] std::string typed();

 private:
  std::unique_ptr<Screen> screen_;
  const Reporter& reporter_;
  StationPicture picture_;
  std::string held_;     ///< notes
  std::size_t told_ = 0; ///< so much of them is not shown any more
  int bells_ = 0;        ///< still to be rung
};

} // namespace blactl::cli
