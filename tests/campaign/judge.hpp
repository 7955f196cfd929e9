#pragma once
// Whether what a command has told agrees with what happened in the servos. Nothing is exempt that a
// client can know.

#include "step.hpp"

#include <stdexcept>

namespace blactl::campaign {

/// A false word, or an order that must not have been sent.
class Lie : public std::runtime_error {
  using runtime_error::runtime_error;
};

/// Throws Lie.
void judge(const Step& step);

} // namespace blactl::campaign
