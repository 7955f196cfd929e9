#pragma once
// `apply --events FILE`: what happens to each servo, a line of JSON at a time.

#include "blactl/base/error.hpp"
#include "blactl/base/time.hpp"
#include "blactl/fleet/bus/servo.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace blactl::cli {

/// Each line is one write(2): a line that was told is in the file even if this process is killed.
/// A line that cannot be written is the last one; the work goes on, and error() tells it.
class EventFile {
 public:
  /// The file is made new; one that is there is replaced, as a shell's redirection does. A pipe
  /// must have its reader. Errors: io; usage (stdout).
  [[nodiscard]] static Result<std::unique_ptr<EventFile>> open(const std::string& path);

  ~EventFile();
  EventFile(const EventFile&) = delete;
  EventFile& operator=(const EventFile&) = delete;

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
