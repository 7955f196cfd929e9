#pragma once
// `--events FILE`: the events of each servo, one JSON object per line.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/fleet/bus/servo.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::cli {

/// Each line is one write(2), so that a reported line is in the file even if this process is
/// killed. After a line that cannot be written there are no more; the work goes on, and error()
/// returns the reason.
class EventFile {
 public:
  /// Creates or replaces the file, like a shell's redirection. A pipe must have its reader. Errors:
  /// io; usage (stdout).
  [[nodiscard]] static Result<std::unique_ptr<EventFile>> open(const std::string& path);

  ~EventFile();
  EventFile(const EventFile&) = delete;
  EventFile& operator=(const EventFile&) = delete;

  /// A line of JSON, without its end.
  void tell(std::string line);

  void tell(WallTime time, const fleet::Servo& servo, std::string_view stage,
            std::string_view status);

  [[nodiscard]] const std::optional<Error>& error() const { return error_; }

 private:
  EventFile(int descriptor, std::string path) : descriptor_(descriptor), path_(std::move(path)) {}

  int descriptor_;
  std::string path_;
  std::optional<Error> error_{};
};

} // namespace blactl::cli
