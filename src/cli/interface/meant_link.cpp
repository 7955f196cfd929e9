#include "cli/interface/meant_link.hpp"

#include "cli/interface/scheme.hpp"

#include <vector>

namespace blactl::cli {

bool may_be_link(const std::string& interface) {
  return interface.empty() || names(interface, Behind::link);
}

std::optional<can::Link> meant_link(const std::string& interface) {
  const auto links = may_be_link(interface) ? can::links() : Result<std::vector<can::Link>>();
  if (!links) {
    return std::nullopt;
  }
  const auto name = parse_interface(interface);
  for (const can::Link& link : *links) {
    const bool is_meant = interface.empty()
                              ? links->size() == 1 || can::only_one_up(*links) == &link
                              : link.name == name->rest;
    if (is_meant) {
      return link;
    }
  }
  return std::nullopt;
}

} // namespace blactl::cli
