#include "cli/line/unit_logs.hpp"

#include "blactl/base/system_error.hpp"
#include "blactl/fleet/line/line_record.hpp"

#include "cli/line/texts.hpp"
#include "cli/log_target.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

namespace blactl::cli {

Error UnitLogs::not_kept(const std::string& reason) const {
  return {Code::io, say<texts::provision_no_logs>(printable(folder_), reason),
          say<texts::provision_no_logs_hint>(), std::nullopt};
}

can::Recorder* UnitLogs::recorder() const {
  return folder_.empty() ? nullptr : context_.recorder();
}

Result<void> UnitLogs::open() {
  if (folder_.empty()) {
    return {};
  }
  std::error_code error;
  std::filesystem::create_directories(folder_, error);
  if (error) {
    return std::unexpected(not_kept(system_reason(error.value())));
  }
  const std::string present = folder_ + "/present.log";
  if (auto fit = check_target(present, Content::log, "--logs"); !fit) {
    return fit;
  }
  std::ofstream(present, std::ios::app).close(); // there is something to hold
  auto hold = FileHold::take(present);
  if (!hold) {
    return std::unexpected(hold.error().code == Code::busy ? hold.error()
                                                           : not_kept(hold.error().message));
  }
  hold_.emplace(std::move(*hold));
  context_.record_to(present);
  return {};
}

void UnitLogs::begin() {
  if (recorder() != nullptr) {
    recorder()->begin_anew();
  }
}

void UnitLogs::keep(const state::LedgerRecord& record) {
  const bool is_good =
      record.verdict == fleet::verdict::pass || record.verdict == fleet::verdict::skip;
  if (recorder() == nullptr || is_good) {
    return;
  }
  std::error_code error;
  std::filesystem::copy_file(recorder()->path(), folder_ + "/" + *record.record_id + ".log", error);
  if (error) {
    context_.reporter().note(not_kept(system_reason(error.value())).message);
  }
}

} // namespace blactl::cli
