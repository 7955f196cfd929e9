#pragma once
// `provision --logs FOLDER`: the frames of every servo that did not pass.

#include "blactl/base/error.hpp"
#include "blactl/base/file_hold.hpp"
#include "blactl/state/ledger_record.hpp"

#include "cli/context.hpp"

#include <optional>
#include <string>

namespace blactl::cli {

class UnitLogs {
 public:
  /// `folder`: empty: none are kept. `context` outlives this.
  UnitLogs(std::string folder, Context& context) : folder_(std::move(folder)), context_(context) {}

  /// Called before the session is opened. Errors: io; usage: the file for the present frames is
  /// something else; busy: another station writes it.
  [[nodiscard]] Result<void> open();

  /// The frames from now on are those of the next unit.
  void begin();

  /// Keeps those of this unit, unless it passed: in a file named by its record.
  void keep(const state::LedgerRecord& record);

 private:
  [[nodiscard]] Error not_kept(const std::string& reason) const;
  [[nodiscard]] can::Recorder* recorder() const;

  std::string folder_;
  Context& context_;
  std::optional<FileHold> hold_{}; ///< of the file for the present frames
};

} // namespace blactl::cli
