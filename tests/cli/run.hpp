#pragma once
// Runs the built binary as a person or a script would: arguments and input go in, exit status and
// output come back. Nothing that a test starts outlives it.
//
//     const Bench bench;
//     const Background sim(bench, {"sim"});
//     const Result scan = bench.run({"-i", "sim:", "scan", "--json"});
//     CHECK(scan.status == 0);
//     CHECK(json(scan.out)["nodes"].size() == 3);

#include <nlohmann/json.hpp>

#include <sys/types.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::test {

using namespace std::chrono_literals;

using Arguments = std::vector<std::string>;

/// What the binary answered; `status` as `$?` of a shell, so 128 + n after a signal n.
struct Result {
  int status = -1;
  std::string out;
  std::string err;
};

/// Types `type` as soon as the output shows `after`. Each answer waits for output that came after
/// the previous one; Ctrl-C is "\x03" on a terminal.
struct Answer {
  std::string after;
  std::string type;
};

struct Options {
  /// What comes in on stdin at once. The end of input follows it, but never on a terminal.
  std::string stdin_text = {};
  std::vector<Answer> answers = {};
  /// The end of input does not follow: ask() comes. All that the child says to one question fits
  /// into its pipe.
  bool asks = false;
  /// Variables of the child; std::nullopt removes one.
  std::map<std::string, std::optional<std::string>> env = {};
  /// A child that still runs then is killed, and the test fails.
  std::chrono::milliseconds timeout = 20s;
  /// stdin and stderr are a terminal: what it shows is `err`, without echo.
  bool terminal = false;
  /// stdout is a terminal too (one of its own, so that `out` and `err` stay apart).
  bool terminal_stdout = false;
  unsigned short columns = 100;
  /// A file that takes stdout, such as /dev/full.
  std::string stdout_file = {};
  /// As `>&-` in a shell: the command begins without a standard output.
  bool close_stdout = false;
  /// The reader of stdout leaves when it has read this text.
  std::optional<std::string> leave_after = {};
};

/// A private place for one test: home, runtime and state folder of all that runs in it. The rest
/// of the environment is that of the test, without BLACTL_* and what changes output.
class Bench {
 public:
  Bench();
  ~Bench();
  Bench(const Bench&) = delete;
  Bench& operator=(const Bench&) = delete;

  /// Runs the binary to its end. Throws, with all output, when that takes longer than the timeout.
  [[nodiscard]] Result run(const Arguments& arguments, const Options& options = {}) const;

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }

  /// Writes a file of the bench and gives its path, ready to be an argument.
  [[nodiscard]] std::string file(std::string_view name, std::string_view text) const;

 private:
  std::filesystem::path folder_;
};

/// Runs the binary in a bench of its own.
[[nodiscard]] Result run(const Arguments& arguments, const Options& options = {});

/// A command that runs beside the test from the moment its output shows `until`; ended with it.
class Background {
 public:
  explicit Background(const Bench& bench, const Arguments& arguments, const Options& options = {},
                      std::string_view until = "ready");
  ~Background();
  Background(const Background&) = delete;
  Background& operator=(const Background&) = delete;

  [[nodiscard]] pid_t pid() const;

  /// Waits until the output shows `text`, for at most the timeout of the options.
  void expect(std::string_view text);

  /// Types a line; what came on stdout since the last question, up to the line with `until`. Needs
  /// Options::asks.
  [[nodiscard]] std::string ask(std::string_view line, std::string_view until);

  /// Waits for the end of the command.
  Result wait();

  /// Asks it to end, and waits for that.
  Result stop(int signal = SIGTERM);

  /// kill -9: it gets no chance to tidy up.
  void kill();

 private:
  class Process;
  friend class Bench;
  std::unique_ptr<Process> process_;
};

/// The one JSON document that `text` is.
[[nodiscard]] nlohmann::json json(std::string_view text);

/// A stream: one JSON object a line.
[[nodiscard]] std::vector<nlohmann::json> json_lines(std::string_view text);

} // namespace blactl::test
