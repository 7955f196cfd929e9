#pragma once
// What the tests of the binary share: a simulated bus written down in one line, and how a result
// is looked at.
//
//     const Scene scene = Scene().servo("BLA21-12U-AB", 11).foreign(40, {{"armed", true}});
//     const Result got = scene.run({"get", "-n", "11", "--json"});
//
// Every run has a fresh bus of its own on the virtual clock, so it ends at once, however busy the
// machine is.

#include "run.hpp"

#include <nlohmann/json.hpp>

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace blactl::test {

class Scene {
 public:
  /// `more`: further keys of the scenario file.
  Scene& servo(std::string_view model, int node_id, const nlohmann::json& more = {});
  Scene& foreign(int node_id, const nlohmann::json& more = {});

  /// Of everything random.
  Scene& seed(int number);

  /// What the wire does to frames.
  Scene& wire(const nlohmann::json& faults);

  /// The servo with this serial number has no power until then.
  Scene& joins(int serial_number, std::string_view at);

  /// To the servo with this serial number, after this time.
  Scene& event(int serial_number, std::string_view happens, std::string_view at);

  /// What is around the servo with this serial number changes after this time: "hand" to "30deg".
  Scene& world(int serial_number, const nlohmann::json& changes, std::string_view at);

  /// The interfaces of all commands are "cut", or "joined" again, after this time.
  Scene& clients(std::string_view what, std::string_view at);

  /// Writes the scenario file and gives its path.
  [[nodiscard]] std::string write(const Bench& bench) const;

  /// Runs the binary on this scenario (BLACTL_INTERFACE). A scenario that the simulator refuses is
  /// a failure of the test.
  [[nodiscard]] Result run(const Arguments& arguments, const Options& options = {}) const;
  [[nodiscard]] Result run(const Bench& bench, const Arguments& arguments,
                           const Options& options = {}) const;

 private:
  nlohmann::json document_ = {{"schema", "blactl-scenario/1"},
                              {"clock", "virtual"},
                              {"servos", nlohmann::json::array()},
                              {"foreign", nlohmann::json::array()},
                              {"events", nlohmann::json::array()}};
};

/// 11: a BLA21 with PWM input, 12: a BLA15 without, 13: a BLA34.
[[nodiscard]] Scene three_servos();

[[nodiscard]] bool contains(std::string_view text, std::string_view part);

/// All of a file.
[[nodiscard]] std::string content(const std::filesystem::path& path);

/// The words in brackets of "blactl: [timeout] …" on stderr.
[[nodiscard]] std::vector<std::string> codes(const Result& result);

/// That a command failed for one reason, and what it says of it on stderr.
void check_error(const Result& result, int status, const std::string& code,
                 std::string_view message);

/// The members of an object in the order of the document.
[[nodiscard]] std::vector<std::string> keys(const nlohmann::ordered_json& object);
[[nodiscard]] nlohmann::ordered_json ordered_json(std::string_view text);

/// What is left without the colours of a terminal.
[[nodiscard]] std::string without_colour(std::string text);

/// The cells of a terminal that the longest line takes; Japanese characters are two.
[[nodiscard]] std::size_t longest_line(std::string_view text);

/// Well-formed UTF-8 without control characters other than the line break.
[[nodiscard]] bool is_fit_for_a_terminal(std::string_view text);

} // namespace blactl::test
