#pragma once
// Simulated servos that live on between commands, for tests of what those leave behind.

#include "catch.hpp"
#include "scene.hpp"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace blactl::test {

using Document = nlohmann::ordered_json;

/// Simulated servos that live on between commands.
class Fleet {
 public:
  /// `shared`: options of the simulator and of every command.
  explicit Fleet(const Scene& scene, Arguments shared = {})
      : shared_(std::move(shared)), sim_(bench_, simulator(scene)) {}

  [[nodiscard]] Result run(Arguments arguments, const Options& options = {}) const {
    arguments.insert(arguments.end(), shared_.begin(), shared_.end());
    Options with_bus = options; // by the environment: hints repeat what is typed
    with_bus.env.try_emplace("BLACTL_INTERFACE", "sim:");
    return bench_.run(arguments, with_bus);
  }

  [[nodiscard]] Document exported() const {
    const Result result = run({"export"});
    REQUIRE(result.status == 0);
    return ordered_json(result.out);
  }

  [[nodiscard]] std::string file(const Document& document) const {
    return bench_.file("fleet.json", document.dump(2));
  }

  [[nodiscard]] std::string plan(const Document& document) const {
    return bench_.file("plan.json", document.dump(2));
  }

  [[nodiscard]] std::string params(const std::string& lines) const {
    return bench_.file("wing.param", lines);
  }

  [[nodiscard]] std::string file_name(const std::string& name) const {
    return (bench_.folder() / name).string();
  }

  [[nodiscard]] Result apply(const Document& document, const Arguments& more = {},
                             const Options& options = {}) const {
    Arguments arguments{"apply", file(document), "-y", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments, options);
  }

  /// The register of a node now: what RAM holds.
  [[nodiscard]] std::int64_t ram(const std::string& node, const std::string& parameter) const {
    const Result got = run({"get", "-n", node, parameter, "--json"});
    return json(got.out)["nodes"][0]["params"][0]["raw"];
  }

  /// The register of a node after a restart: what ROM held.
  [[nodiscard]] std::int64_t rom(const std::string& node, const std::string& parameter) const {
    REQUIRE(run({"restart", "-n", node, "-y"}).status == 0);
    return ram(node, parameter);
  }

  /// A state folder of its own for one command, with this file in it; without a name it is no
  /// folder itself.
  [[nodiscard]] Options broken_state(const std::string& name, const std::string& content) const {
    const std::filesystem::path folder = bench_.folder() / "broken";
    std::filesystem::create_directories(name.empty() ? bench_.folder() : folder / "simulated");
    std::ofstream(name.empty() ? folder : folder / "simulated" / name) << content;
    return {.env = {{"BLACTL_STATE_DIR", folder.string()}}};
  }

  [[nodiscard]] const Bench& bench() const { return bench_; }

  /// How often this happened to all servos together. The simulator ends.
  [[nodiscard]] std::ptrdiff_t count(std::string_view happened) {
    if (events_.empty()) {
      events_ = json_lines(sim_.stop().out);
    }
    return std::ranges::count_if(
        events_, [&](const nlohmann::json& event) { return event.value("event", "") == happened; });
  }

  /// How often SAVE was carried out by all servos together. The simulator ends.
  [[nodiscard]] std::ptrdiff_t rom_writes() { return count("rom_write"); }

 private:
  [[nodiscard]] Arguments simulator(const Scene& scene) const {
    Arguments arguments{"sim", scene.write(bench_), "--json", "--clock", "virtual"};
    arguments.insert(arguments.end(), shared_.begin(), shared_.end());
    return arguments;
  }

  Bench bench_;
  Arguments shared_;
  Background sim_;
  std::vector<nlohmann::json> events_;
};

inline std::vector<std::string> statuses(const Result& result) {
  std::vector<std::string> all;
  const auto document = json(result.out);
  for (const auto& node : document["nodes"]) {
    all.push_back(node["status"]);
  }
  return all;
}

} // namespace blactl::test
