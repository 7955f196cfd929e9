#pragma once
// What a command that runs in this process prints.

#include <string>
#include <utility>

namespace blactl::campaign {

/// Takes standard output and errors of this process while it exists.
class Capture {
 public:
  Capture();
  ~Capture();
  Capture(const Capture&) = delete;
  Capture& operator=(const Capture&) = delete;

  /// What was printed so far: output, errors.
  [[nodiscard]] std::pair<std::string, std::string> taken() const;

 private:
  int out_, err_; ///< what they were
};

} // namespace blactl::campaign
