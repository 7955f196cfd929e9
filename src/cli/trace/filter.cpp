#include "cli/trace/filter.hpp"

#include "blactl/base/nearest.hpp"
#include "blactl/base/texts.hpp"
#include "blactl/dronecan/standard_types.hpp"
#include "blactl/fleet/target.hpp"

#include "cli/texts.hpp"

#include <algorithm>
#include <charconv>
#include <memory>
#include <string_view>
#include <utility>

namespace blactl::cli {
namespace {

using dronecan::DataType;
using dronecan::Kind;

std::vector<std::string_view> words_of(std::string_view list) {
  std::vector<std::string_view> words;
  for (;;) {
    const auto comma = list.find(',');
    words.push_back(list.substr(0, comma));
    if (comma == std::string_view::npos) {
      return words;
    }
    list.remove_prefix(comma + 1);
  }
}

/// The whole name, or its last parts: "uavcan.protocol.param.GetSet", "param.GetSet", "GetSet".
bool means(std::string_view typed, std::string_view name) {
  return name == typed ||
         (!typed.empty() && name.ends_with(typed) && name[name.size() - typed.size() - 1] == '.');
}

std::string_view last_part(std::string_view name) {
  return name.substr(name.rfind('.') + 1);
}

std::unexpected<Error> unknown_type(std::string_view typed) {
  std::vector<std::string_view> known;
  for (const DataType& type : dronecan::standard_types()) {
    known.push_back(type.name);
    known.push_back(last_part(type.name));
  }
  std::ranges::sort(known);
  known.erase(std::ranges::unique(known).begin(), known.end());
  std::string similar;
  for (const std::string_view name : nearest(typed, known)) {
    similar += similar.empty() ? "" : ", ";
    similar += name;
  }
  return fail(Code::usage, say<texts::unknown_type>(printable(typed)),
              similar.empty() ? say<texts::unknown_type_hint>()
                              : say<texts::did_you_mean>(similar));
}

} // namespace

Result<TraceFilter> TraceFilter::make(const TraceOptions& options,
                                      const std::optional<std::string>& nodes) {
  TraceFilter filter;
  Result<void> taken;
  if (options.types) {
    taken = filter.take_types(*options.types);
  }
  if (taken && options.kinds) {
    taken = filter.take_kinds(*options.kinds);
  }
  if (taken && nodes) {
    taken = filter.take_nodes(*nodes);
  }
  return taken ? Result<TraceFilter>(std::move(filter)) : std::unexpected(taken.error());
}

Result<void> TraceFilter::take_types(const std::string& list) {
  for (const std::string_view word : words_of(list)) {
    std::uint16_t id{};
    const char* end = std::to_address(word.end());
    if (const auto [stop, error] = std::from_chars(std::to_address(word.begin()), end, id);
        error == std::errc() && stop == end) {
      types_.push_back({id, std::nullopt});
      continue;
    }
    const auto before = types_.size();
    for (const DataType& type : dronecan::standard_types()) {
      if (means(word, type.name)) {
        types_.push_back({type.id, type.service});
      }
    }
    if (types_.size() == before) {
      return unknown_type(word);
    }
  }
  return {};
}

Result<void> TraceFilter::take_kinds(const std::string& list) {
  constexpr std::array<std::string_view, 3> words{"message", "request", "response"};
  kinds_.fill(false);
  for (const std::string_view word : words_of(list)) {
    const auto it = std::ranges::find(words, word);
    if (it == words.end()) {
      return fail(Code::usage,
                  say<texts::bad_word>("--kind", printable(word), "message, request, response"),
                  say<texts::see_command_help>("trace"));
    }
    kinds_[static_cast<std::size_t>(it - words.begin())] = true;
  }
  return {};
}

Result<void> TraceFilter::take_nodes(const std::string& list) {
  const auto targets = fleet::parse_targets(list);
  if (!targets) {
    return std::unexpected(targets.error());
  }
  if (targets->all || !targets->selectors.empty()) {
    return fail(Code::usage, say<texts::trace_takes_node_ids>(printable(list)),
                say<texts::trace_takes_node_ids_hint>());
  }
  nodes_.emplace();
  for (const dronecan::NodeId id : targets->ids) {
    nodes_->set(id.value());
  }
  return {};
}

bool TraceFilter::passes(const dronecan::Header& header) const {
  const bool service = header.kind != Kind::message;
  const auto is_it = [&](const Type& type) {
    return type.id == header.data_type_id && type.service.value_or(service) == service;
  };
  return kinds_[std::to_underlying(header.kind)] &&
         (types_.empty() || std::ranges::any_of(types_, is_it)) &&
         (!nodes_ || nodes_->test(header.source.value()) ||
          (service && nodes_->test(header.destination.value())));
}

} // namespace blactl::cli
