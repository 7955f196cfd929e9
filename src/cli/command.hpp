#pragma once
// The declaration of a command, from which the parser, --help, the completions and the manual
// follow.
//
//     struct WaitOptions { Duration wait = std::chrono::seconds(10); };
//
//     constexpr Option wait_options[]{{.name = "--wait", .value = "SEC", .kind = Kind::seconds, …,
//                                 .store = into<&WaitOptions::wait>}};
//
//     constinit const Command commands::wait{.name = "wait", …, .options = wait_options,
//                                            .action = action<WaitOptions, execute>};

#include "blactl/base/text.hpp"
#include "blactl/base/time.hpp"

#include "cli/output/report.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace blactl::cli {

class Context;

/// The kinds of values of options and arguments. The kinds after `word` are all text; they differ
/// in their completions.
enum class Kind : std::uint8_t {
  flag,    ///< no value
  seconds, ///< with up to six decimals
  whole,   ///< a whole number
  word,    ///< one of Option::words
  text,
  parameter, ///< a name or an address
  assignment,
  group,
  model,
  model_or_parameter,
  nodes,
  interface,
  file,
  folder,
  words,     ///< of Option::words, comma-separated
  beginning, ///< starts with one of Option::words
  suggested, ///< Option::words are some of what it may be
  data_types,
  entry, ///< the name of one in the fleet file among the arguments
};

/// The name of a kind in --dump-cli: "parameter".
[[nodiscard]] std::string_view name(Kind kind);

/// The meaning of a repeated option.
enum class Repeat : std::uint8_t { last, list };

/// A parsed value, in the member of its kind.
struct Value {
  std::string text{};              ///< of a list: its items, comma-separated
  std::vector<std::string> list{}; ///< every given value
  std::uint64_t number = 0; ///< of a word its index in Option::words, of a flag the number of times
  Duration duration{};
};

/// The part of a Value that a member of an options struct takes.
enum class Takes : std::uint8_t { flag, text, list, number, duration };

/// The destination of a value.
struct Store {
  void (*put)(void* options, const Value& value);
  Takes takes;
};

template <class Number> struct Range {
  Number min, max;
};

/// An option, or a positional argument.
struct Option {
  std::string_view name;    ///< "--node"; for an argument "PARAM"
  char letter = 0;          ///< 'n' for -n; 0: none
  std::string_view value{}; ///< "LIST"; empty for flags and arguments
  Kind kind = Kind::text;
  Repeat repeat = Repeat::last;
  bool required = false;
  bool hidden = false;                       ///< not in help texts; still accepted
  std::span<const std::string_view> words{}; ///< for Kind::word, words, beginning, suggested
  Range<Duration> seconds{};                 ///< for Kind::seconds
  Range<std::uint64_t> whole{};              ///< for Kind::whole
  Text help;
  Store store;
};

struct Traits {
  bool writes = false;       ///< changes servos; without -n there must be exactly one
  bool from_file = false;    ///< its file names the servos
  bool for_newcomer = false; ///< without -n it concerns the servo that no entry of its file means
  bool from_history = false; ///< without -n it concerns the servos changed by the last command
  bool streams = false;      ///< prints one object per line while it runs
  bool tables = false;       ///< takes --csv
  bool session = false;      ///< uses an interface, so that --record has something to write
  bool recordings = false;   ///< also works with -i replay:FILE and -i file:FLEET.json
  bool needs_frames = false; ///< of these two only the first, which holds frames
  bool offline = false;      ///< needs no bus: options of one are ignored
};

/// The action of a command on its options, whose type is known in its own file only.
struct Action {
  std::shared_ptr<void> (*make)(); ///< options with defaults
  Report (*run)(const void* options, Context& context);
};

struct Command {
  std::string_view name;
  Traits traits{};
  Text help; ///< one line
  std::span<const Option> options{};
  std::span<const Option> arguments{};
  Action action;
};

namespace detail {

template <class Member> struct MemberOf;

template <class Owner, class Type> struct MemberOf<Type Owner::*> {
  using Struct = Owner;
  using Value = Type;
};

/// The member at the end of a path into nested structs.
template <class First, class... Further> struct Last : Last<Further...> {};

template <class Only> struct Last<Only> : MemberOf<Only> {};

template <class To> struct Inner {
  using Type = To;
};

template <class To> struct Inner<std::optional<To>> {
  using Type = To;
};

template <class To> constexpr Takes takes() {
  using Plain = typename Inner<To>::Type;
  if constexpr (std::is_same_v<Plain, bool>) {
    return Takes::flag;
  } else if constexpr (std::is_same_v<Plain, std::string>) {
    return Takes::text;
  } else if constexpr (std::is_same_v<Plain, std::vector<std::string>>) {
    return Takes::list;
  } else if constexpr (std::is_same_v<Plain, Duration>) {
    return Takes::duration;
  } else {
    static_assert(std::is_integral_v<Plain> || std::is_enum_v<Plain>);
    return Takes::number;
  }
}

template <class To> void assign(To& to, const Value& value) {
  using Plain = typename Inner<To>::Type;
  constexpr Takes what = takes<To>();
  if constexpr (what == Takes::flag) {
    to = value.number > 0;
  } else if constexpr (what == Takes::text) {
    to = value.text;
  } else if constexpr (what == Takes::list) {
    to = value.list;
  } else if constexpr (what == Takes::duration) {
    to = value.duration;
  } else {
    to = static_cast<Plain>(value.number); // Option::whole and Option::words keep it in range
  }
}

} // namespace detail

/// Stores a value in a member of an options struct, or in a nested one: into<&Set::times,
/// &Times::wait>. Enumerations are in the order of Option::words.
template <auto first, auto... further>
inline constexpr Store into{
    [](void* options, const Value& value) {
      auto& owner = *static_cast<typename detail::MemberOf<decltype(first)>::Struct*>(options);
      detail::assign(((owner.*first).*....*further), value);
    },
    detail::takes<typename detail::Last<decltype(first), decltype(further)...>::Value>()};

/// The action for a function; each command passes its own `execute`.
template <class Options, Report (*function)(const Options&, Context&)>
inline constexpr Action action{
    []() -> std::shared_ptr<void> { return std::make_shared<Options>(); },
    [](const void* options, Context& context) {
      return function(*static_cast<const Options*>(options), context);
    }};

} // namespace blactl::cli
