// blactl sim: simulated servos, as their own bus or on a real interface.

#include "blactl/can/simbus.hpp"
#include "blactl/sim/bus/served_interface.hpp"
#include "blactl/sim/bus/server.hpp"
#include "blactl/sim/scenario/facts.hpp"

#include "cli/commands.hpp"
#include "cli/context.hpp"
#include "cli/interface/bus_factory.hpp"
#include "cli/interface/scheme.hpp"
#include "cli/sim/events.hpp"
#include "cli/sim/line_input.hpp"
#include "cli/sim/orders.hpp"
#include "cli/sim/texts.hpp"

#include <signal.h>

#include <algorithm>
#include <array>
#include <utility>

namespace blactl::cli {
namespace {

struct SimOptions {
  std::string scenario{};
  std::optional<std::string> facts{}; ///< a facts file; empty: default behaviour
  std::optional<std::uint64_t> seed{};
  std::optional<sim::Clock> clock{}; ///< empty: from the scenario
};

constexpr std::array<std::string_view, 2> clocks{"real", "virtual"}; // in the order of sim::Clock

constexpr Option sim_options[]{
    {.name = "--facts",
     .value = "FILE",
     .kind = Kind::file,
     .help = {"how servos behave, as measured on real ones",
              "サーボの挙動 (実機で測定した facts ファイル)"},
     .store = into<&SimOptions::facts>},
    {.name = "--seed",
     .value = "N",
     .kind = Kind::whole,
     .whole = {0, ~std::uint64_t{0}},
     .help = {"the seed of everything random", "乱数のシード"},
     .store = into<&SimOptions::seed>},
    {.name = "--clock",
     .value = "CLOCK",
     .kind = Kind::word,
     .words = clocks,
     .help = {"the clock (default: as the scenario says)", "時計 (省略時: シナリオに従う)"},
     .store = into<&SimOptions::clock>},
};

constexpr Option sim_arguments[]{
    {.name = "SCENARIO",
     .kind = Kind::file,
     .help = {"scenario file (default: three servos)", "シナリオファイル (省略時: サーボ 3 台)"},
     .store = into<&SimOptions::scenario>},
};

template <class... Cases> struct Overloaded : Cases... {
  using Cases::operator()...;
};

Result<sim::Scenario> read_scenario(const SimOptions& options, const bla::Profiles& profiles) {
  const auto usual = options.facts ? sim::read_facts(*options.facts) : sim::Behaviour{};
  if (!usual) {
    return std::unexpected(usual.error());
  }
  auto scenario = options.scenario.empty() ? sim::default_scenario(profiles, *usual)
                                           : sim::read_scenario(options.scenario, profiles, *usual);
  if (scenario && options.seed) {
    scenario->seed = *options.seed;
  }
  if (scenario && options.clock) {
    scenario->clock = *options.clock;
  }
  return scenario;
}

/// Reports to scripts that clients may connect.
Result<void> say_ready(const Context& context) {
  const bool json = context.reporter().format() == Format::json;
  return context.reporter().data(json ? "{\"event\":\"ready\"}\n" : "ready\n");
}

/// Whether to end: a signal that ends the simulator, a broken interface or stdout.
bool ends(const can::Event& event, const SimEvents& events, Report& report) {
  if (events.error()) {
    report.fail(*events.error());
    return true;
  }
  if (const auto* signal = std::get_if<can::Signal>(&event); signal && signal->number != SIGWINCH) {
    report.signal = signal->number;
    return true;
  }
  if (const auto* gone = std::get_if<can::Gone>(&event)) {
    report.fail(gone->error);
    return true;
  }
  return false;
}

/// Reports an order that cannot be carried out; the simulation goes on.
void refuse(const Error& error, const Context& context) {
  context.reporter().error(error);
}

void no_such_serial(std::int64_t serial_number, const Context& context) {
  refuse({Code::usage, say<texts::sim_no_such_serial>(serial_number), "", std::nullopt}, context);
}

void dump(const std::vector<sim::Servo*>& servos, const sim::Medium::Counters* wire, Time now,
          SimEvents& events) {
  for (sim::Servo* servo : servos) {
    servo->look(now);
    events.print(*servo, now);
  }
  events.print_end(servos.size(), wire, now);
}

template <class Perform>
void obey(LineInput& input, const can::Event& event, const Context& context, Perform perform) {
  input.handle(event);
  while (const auto line = input.next()) {
    if (line->empty()) {
      continue;
    }
    if (const auto order = parse_sim_order(*line)) {
      std::visit(perform, *order);
    } else {
      refuse(order.error(), context);
    }
  }
}

/// Warns once if the bus lags behind: times seen by clients are wrong then, through no fault of the
/// servos.
void tell_if_behind(const sim::Server& server, bool& told, const Context& context) {
  constexpr Duration worth_telling = std::chrono::seconds(1);
  if (!told && server.behind() >= worth_telling) {
    told = true;
    context.reporter().note(say<texts::sim_behind>(
        std::chrono::duration_cast<std::chrono::seconds>(server.behind()).count()));
  }
}

/// Serves the simulated bus on a socket until a signal comes.
void serve(const std::string& socket, const sim::Scenario& scenario, const Context& context,
           Report& report) {
  can::Loop loop(nullptr);
  SimEvents events(context.reporter(), loop, scenario.clock);
  const auto server = sim::Server::open(
      socket, scenario, [&events](const sim::ServoEvent& event) { events.print(event); });
  if (!server) {
    return report.fail(server.error());
  }
  report.interface = "sim:" + printable(socket);
  loop.watch((*server)->descriptor());
  LineInput input(loop);
  context.reporter().note(say<texts::sim_serves>(printable(socket), scenario.servos.size()));
  if (auto said = say_ready(context); !said) {
    return report.fail(said.error());
  }
  sim::Simulator& simulator = (*server)->simulator();
  const auto impossible = [&](std::string_view what) {
    refuse({Code::usage, say<texts::sim_needs_virtual_clock>(what), "", std::nullopt}, context);
  };
  const Overloaded perform{
      [&](const ChangeWorld& order) {
        if (!simulator.change(order.serial_number, order.changes)) {
          no_such_serial(order.serial_number, context);
        }
      },
      [&](const LinkClients& order) { simulator.link_clients(order.link); },
      [&](const HoldClock& order) {
        if (scenario.clock == sim::Clock::real) {
          impossible("hold");
        } else {
          (*server)->hold(order.clients);
        }
      },
      [&](const DumpState&) {
        dump(simulator.servos(), &simulator.medium().counters(), simulator.now(), events);
      },
  };
  for (bool told_behind = false;;) {
    const can::Event event = loop.next((*server)->next_deadline(loop.now()));
    if (ends(event, events, report)) {
      break;
    }
    (*server)->service();
    tell_if_behind(**server, told_behind, context);
    obey(input, event, context, perform);
  }
  events.tell_losses(report);
}

bool is_for_clients(const sim::TimedEvent& event) {
  return event.serial_number == 0;
}

/// Runs the servos on a real interface until a signal comes or the interface goes away.
void join(const std::string& name, const sim::Scenario& scenario, const bla::Profiles& profiles,
          const Context& context, Report& report) {
  if (std::ranges::any_of(scenario.events, is_for_clients) || scenario.wire != sim::WireFaults{}) {
    return report.fail({Code::usage, say<texts::wire_is_real>(printable(name)),
                        say<texts::wire_is_real_hint>(), std::nullopt});
  }
  auto bus = open_bus({.text = name, .profiles = profiles, .reporter = context.reporter()});
  if (!bus) {
    return report.fail(bus.error());
  }
  can::Loop loop(std::move(bus->bus));
  SimEvents events(context.reporter(), loop, sim::Clock::real);
  sim::ServedInterface interface(loop, scenario,
                                 [&events](const sim::ServoEvent& event) { events.print(event); });
  LineInput input(loop);
  report.interface = loop.bus().name();
  context.reporter().note(say<texts::sim_serves>(name, scenario.servos.size()));
  if (auto said = say_ready(context); !said) {
    return report.fail(said.error());
  }
  const auto impossible = [&](std::string_view what) {
    refuse({Code::usage, say<texts::sim_order_impossible>(what), "", std::nullopt}, context);
  };
  const Overloaded perform{
      [&](const ChangeWorld& order) {
        if (!interface.devices().change(order.serial_number, order.changes, loop.now())) {
          no_such_serial(order.serial_number, context);
        }
      },
      [&](const LinkClients&) { impossible("clients"); },
      [&](const HoldClock&) { impossible("hold"); },
      [&](const DumpState&) { dump(interface.devices().servos, nullptr, loop.now(), events); },
  };
  for (;;) {
    const can::Event event = loop.next(interface.next_deadline());
    if (ends(event, events, report)) {
      break;
    }
    interface.handle(event);
    obey(input, event, context, perform);
  }
  events.tell_losses(report);
}

Report execute(const SimOptions& options, Context& context) {
  Report report;
  report.is_stream = true;
  const auto profiles = context.profiles();
  if (!profiles) {
    report.fail(profiles.error());
    return report;
  }
  const auto scenario = read_scenario(options, **profiles);
  if (!scenario) {
    report.fail(scenario.error());
    return report;
  }
  for (const std::string& warning : scenario->warnings) {
    context.reporter().note(printable(warning));
  }
  const std::string& text = context.shared().interface;
  const auto name = parse_interface(text.empty() ? "sim:" : text);
  if (!name) {
    report.fail(name.error());
  } else if (const auto refused = takes_no_frames(text)) {
    report.fail(*refused);
  } else if (name->is(Behind::link) || name->is(Behind::bus)) {
    join(text, *scenario, **profiles, context, report);
  } else if (name->is(Behind::simulator)) {
    serve(name->rest.empty() ? can::default_socket_path().string() : name->rest, *scenario, context,
          report);
  } else {
    report.fail({Code::usage, say<texts::scenario_is_argument>(printable(text)),
                 say<texts::scenario_is_argument_hint>(printable(name->rest)), std::nullopt});
  }
  return report;
}

} // namespace

constinit const Command commands::sim{
    .name = "sim",
    .traits = {.streams = true},
    .help = {"simulated servos: serves the sim: bus, or joins a real interface with -i",
             "模擬サーボ: sim: バスを提供、または -i で実際のバスに参加"},
    .options = sim_options,
    .arguments = sim_arguments,
    .action = action<SimOptions, execute>,
};

} // namespace blactl::cli
