// A simulated servo on the bench is left as it was, whenever somebody interrupts.

#include "characterization_rig.hpp"

using namespace blactl;
using namespace blactl::fleet;
using namespace blactl::fleet::test;

TEST_CASE("whatever a servo is like and holds, a Ctrl-C at any moment leaves it so") {
  constexpr std::size_t most_frames = 900; // beyond the end of most
  RandomServos chance(20261124);
  int interrupted = 0;
  const int servos = this_many(60, 2000);
  for (int i = 0; i < servos; ++i) {
    const RandomServo servo = chance.next();
    const auto at = static_cast<int>(chance.number(most_frames));
    INFO(servo.members << servo.scene << " at " << at);
    const Rig rig(servo.members, servo.scene);
    const Memory before = rig.memory();
    const Snapshot looked = rig.look();
    rig.bus->at = rig.bus->sent + at;
    const auto measured = characterize(*rig.session, profiles(), looked, {});
    INFO((measured.not_put_back ? measured.not_put_back->message : ""));
    CHECK_FALSE(measured.not_put_back);
    check_same(rig, before);
    interrupted += measured.error ? 1 : 0;
  }
  CHECK(interrupted > servos / 3);
}

TEST_CASE("what was only in RAM is given back, and ROM keeps its own") {
  const Rig rig(R"("rom": {"soft_start": "off"}, "ram": {"angle_limit_cw": "90deg",
      "torque_output": "brake", "speed_torque_control": "on", "timeout_time": "1500ms"})");
  const Memory before = rig.memory();
  CHECK(before.ram.at(bla::address::angle_limit_cw) == 900);
  check_done(rig.measure());
  CHECK(text(rig.memory()) == text(before));
}

TEST_CASE("a servo that was commanded an angle is commanded it again") {
  const Rig rig;
  rig.set("command_angle=45deg");
  const Memory before = rig.memory();
  CHECK(before.ram.at(bla::address::command_angle) == 450);
  check_done(rig.measure());
  CHECK(text(rig.memory()) == text(before));
}

TEST_CASE("a servo that is commanded to turn is not measured") {
  const Rig rig(R"("rom": {"speed_torque_control": "on"})");
  rig.set("command_speed=20rpm");
  const auto refused = refuse_to_characterize(*rig.session, rig.look(), false);
  REQUIRE(refused);
  CHECK(refused->code == Code::cross_check);
}

TEST_CASE("a Ctrl-C at any moment leaves the servo as it was") {
  const std::string members = GENERATE(
      std::string(), std::string(R"("behaviour": {"soft_start_shows": true, "out_of_range": "clamp",
          "keeps_disabled_command": false, "start_angle": "zero"}, "ram": {"angle_limit_cw": "90deg",
          "current_angle": "100deg"}, "servo_id": 7)"),
      std::string(R"("node_id": 0, "behaviour": {"first_node_status": "1s",
          "answers_save_first": false, "rom_write_time": "300ms"}, "ram": {"reverse": "on"})"));
  const bool is_dynamic = members.find("\"node_id\"") != std::string::npos;
  const std::uint8_t id = is_dynamic ? dynamic_id : 11;
  const auto frames = [&] {
    const Rig rig(members);
    (void)rig.look(id);
    const int begun = rig.bus->sent;
    check_done(rig.measure(id));
    return rig.bus->sent - begun;
  }();
  CHECK(frames > 200);
  // By frames of ours: no other moment is another to the servo.
  const int step = this_many(5, 1);
  for (int at = 1; at <= frames; at += step) {
    const Rig rig(members);
    const Memory before = rig.memory();
    const Snapshot looked = rig.look(id);
    rig.bus->at = rig.bus->sent + at;
    const auto measured = characterize(*rig.session, profiles(), looked, {.may_allocate = true});
    INFO(members << ": at frame " << at << " of " << frames);
    INFO((measured.not_put_back ? measured.not_put_back->message : ""));
    CHECK_FALSE(measured.not_put_back);
    CHECK(text(rig.memory()) == text(before));
    if (rig.session->signal() != 0 && measured.error) { // in the end it changes nothing any more
      CHECK(measured.error->code == Code::interrupted);
      CHECK(rig.session->now() - rig.bus->signalled <= put_back_time);
    }
  }
}

TEST_CASE("a second Ctrl-C ends at once, and says what is left") {
  const Rig rig;
  const Snapshot looked = rig.look();
  rig.bus->at = rig.bus->sent + 150;
  rig.bus->again = rig.bus->at + 1;
  const auto measured = characterize(*rig.session, profiles(), looked, {});
  REQUIRE(measured.error);
  CHECK(measured.error->code == Code::interrupted);
  REQUIRE(measured.not_put_back);
  CHECK(measured.not_put_back->message.find("not put back") != std::string::npos);
  CHECK(rig.session->now() - rig.bus->signalled <= 10ms);
}

TEST_CASE("what is left is recorded for undo, and nothing where all was put back") {
  for (const bool is_left : {true, false}) {
    const state::test::Folder folder;
    const auto open = [&] { return state::SnapshotStore::open(folder.path, state::Access::write); };
    History history("characterize", open().value(), state::ProofStore::unshared().value());
    const Rig rig;
    const Snapshot looked = rig.look();
    rig.bus->at = is_left ? rig.bus->sent + 150 : -1;
    rig.bus->again = is_left ? rig.bus->at + 1 : -1;
    const auto measured = characterize(*rig.session, profiles(), looked, {.history = &history});
    CHECK(measured.not_put_back.has_value() == is_left);
    const auto entries = open()->entries().value();
    REQUIRE(entries.size() == (is_left ? 1 : 0));
    for (const auto& entry : entries) {
      CHECK(entry.held.at(0x38) == looked.raw(bla::address::angle_limit_cw));
      CHECK_FALSE(entry.saved);
    }
  }
}

TEST_CASE("what is left after a restart counts as changed in RAM") {
  int left = 0;
  for (int after = 150; after < 1'500; after += 100) {
    History history("characterize", state::SnapshotStore::unshared().value(),
                    state::ProofStore::unshared().value());
    const Rig rig;
    const Snapshot looked = rig.look();
    rig.bus->at = rig.bus->sent + after;
    rig.bus->again = rig.bus->at + 1;
    const auto measured = characterize(*rig.session, profiles(), looked, {.history = &history});
    if (measured.not_put_back) {
      ++left;
      INFO("ended at frame " << after);
      CHECK_FALSE(history.recorded_rom(looked, *rig.session).values.empty());
    }
  }
  CHECK(left > 3);
}

TEST_CASE("a servo that holds what a killed characterize has set is not measured") {
  const state::test::Folder folder;
  const auto history = [&] {
    return History("characterize",
                   state::SnapshotStore::open(folder.path, state::Access::write).value(),
                   state::ProofStore::unshared().value());
  };
  const Rig rig;
  const Snapshot looked = rig.look();
  const Plan all{.before = looked, .may_change_all = true};
  REQUIRE(history().keep(std::span(&all, 1), *rig.session));
  History record = history();
  const int sent = rig.bus->sent;
  const auto measured = characterize(*rig.session, profiles(), looked, {.history = &record});
  REQUIRE(measured.error);
  CHECK(measured.error->code == Code::state);
  CHECK(measured.error->hint == "put it back first: blactl undo -n 11");
  CHECK(rig.bus->sent - sent < 10); // others are asked for their IDs
}

TEST_CASE("whenever it restarts by itself it gets back what it held, or that is told") {
  int done = 0, failed = 0;
  for (int number = 60; number <= 400; number += 9) {
    INFO("after answer " << number);
    const Rig rig(fmt::format(R"("behaviour": {{"first_node_status": "1s"}}, "ram":
        {{"angle_limit_cw": "90deg"}}, "faults": {{"restart_after_answer": [{{"number": {}}}]}})",
                              number));
    const Memory before = rig.memory();
    const Snapshot looked = rig.look();
    const auto measured = characterize(*rig.session, profiles(), looked, {});
    CHECK(rig.memory().rom == before.rom);
    CHECK(words(fact(measured, "answers_save_first").value) != "false"); // it does
    if (measured.is_done()) {
      ++done;
      CHECK(text(rig.memory()) == text(before));
    } else {
      ++failed;
      if (!measured.not_put_back) {
        CHECK(rig.memory().ram == before.ram);
      }
    }
  }
  CHECK(done > 0);
  CHECK(failed > 0);
}

TEST_CASE("a servo that restarts by itself before SAVE is not said to have saved without a word") {
  int told = 0;
  for (int number = 1; number <= 40; ++number) {
    INFO("after GetNodeInfo " << number);
    const Rig rig(fmt::format(
        R"("faults": {{"restart_after_answer": [{{"to": "node_info", "number": {}}}]}})", number));
    const Snapshot looked = rig.look();
    const auto measured = characterize(*rig.session, profiles(), looked, {});
    const Fact& found = fact(measured, "answers_save_first");
    CHECK(words(found.value) != "false"); // it answers first
    CHECK_FALSE(measured.not_put_back);
    told += measured.error || found.reason.find("restarted") != std::string::npos ? 1 : 0;
  }
  CHECK(told > 0);
}

TEST_CASE("a setting that is not given back keeps no other from it, and only it is named") {
  const Rig rig(R"("ram": {"angle_limit_cw": "90deg", "angle_limit_ccw": "-80deg",
      "torque_output": "on", "timeout_time": "1500ms"})");
  const Memory before = rig.memory();
  const Snapshot looked = rig.look();
  rig.bus->deafness = {.name = "0x38", .first = 2};
  const auto measured = characterize(*rig.session, profiles(), looked, {});
  REQUIRE(measured.error);
  REQUIRE(measured.not_put_back);
  INFO(measured.not_put_back->message << " / " << measured.not_put_back->hint);
  CHECK(measured.not_put_back->message.find("not put back: angle_limit_cw (") != std::string::npos);
  CHECK(measured.not_put_back->hint == "to put it back: blactl set -n 11 angle_limit_cw=900raw");
  Memory after = rig.memory();
  after.ram[bla::address::angle_limit_cw] = 900;
  CHECK(text(without_idle_commands(after)) == text(without_idle_commands(before)));
}

TEST_CASE("what ROM gives back when it restarts is put back, although a write was not taken") {
  const Rig rig(R"("rom": {"angle_limit_cw": "90deg"})");
  const Memory before = rig.memory();
  const Snapshot looked = rig.look();
  rig.bus->deafness = {.name = "0x38", .first = 2};
  const auto measured = characterize(*rig.session, profiles(), looked, {});
  CHECK(measured.error);
  INFO((measured.not_put_back ? measured.not_put_back->message : ""));
  CHECK_FALSE(measured.not_put_back);
  check_same(rig, before);
}

TEST_CASE("what to type to put it back names no command to move") {
  for (int at = 60; at <= 420; at += 12) {
    const Rig rig;
    const Snapshot looked = rig.look();
    rig.bus->at = rig.bus->sent + at;
    rig.bus->again = rig.bus->at + 1;
    const auto measured = characterize(*rig.session, profiles(), looked, {});
    const std::string hint = measured.not_put_back ? measured.not_put_back->hint : "";
    INFO("at " << at << ": " << hint);
    CHECK(hint.find("command_") == std::string::npos);
    CHECK(hint.find("555") == std::string::npos);
  }
}

TEST_CASE("the output stays off where it would turn the shaft, and a restart is what to type") {
  int kept_off = 0;
  for (int at = 60; at <= 240; at += 2) {
    const Rig rig(R"("ram": {"speed_torque_control": "on"})");
    const Snapshot looked = rig.look();
    rig.bus->deafness = {.name = "0x01", .first = 3}; // it keeps the speed that it was commanded
    rig.bus->at = rig.bus->sent + at;
    const auto measured = characterize(*rig.session, profiles(), looked, {});
    const auto ram = rig.memory().ram;
    const std::int64_t speed = ram.at(bla::address::command_speed);
    const bool turns = speed != 0 && speed != bla::not_active &&
                       ram.at(bla::address::speed_torque_control) == 1 &&
                       ram.at(bla::address::torque_output) == 0;
    INFO("at " << at);
    CHECK_FALSE(turns);
    if (measured.not_put_back && speed == 10) {
      ++kept_off;
      CHECK(measured.not_put_back->message.find("it would turn: command_speed") !=
            std::string::npos);
      CHECK(measured.not_put_back->hint ==
            "to put it back: blactl restart -n 11 (what was in its RAM only is lost)");
    }
  }
  CHECK(kept_off > 0);
}
