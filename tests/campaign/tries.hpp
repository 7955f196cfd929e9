#pragma once
// What `undo` leaves after several tries of one command, judged by the servos' memory.

#include "story.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <utility>

namespace blactl::campaign {

class Tries {
 public:
  struct Counts {
    std::uint64_t stories = 0, undone = 0, lies = 0;
  };

  /// `folder`: for files of the stories. `tell`: receives every story that ends wrong.
  Tries(std::filesystem::path folder, std::function<void(const std::string&)> tell)
      : folder_(std::move(folder)), tell_(std::move(tell)) {}

  void play(std::uint64_t seed);

  [[nodiscard]] const Counts& counts() const { return counts_; }

 private:
  std::filesystem::path folder_;
  std::function<void(const std::string&)> tell_;
  Counts counts_;
};

} // namespace blactl::campaign
