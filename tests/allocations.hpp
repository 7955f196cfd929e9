#pragma once

#include <cstddef>

namespace blactl::test {

/// How often this program has asked for memory with `new` since it began. A program that asks for
/// this number replaces the global operators: counting is the only way to see that there are none.
std::size_t allocations();

} // namespace blactl::test
