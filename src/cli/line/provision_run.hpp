#pragma once
// One run of `blactl provision` on a line: servos come and go until one of its ends.

#include "blactl/fleet/files/label.hpp"
#include "blactl/fleet/files/recipe.hpp"
#include "blactl/fleet/line/station.hpp"
#include "blactl/state/counter_store.hpp"
#include "blactl/state/ledger_store.hpp"
#include "blactl/state/station_lock.hpp"

#include "cli/change/event_file.hpp"
#include "cli/change/writing_run.hpp"
#include "cli/context.hpp"
#include "cli/line/label_lines.hpp"
#include "cli/line/station_view.hpp"
#include "cli/line/unit_logs.hpp"
#include "cli/output/report.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::cli {

struct ProvisionOptions {
  std::string recipe{};
  std::string label{};
  std::string range{};
  std::optional<std::uint64_t> count{};
  std::optional<Duration> idle_timeout{};
  std::string station{}, operator_name{}, work_order{};
  bool redo = false;
  std::string reason{};
  std::optional<unsigned> max_attempts{};
  std::optional<std::uint64_t> stop_after{};
  std::string events{};
  std::string logs{};
};

class ProvisionRun : private WritingRun {
 public:
  /// All references outlive this.
  ProvisionRun(const ProvisionOptions& options, fleet::Recipe recipe, std::string recipe_sha256,
               Context& context, Report& report);

  void run();

 private:
  [[nodiscard]] static state::LedgerRecord common_record(const ProvisionOptions& options,
                                                         const fleet::Recipe& recipe,
                                                         std::string recipe_sha256);
  [[nodiscard]] fleet::Station::Options station_options();
  [[nodiscard]] Result<void> check_stores() const;
  [[nodiscard]] bool begin();
  void serve(state::LedgerStore& ledger, state::CounterStore& counters);
  [[nodiscard]] bool next(fleet::Station& station);
  void ask_for_label();
  [[nodiscard]] bool wait_for_line(const fleet::Station& station, bool& is_recognised);
  [[nodiscard]] bool wait_for_label(const fleet::Station& station);
  [[nodiscard]] bool work_on(fleet::Station& station, const fleet::Station::Arrival& arrival);
  [[nodiscard]] bool conclude(const state::LedgerRecord& record, const fleet::Station& station);
  [[nodiscard]] bool refuse_joined(fleet::Station& station, bool stands);
  [[nodiscard]] bool take_off(fleet::Station& station);
  [[nodiscard]] bool print(const state::LedgerRecord& record, const std::optional<Error>& reason);
  [[nodiscard]] bool put(std::string_view text);
  void take_typed(const std::string& typed);
  void show_label();
  void account(const state::LedgerRecord& record, const std::optional<Error>& reason);
  [[nodiscard]] bool is_complete() const;
  [[nodiscard]] bool goes_on_after(const Error& error);
  [[nodiscard]] bool be_the_station();
  [[nodiscard]] bool open_events();
  void open_screen();
  void open_labels();
  void tell(fleet::StationStage stage, std::optional<std::int64_t> serial_number = {});
  void tell_event(std::string_view event, const state::LedgerRecord* record,
                  const std::string& message = {}) const;
  [[nodiscard]] Time idle_deadline() const;
  void end_by_idling();
  void end_without_record();

  const ProvisionOptions& options_;
  fleet::Recipe recipe_;
  state::LedgerRecord common_; ///< what all records share
  std::optional<LabelLines> lines_;
  std::optional<fleet::Label> label_;         ///< of the next servo
  std::optional<state::StationLock> station_; ///< held
  UnitLogs logs_;
  std::unique_ptr<EventFile> events_; ///< null: none
  std::unique_ptr<StationView> view_; ///< null: lines
  LineTotals totals_{};
  std::string last_line_{};            ///< of the last record, with its end
  std::uint64_t counted_ = 0;          ///< for --count
  std::uint64_t failed_in_row_ = 0;    ///< for --stop-after
  std::optional<std::int64_t> gone_{}; ///< the number of one that fell silent before its end
};

} // namespace blactl::cli
