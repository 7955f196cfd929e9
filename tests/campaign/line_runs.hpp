#pragma once
// Plays production lines, and has them judged: random ones, and calm ones with every single fault.

#include "line.hpp"
#include "line_story.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace blactl::campaign {

class LineRuns {
 public:
  struct Counts {
    std::uint64_t runs = 0, lies = 0;
    std::map<std::string, std::uint64_t> records; ///< by verdict and code
  };

  /// `folder`: for files of the lines. `tell`: receives every line that ends wrong.
  LineRuns(std::filesystem::path folder, std::function<void(const std::string&)> tell,
           bool is_verbose)
      : folder_(std::move(folder)), tell_(std::move(tell)), is_verbose_(is_verbose) {}

  void play(std::uint64_t seed);

  struct Sweep {
    std::size_t step = 1; ///< every n-th place
    unsigned job = 0, jobs = 1;
    bool until_found = false;
    std::function<void()> begins; ///< called before each run
  };

  /// The calm line with this seed, and in it every single frame, call and write disturbed.
  void play_each(std::uint64_t seed, const Sweep& sweep);

  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  [[nodiscard]] std::size_t places_of(const Line& line, Disturbance::Kind kind) const;
  void judged(const std::string& name, const Line& line,
              const std::vector<Disturbance>& disturbances,
              const std::function<void(const LineStory&)>& check);

  std::filesystem::path folder_;
  std::function<void(const std::string&)> tell_;
  bool is_verbose_;
  Counts counts_;
};

} // namespace blactl::campaign
