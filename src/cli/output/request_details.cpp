#include "cli/output/request_details.hpp"

#include "blactl/dronecan/types.hpp"

#include "cli/texts.hpp"

#include <chrono>
#include <string>
#include <string_view>

namespace blactl::cli {
namespace {

using dronecan::ExecuteOpcode;
using dronecan::GetSet;
using dronecan::Request;

bool is(const Request& request, const dronecan::DataType& type) {
  return request.type->id == type.id;
}

/// "GetSet 0x38", "ExecuteOpcode SAVE", "GetNodeInfo".
std::string what(const Request& request) {
  const std::string_view full = request.type->name;
  std::string text(full.substr(full.rfind('.') + 1));
  if (is(request, GetSet::type)) {
    const auto get_set = GetSet::Request::decode(request.payload.bytes());
    text += get_set ? " " + printable(get_set->name) : "";
  } else if (is(request, ExecuteOpcode::type)) {
    const auto opcode = ExecuteOpcode::Request::decode(request.payload.bytes());
    text += !opcode                                  ? ""
            : opcode->opcode == ExecuteOpcode::save  ? " SAVE"
            : opcode->opcode == ExecuteOpcode::erase ? " ERASE"
                                                     : " ?";
  }
  return text;
}

} // namespace

void RequestDetails::asked(const Request& request) {
  if (!is(request, ExecuteOpcode::type) && !is(request, dronecan::RestartNode::type)) {
    return;
  }
  const auto bytes = request.payload.bytes();
  if (++once_[{request.server.value(), request.type->id, {bytes.begin(), bytes.end()}}] > 1) {
    reporter_.detail(say<texts::sent_once_more>(request.server.value(), what(request)));
  }
}

void RequestDetails::unanswered(const Request& request, int tries) const {
  const double seconds = std::chrono::duration<double>(request.timeout).count();
  const auto node = request.server.value();
  reporter_.detail(
      tries <= request.retries
          ? say<texts::asked_again>(node, what(request), seconds, tries + 1, request.retries + 1)
          : say<texts::never_answered>(node, what(request), seconds, tries));
}

} // namespace blactl::cli
