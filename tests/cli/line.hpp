#pragma once
// What the tests of a production line share: servos that come to a bench and go, and a station.

#include "run.hpp"
#include "scene.hpp"

#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace blactl::test {

/// Eight servo IDs from 1, eight node IDs from 11, again and again, and one setting.
extern const std::string line_recipe;

/// A servo on the bench from one second to another.
struct Visit {
  int serial;
  double from, to; ///< seconds
  std::string model = "BLA21-12U-AB";
  int node_id = 0;
  nlohmann::json more = nlohmann::json::object();
};

/// The bus on which they come and go.
[[nodiscard]] Scene line(const std::vector<Visit>& visits);

struct Provisioned {
  Result result;
  std::vector<nlohmann::json> records;
  nlohmann::json last;

  /// "pass 1 11; fail label_mismatch; …"
  [[nodiscard]] std::string told() const {
    std::string all;
    for (const auto& record : records) {
      all += (all.empty() ? "" : "; ") + record["verdict"].get<std::string>();
      if (record["verdict"] == "pass" || record["verdict"] == "skip") {
        all += " " + record["servo_id"].dump() + " " + record["static_node_id"].dump();
      } else if (!record["code"].is_null()) {
        all += " " + record["code"].get<std::string>();
      }
    }
    return all;
  }
};

/// A run on a fresh bus, whose stores end with it. `recipe`: the text of the file.
[[nodiscard]] Provisioned provision(const Scene& scene, const Arguments& more,
                                    const Options& options = {},
                                    const std::string& recipe = line_recipe);

/// A served simulation, whose stores last.
class Hall {
 public:
  explicit Hall(const std::vector<Visit>& visits)
      : sim_(bench_, {"sim", line(visits).write(bench_)}),
        recipe_(bench_.file("recipe.json", line_recipe)) {}

  [[nodiscard]] Result run(Arguments arguments, const Options& options = {}) const {
    arguments.insert(arguments.begin(), {"-i", "sim:"});
    return bench_.run(arguments, options);
  }

  [[nodiscard]] Result provision(const Arguments& more) const {
    Arguments arguments{"provision", recipe_, "-y", "--json", "--station", "A"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }

  [[nodiscard]] std::vector<nlohmann::json> ledger(const Arguments& more = {}) const {
    Arguments arguments{"ledger", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto lines = json_lines(run(arguments).out);
    lines.pop_back();
    return lines;
  }

  [[nodiscard]] const Bench& bench() const { return bench_; }

  [[nodiscard]] const std::string& recipe_file() const { return recipe_; }

 private:
  Bench bench_;
  Background sim_;
  std::string recipe_;
};

} // namespace blactl::test
