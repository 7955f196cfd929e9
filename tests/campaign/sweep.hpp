#pragma once
// Every single fault before random ones: for each changing command the k-th frame and the k-th
// system call, once and from then on.

#include "disturbance.hpp"
#include "episode.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace blactl::campaign {

/// Of one command and one kind of disturbance.
struct Swept {
  std::size_t places = 0; ///< frames or calls of the command when nothing goes wrong
  std::size_t runs = 0;
  std::size_t good = 0; ///< ended with 0
  std::size_t lies = 0; ///< false words, and what did not converge
};

/// By command and kind.
using SweptByKind = std::map<std::pair<std::string, std::string>, Swept>;

class Sweep {
 public:
  /// `step`: every so manieth place; `only`: of this kind, empty: of all; `tell`: receives every
  /// difference.
  Sweep(std::filesystem::path folder, std::size_t step, std::string only,
        std::function<void(const std::string&)> tell)
      : folder_(std::move(folder)), step_(step), only_(std::move(only)), tell_(std::move(tell)) {}

  /// Plays those of the cases whose turn it is: of `jobs` jobs this is number `job`.
  void play(unsigned job, unsigned jobs);

  [[nodiscard]] const SweptByKind& swept() const { return swept_; }

 private:
  struct Case;

  [[nodiscard]] static std::vector<Case> cases();
  void play(const Case& one);
  void disturb(const Case& one, Disturbance disturbance, const States& goal, Swept& swept);

  std::filesystem::path folder_;
  std::size_t step_;
  std::string only_;
  std::function<void(const std::string&)> tell_;
  SweptByKind swept_;
};

} // namespace blactl::campaign
