#include "scene.hpp"

#include "catch.hpp"

#include <algorithm>
#include <cstdint>
#include <fstream>
#include <iterator>

namespace blactl::test {

Scene& Scene::servo(std::string_view model, int node_id, const nlohmann::json& more) {
  nlohmann::json servo = {{"model", model}, {"node_id", node_id}};
  servo.update(more.is_null() ? nlohmann::json::object() : more);
  document_["servos"].push_back(std::move(servo));
  return *this;
}

Scene& Scene::seed(int number) {
  document_["seed"] = number;
  return *this;
}

Scene& Scene::wire(const nlohmann::json& faults) {
  document_["wire"] = faults;
  return *this;
}

Scene& Scene::foreign(int node_id, const nlohmann::json& more) {
  nlohmann::json node = {{"kind", "node"}, {"node_id", node_id}};
  node.update(more.is_null() ? nlohmann::json::object() : more);
  document_["foreign"].push_back(std::move(node));
  return *this;
}

Scene& Scene::joins(int serial_number, std::string_view at) {
  document_["events"].push_back({{"servo", serial_number}, {"happens", "power_off"}});
  return event(serial_number, "power_on", at);
}

Scene& Scene::event(int serial_number, std::string_view happens, std::string_view at) {
  document_["events"].push_back({{"at", at}, {"servo", serial_number}, {"happens", happens}});
  return *this;
}

Scene& Scene::clients(std::string_view what, std::string_view at) {
  document_["events"].push_back({{"at", at}, {"clients", what}});
  return *this;
}

Scene& Scene::world(int serial_number, const nlohmann::json& changes, std::string_view at) {
  document_["events"].push_back({{"at", at}, {"servo", serial_number}, {"world", changes}});
  return *this;
}

std::string Scene::write(const Bench& bench) const {
  return bench.file("scene.json", document_.dump(2));
}

Result Scene::run(const Arguments& arguments, const Options& options) const {
  return run(Bench(), arguments, options);
}

Result Scene::run(const Bench& bench, const Arguments& arguments, const Options& options) const {
  const std::string file = write(bench);
  Options with_bus = options; // by the environment: hints repeat what is typed
  with_bus.env.try_emplace("BLACTL_INTERFACE", "sim:" + file);
  Result result = bench.run(arguments, with_bus);
  INFO(result.err);
  CHECK_FALSE(contains(result.err, "[bad_file] " + file));
  return result;
}

Scene three_servos() {
  return Scene()
      .servo("BLA21-12U-AB", 11, {{"servo_id", 1}})
      .servo("BLA15-06U-A0", 12, {{"servo_id", 2}})
      .servo("BLA34-28U-AB", 13, {{"servo_id", 3}});
}

std::string content(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

std::vector<std::string> codes(const Result& result) {
  constexpr std::string_view start = "blactl: [";
  std::vector<std::string> found;
  for (std::size_t at = result.err.find(start); at != std::string::npos;
       at = result.err.find(start, at + 1)) {
    const std::size_t from = at + start.size();
    found.push_back(result.err.substr(from, result.err.find(']', from) - from));
  }
  return found;
}

void check_error(const Result& result, int status, const std::string& code,
                 std::string_view message) {
  INFO(result.err);
  CHECK(result.status == status);
  CHECK(codes(result) == std::vector{code});
  CHECK(contains(result.err, message));
}

std::vector<std::string> keys(const nlohmann::ordered_json& object) {
  std::vector<std::string> names;
  for (const auto& member : object.items()) {
    names.push_back(member.key());
  }
  return names;
}

nlohmann::ordered_json ordered_json(std::string_view text) {
  return nlohmann::ordered_json::parse(text);
}

std::string without_colour(std::string text) {
  for (auto at = text.find('\x1b'); at != std::string::npos; at = text.find('\x1b')) {
    text.erase(at, text.find('m', at) - at + 1);
  }
  return text;
}

std::size_t longest_line(std::string_view text) {
  std::size_t longest = 0;
  std::size_t cells = 0;
  for (const char c : text) {
    const auto byte = static_cast<std::uint8_t>(c);
    // Of a character of three bytes or more, which is Japanese here, the first counts two cells.
    cells = c == '\n' ? 0 : cells + (byte >= 0xE0 ? 2U : (byte & 0xC0U) == 0x80 ? 0U : 1U);
    longest = std::max(longest, cells);
  }
  return longest;
}

bool is_fit_for_a_terminal(std::string_view text) {
  try {
    // A strict writer of JSON is a strict reader of UTF-8.
    (void)nlohmann::json(std::string(text)).dump();
  } catch (const nlohmann::json::type_error&) {
    return false;
  }
  return std::ranges::all_of(text, [](char c) {
    const auto byte = static_cast<std::uint8_t>(c);
    return c == '\n' || (byte >= 0x20 && byte != 0x7F);
  });
}

} // namespace blactl::test
