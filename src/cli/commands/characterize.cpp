// blactl characterize: measures on one servo what the specification leaves open.

#include "blactl/base/replace_file.hpp"
#include "blactl/fleet/bus/read_job.hpp"
#include "blactl/fleet/characterize/characterization.hpp"

#include "cli/change/writing_run.hpp"
#include "cli/commands.hpp"
#include "cli/log_target.hpp"
#include "cli/output/characterize_view.hpp"
#include "cli/stores.hpp"
#include "cli/texts.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace blactl::cli {
namespace {

struct CharacterizeOptions {
  std::string file{}; ///< empty: none
};

constexpr Option characterize_arguments[]{
    {.name = "FILE",
     .kind = Kind::file,
     .help = {"where the facts go that `sim --facts` loads; `-`: stdout (default: a table only)",
              "`sim --facts` 用の facts ファイル。`-` で標準出力 (省略時: 表のみ)"},
     .store = into<&CharacterizeOptions::file>},
};

/// One run. Each step may end it, with errors in the report.
class Characterize : WritingRun {
 public:
  Characterize(const CharacterizeOptions& options, Context& context, Report& report)
      : WritingRun(context, report), options_(options) {}

  void all() {
    if (select() && read() && hear() && check() && confirm() && check()) {
      measure();
    } else if (report_.signal != 0) {
      hint_interruption(say<texts::nothing_written_hint>());
    }
    report_.count_targets(std::max<std::size_t>(1, report_.targets.size()));
  }

 private:
  bool select();
  bool read();
  bool check();
  bool confirm();
  void measure();
  void conclude(fleet::Characterization measured);
  [[nodiscard]] std::optional<Error> write(const fleet::Characterization& measured) const;

  const CharacterizeOptions& options_;
  dronecan::NodeId id_{};
  fleet::Snapshot before_;
};

bool Characterize::select() {
  const auto one = open_for_one("characterize", Recording::if_possible);
  id_ = one.value_or(dronecan::NodeId{});
  return one.has_value();
}

bool Characterize::read() {
  auto snapshots =
      fleet::take_snapshots(context_.session(), context_.known(), std::span(&id_, 1),
                            context_.identification(), fleet::registers_to_characterize);
  if (snapshots.broken) {
    return broken(*snapshots.broken);
  }
  before_ = std::move(snapshots.servos.front());
  if (auto error = before_.first_error()) {
    report_.fail_target(std::move(*error));
    return false;
  }
  return true;
}

/// Checks that nothing forbids it, again after the question, which may take a while.
bool Characterize::check() {
  if (auto refused = fleet::refuse_to_characterize(context_.session(), before_,
                                                   context_.shared().while_driven)) {
    report_.fail_target(std::move(*refused));
  }
  return report_.targets.empty();
}

bool Characterize::confirm() {
  tell_others();
  return WritingRun::confirm(fleet::question_to_characterize(before_));
}

void Characterize::measure() {
  const Reporter& reporter = context_.reporter();
  const auto tell = [&reporter, told = false]() mutable {
    if (!std::exchange(told, true)) {
      reporter.note(say<texts::characterize_putting_back>());
    }
  };
  const auto tell_once = std::make_shared<std::function<void()>>(tell);
  context_.session().on_stopping([tell_once] { (*tell_once)(); });
  reporter.note(say<texts::do_not_cut_supply>());
  const fleet::Manner recorded = WritingRun::manner({}, true);
  const fleet::BenchManner manner{
      .identification = context_.identification(),
      .while_driven = context_.shared().while_driven,
      .may_allocate = context_.may_allocate(),
      .allocations =
          [this] {
            return open_allocations(context_.shared().interface,
                                    state::AllocationStore::Access::write);
          },
      .progress = [&reporter](const std::string& stage) { reporter.progress(stage); },
      .history = history(),
      .not_recorded = recorded.not_recorded,
      .end_not_recorded = recorded.end_not_recorded,
      .putting_back = [tell_once] { (*tell_once)(); }};
  conclude(fleet::characterize(context_.session(), context_.known(), before_, manner));
}

void Characterize::conclude(fleet::Characterization measured) {
  std::vector<Error> errors;
  if (measured.error && measured.error->code == Code::interrupted) {
    (void)broken(*measured.error);
    hint_interruption(measured.not_put_back   ? say<texts::characterize_not_put_back_hint>()
                      : measured.was_put_back ? say<texts::characterize_put_back_hint>()
                                              : say<texts::nothing_written_hint>());
  } else if (measured.error) {
    errors.push_back(*measured.error);
  }
  if (measured.not_put_back) {
    errors.push_back(*measured.not_put_back);
  }
  if (auto unwritten = measured.is_done() ? write(measured) : std::nullopt) {
    errors.push_back(std::move(*unwritten));
  }
  const bool is_done = measured.is_done() && errors.empty();
  report_.targets.push_back({.errors = std::move(errors)});
  const auto kept = std::make_shared<fleet::Characterization>(std::move(measured));
  const auto file = options_.file.empty() ? std::nullopt : std::optional(options_.file);
  report_.json = [kept, file, is_done](JsonWriter& json) {
    write_characterization(json, *kept, file, is_done);
  };
  if (!kept->is_done()) {
    return;
  }
  const auto facts = std::make_shared<std::string>(
      fleet::facts_file(*kept, context_.session().wall(), BLACTL_VERSION));
  report_.text = [kept, file, facts, is_done](const Page& page) {
    if (file == "-") {
      return *facts;
    }
    const auto count = std::ranges::count_if(
        kept->facts, [](const fleet::Fact& fact) { return fact.value.has_value(); });
    return characterize_text(*kept, page) + say<texts::characterize_as_before>() +
           (file && is_done
                ? say<texts::characterize_written>(count, printable(*file), printable(*file))
                : std::string());
  };
}

std::optional<Error> Characterize::write(const fleet::Characterization& measured) const {
  if (options_.file.empty() || options_.file == "-") {
    return std::nullopt;
  }
  const auto written = replace_file(
      options_.file, fleet::facts_file(measured, context_.session().wall(), BLACTL_VERSION));
  return written ? std::nullopt : std::optional(written.error());
}

Report execute(const CharacterizeOptions& options, Context& context) {
  Report report{.interface = printable(context.shared().interface)};
  if (auto profiles = context.profiles(); !profiles) {
    report.fail(profiles.error());
    return report;
  }
  const bool is_file = !options.file.empty() && options.file != "-";
  if (auto writable =
          is_file ? check_target(options.file, Content::facts, "characterize") : Result<void>();
      !writable) {
    report.fail(writable.error());
    return report;
  }
  Characterize(options, context, report).all();
  return report;
}

} // namespace

constinit const Command commands::characterize{
    .name = "characterize",
    .traits = {.writes = true, .session = true},
    .help = {"measures on one servo what the specification leaves open, and restores it",
             "仕様書で不明な挙動を 1 台で測定し、元の状態に戻す"},
    .arguments = characterize_arguments,
    .action = action<CharacterizeOptions, execute>,
};

} // namespace blactl::cli
