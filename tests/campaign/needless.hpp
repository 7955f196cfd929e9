#pragma once
// Why a good command need not end with 0 where one kind of fault is switched on.

#include <string_view>

namespace blactl::campaign {

/// A sentence; empty: it ends with 0, however long it takes.
[[nodiscard]] std::string_view why_not_0(std::string_view kind_of_fault);

} // namespace blactl::campaign
