#pragma once
// What is true of several nodes is told once.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace blactl::cli {

/// A text about one node, which it may name by its ID.
struct AboutNode {
  std::optional<std::uint8_t> id; ///< empty: like no other
  std::string text;
};

/// Texts that differ in nothing but the node ID.
struct Alike {
  std::size_t first = 0;              ///< the place of the first of them
  std::vector<std::uint8_t> others{}; ///< the node IDs of the others
};

/// In the order of the first ones.
[[nodiscard]] std::vector<Alike> alike(std::span<const AboutNode> all);

/// `text`, and that it is true of the others too; the text alone if there are none.
[[nodiscard]] std::string likewise(std::string text, std::span<const std::uint8_t> others);

} // namespace blactl::cli
