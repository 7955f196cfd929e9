// Profiles of a directory: models that join, models that replace, and every kind of fault.

#include "blactl/bla/identity.hpp"
#include "blactl/bla/profile.hpp"

#include "catch.hpp"
#include "unit/bla/built_in.hpp"

#include <stdlib.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>

using namespace blactl;
using namespace blactl::bla;

namespace {

/// A directory that goes with the test.
class Directory {
 public:
  Directory() {
    std::string name = (std::filesystem::temp_directory_path() / "blactl-test-XXXXXX").string();
    REQUIRE(mkdtemp(name.data()) != nullptr);
    path_ = name;
  }

  Directory(const Directory&) = delete;
  Directory& operator=(const Directory&) = delete;

  ~Directory() { std::filesystem::remove_all(path_); }

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  Directory& with(const std::string& name, const std::string& text) {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return *this;
  }

 private:
  std::filesystem::path path_;
};

std::string built_in_file(const std::string& name) {
  std::ifstream file(BLACTL_PROFILES "/" + name, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  REQUIRE_FALSE(text.empty());
  return text;
}

/// `text` with one place changed; the place must be there.
std::string changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  INFO(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// A series of one model, with table 3-12's registers on known lines.
const std::string series = R"({
  "schema": "blactl-profile/1",
  "family": "BLA",
  "series": "BLA50",
  "model_number": 90,
  "text_en": "BLA50 series",
  "text_ja": "BLA50 シリーズ",
  "parameters": {
    "0x01": {"default": 0, "min": -60, "max": 60},
    "0x2C": {"default": 50, "min": 1, "max": 100},
    "0x2D": {"default": 1, "min": 0, "max": 100},
    "0x2E": {"default": 3, "min": 0, "max": 3600},
    "0x2F": {"default": 0, "min": 0, "max": 100},
    "0x30": {"default": 25, "min": 1, "max": 100},
    "0x31": {"default": 50, "min": 0, "max": 100},
    "0x32": {"default": 600, "min": 0, "max": 2000},
    "0x33": {"default": 300, "min": 1, "max": 500000},
    "0x34": {"default": 0, "min": 0, "max": 0},
    "0x35": {"default": 0, "min": 0, "max": 0},
    "0x36": {"default": 0, "min": 0, "max": 0},
    "0x37": {"default": 0, "min": 0, "max": 0},
    "0x3A": {"default": 60, "min": 0, "max": 60},
    "0x3B": {"default": -60, "min": -60, "max": 0},
    "0x3C": {"default": 90, "min": 0, "max": 90}
  },
  "voltage_classes": {
    "24U": {
      "parameters": {
        "0x2A": {"default": 30, "min": 10, "max": 40},
        "0x40": {"default": 300, "min": 200, "max": 320},
        "0x41": {"default": 40, "min": 35, "max": 200}
      }
    }
  },
  "suffixes": {"A0": {"pwm": false}},
  "models": [{"voltage_class": "24U", "suffix": "A0", "hardware_version": 24010}]
}
)";

/// What is wrong with the files, without the folder's name; a line each.
std::string faults(const Directory& directory) {
  const auto loaded = Profiles::load(directory.path());
  REQUIRE_FALSE(loaded);
  CHECK(loaded.error().code == Code::bad_file);
  CHECK_FALSE(loaded.error().hint.empty());
  std::string message = loaded.error().message;
  const std::string folder = directory.path().string() + '/';
  for (std::size_t at = message.find(folder); at != std::string::npos; at = message.find(folder)) {
    message.erase(at, folder.size());
  }
  return message;
}

std::string series_faults(const std::string& from, const std::string& to) {
  return faults(Directory().with("x.json", changed(series, from, to)));
}

std::string family_faults(const std::string& from, const std::string& to) {
  return faults(Directory().with("x.json", changed(built_in_file("BLA.json"), from, to)));
}

bool has_line(const std::string& message, const std::string& line) {
  return ('\n' + message + '\n').find('\n' + line + '\n') != std::string::npos;
}

} // namespace

TEST_CASE("a new series in a directory joins the built-in ones") {
  const Directory directory;
  std::ofstream(directory.path() / "BLA50.json") << series;
  const auto profiles = Profiles::load(directory.path());
  REQUIRE(profiles);
  CHECK(profiles->all().size() == 11);
  CHECK(profiles->replaced().empty());
  const auto models = profiles->matching("BLA50-24U-A0");
  REQUIRE(models.size() == 1);
  CHECK(models.front()->find(Address(0x2A))->max == 40);
  CHECK(models.front()->find(Address(0x3C))->max == 90); // no register of table 3-12
  CHECK(models.front()->find(Address(0x3D))->min == -100);
  CHECK(profiles->find(Address(0x3C))->max == 100);
  CHECK(profiles->find(Address(0x50))->choice(90)->word == "BLA50");
  const Identity identity(*profiles, {90, 1, 1500, 24010});
  CHECK(identity.certain());
  CHECK(identity.model() == "BLA50-24U-A0");
  CHECK(identity.may_write(Address(0x2A), 40));
  CHECK_FALSE(identity.may_write(Address(0x2A), 41));
}

TEST_CASE("a model in a directory replaces the built-in one of its name, and that is told") {
  Directory directory;
  directory.with("mine.json", changed(built_in_file("BLA21.json"), "\"max\": 70", "\"max\": 65"));
  const auto profiles = Profiles::load(directory.path());
  REQUIRE(profiles);
  CHECK(profiles->all().size() == 10);
  CHECK(profiles->replaced().size() == 6);
  CHECK(profiles->matching("BLA21-12U-AB").front()->find(Address(0x2A))->max == 65);
  CHECK(profiles->matching("BLA34-12U-AB").front()->find(Address(0x2A))->max == 63);
}

TEST_CASE("the installed profiles, schema and all, may be given as the directory") {
  const auto profiles = Profiles::load(BLACTL_PROFILES);
  REQUIRE(profiles);
  CHECK(profiles->all().size() == 10);
  CHECK(profiles->replaced().size() == 10);
}

TEST_CASE("a family in a directory stands for the built-in one") {
  Directory directory;
  directory.with("family.json",
                 changed(built_in_file("BLA.json"), "\"max\": 60000", "\"max\": 30000"));
  const auto profiles = Profiles::load(directory.path());
  REQUIRE(profiles);
  CHECK(profiles->replaced().size() == 10);
  CHECK(profiles->find(Address(0x27))->max == 30000);
}

namespace {

const std::string own_register = R"("parameters": {
    "0x47": {"name": "my_param", "group": "option", "name_en": "Mine", "name_ja": "独自",
             "access": "RW", "width": "uint8", "default": 7, "min": 0, "max": 9, "saved": true},)";

std::string with_own_register(const std::string& text) {
  return changed(text, "\"parameters\": {", own_register);
}

} // namespace

TEST_CASE("a series may have a register that no other has") {
  Directory directory;
  directory.with("x.json", with_own_register(series));
  const auto profiles = Profiles::load(directory.path());
  REQUIRE(profiles);
  const auto found = profiles->find("my_param");
  REQUIRE(found);
  CHECK(*found == profiles->find(Address(0x47)));
  CHECK((*found)->is_setting());
  CHECK((*found)->max == 9);
  CHECK((*found)->example->raw == 7);
  CHECK(std::ranges::is_sorted(profiles->registers(), {}, &Parameter::address));
  for (const Profile& profile : profiles->all()) {
    CHECK((profile.find(Address(0x47)) != nullptr) == (profile.series == "BLA50"));
    CHECK(std::ranges::is_sorted(profile.parameters, {}, &Parameter::address));
  }
  const Identity owner(*profiles, {90, 1, 1500, 24010});
  CHECK(owner.parameter(Address(0x47))->default_raw == 7);
  CHECK(owner.configuration().back()->name == "my_param");
  CHECK(owner.may_write(Address(0x47), 9));
  CHECK(owner.check_takes(**found));
  CHECK_FALSE(owner.may_write(Address(0x47), 10));
}

TEST_CASE("a servo of a series without that register is not asked for it, nor written") {
  Directory directory;
  directory.with("x.json", with_own_register(series));
  const auto profiles = Profiles::load(directory.path());
  REQUIRE(profiles);
  for (const std::int64_t hardware : {12050, 12011, 99999}) { // its suffix and class may be open
    const Identity other(*profiles, {61, 1, 1500, hardware});
    CHECK(other.parameter(Address(0x47)) == nullptr);
    for (const auto& refused :
         {other.may_write(Address(0x47), 7), other.check_takes(*profiles->find(Address(0x47)))}) {
      REQUIRE_FALSE(refused);
      CHECK(refused.error().code == Code::unsupported);
      CHECK(refused.error().message == other.model() + " has no parameter my_param (0x47)");
    }
  }
  // Of a servo of unknown model nobody knows what it has.
  CHECK(Identity(*profiles, {}).parameter(Address(0x47)) != nullptr);
}

TEST_CASE("voltage classes and suffixes give ranges of their series' own register, too") {
  Directory directory;
  const std::string text = changed(with_own_register(series), "\"0x2A\"",
                                   R"("0x47": {"default": 1, "min": 0, "max": 3}, "0x2A")");
  directory.with("x.json", text);
  const auto profiles = Profiles::load(directory.path());
  REQUIRE(profiles);
  CHECK(profiles->matching("BLA50").front()->find(Address(0x47))->max == 3);
}

TEST_CASE("one name means one register, and one address too, whichever series has it") {
  const std::string other =
      changed(changed(changed(series, "BLA50", "BLA60"), "90", "91"), "24010", "24011");
  const auto told = [&](const std::string& from, const std::string& to) {
    Directory directory;
    directory.with("a.json", with_own_register(series))
        .with("b.json", changed(with_own_register(other), from, to));
    return faults(directory);
  };
  const std::string otherwise = "b.json:38: /models/0: my_param (0x47) is not described as "
                                "my_param (0x47) of another series: only default, min and max "
                                "may differ";
  CHECK(has_line(told("\"uint8\"", "\"int16\""), otherwise));
  CHECK(has_line(told("\"saved\": true", "\"saved\": false"), otherwise));
  CHECK(has_line(told("my_param", "other_param"),
                 "b.json:38: /models/0: other_param (0x47) is not described as my_param (0x47) of "
                 "another series: only default, min and max may differ"));
  CHECK(has_line(told("0x47", "0x48"),
                 "b.json:38: /models/0: my_param (0x48) is not described as my_param (0x47) of "
                 "another series: only default, min and max may differ"));
  CHECK(
      has_line(series_faults("\"0x2D\": {", "\"0x2D\": {\"name\": \"mine\", "),
               "x.json:11: /parameters/0x2D/name: this key is not known; known here: default, min, "
               "max"));
  CHECK(has_line(
      faults(Directory().with("x.json", changed(with_own_register(series), "my_param", "origin"))),
      "x.json:9: /parameters/0x47: origin is already the name of 0x44"));
}

TEST_CASE("series that describe a register alike share it, each with its own range") {
  Directory directory;
  const std::string other =
      changed(changed(changed(series, "BLA50", "BLA60"), "90", "91"), "24010", "24011");
  directory.with("a.json", with_own_register(series))
      .with("b.json", changed(with_own_register(other), "\"max\": 9,", "\"max\": 20,"));
  const auto profiles = Profiles::load(directory.path());
  REQUIRE(profiles);
  CHECK(profiles->find(Address(0x47))->max == 20);
}

TEST_CASE("an empty directory changes nothing, one that is not there is an error") {
  CHECK(Profiles::load(Directory().path())->all().size() == 10);
  const auto missing = Profiles::load("/nonexistent/\x1B[m");
  REQUIRE_FALSE(missing);
  CHECK(missing.error().code == Code::bad_file);
  CHECK(missing.error().message == "cannot read the profiles in /nonexistent/\\x1b[m: "
                                   "No such file or directory");
  CHECK(missing.error().hint == "check --profile-dir or BLACTL_PROFILE_DIR");
  Directory directory;
  directory.with("file", "");
  CHECK_FALSE(Profiles::load(directory.path() / "file"));
  std::filesystem::create_directory(directory.path() / "x.json");
  CHECK(faults(directory) == "cannot read x.json: Is a directory");
}

TEST_CASE("faults of all files are told at once, each with file, line, place and reason") {
  Directory directory;
  directory.with("a.json", "{\"series\": \n 5}").with("b.json", "[1,").with("c.json", series);
  const std::string message = faults(directory);
  CHECK(message.find("b.json:1: /: not valid JSON: ") == 0);
  CHECK(has_line(message, "a.json:1: /: \"schema\" is missing"));
  CHECK(has_line(message, "a.json:2: /series: must be a string, not an integer"));
  CHECK(message.find("c.json") == std::string::npos);
}

TEST_CASE("faults of a series file have line, place and reason") {
  const auto fault = [](const std::string& from, const std::string& to, const std::string& line) {
    INFO(from << " -> " << to);
    const std::string message = series_faults(from, to);
    INFO(message);
    CHECK(has_line(message, line));
  };
  fault("blactl-profile/1", "blactl-profile/2",
        "x.json:2: /schema: must be \"blactl-profile/1\", not \"blactl-profile/2\"");
  fault("\"family\": \"BLA\",", "", "x.json:1: /: \"family\" is missing");
  fault("\"BLA50\"", "\"bla-50\"",
        "x.json:4: /series: \"bla-50\" is not a valid part of a model name; use A-Z and digits");
  fault("90,", "256,", "x.json:5: /model_number: 256 is more than 255");
  fault("90,", "-1,", "x.json:5: /model_number: -1 is less than 0");
  fault("90,", "9.5,", "x.json:5: /model_number: must be an integer, not a number");
  fault("\"BLA50 series\"", "\"\"", "x.json:6: /text_en: the text is empty");
  fault("\"0x2D\"", "\"0x28\"", "x.json:11: /parameters/0x28: the family has no register \"0x28\"");
  fault("\"0x2D\"", "\"0x2d\"", "x.json:11: /parameters/0x2d: the family has no register \"0x2d\"");
  fault("\"0x2D\"", "\"0x2C\"",
        "x.json:11: /parameters/0x2C: this key occurs twice; it is also in line 10");
  fault("\"0x2D\"", "\"0x53\"",
        "x.json:11: /parameters/0x53: 0x53 follows from model_number and hardware_version");
  fault("\"default\": 1, ", "",
        "x.json:11: /parameters/0x2D: a register that can be written needs "
        "default, min, max");
  fault("\"default\": 1, \"min\": 0, ", "\"default\": 1, ",
        "x.json:11: /parameters/0x2D: min and max belong together");
  fault("\"default\": 1, \"min\": 0", "\"default\": 1, \"min\": 101",
        "x.json:11: /parameters/0x2D: min 101 is greater than max 100");
  fault("\"default\": 1, \"min\": 0", "\"default\": 1, \"min\": 2",
        "x.json:11: /parameters/0x2D: default 1 lies outside of 2 to 100");
  fault("\"max\": 500000", "\"max\": 99999999999",
        "x.json:17: /parameters/0x33/max: 99999999999 is more than 4294967295");
  fault("\"max\": 500000", "\"max\": 99999999999999999999",
        "x.json:17: /parameters/0x33/max: 99999999999999999999 does not fit in 64 bits");
  fault("\"max\": 500000", "\"max\": \"500000\"",
        "x.json:17: /parameters/0x33/max: must be an integer, not a string");
  fault("\"max\": 500000", "\"maximum\": 500000",
        "x.json:17: /parameters/0x33/maximum: this key is not known; known here: "
        "default, min, max");
  fault("\"24U\": {\n", "\"24/U\": {\n",
        "x.json:27: /voltage_classes/24~1U: \"24/U\" is not a valid part of a model name; "
        "use A-Z and digits");
  fault("\"24U\", \"suffix\"", "\"28U\", \"suffix\"",
        "x.json:36: /models/0/voltage_class: \"28U\" is not among the voltage_classes");
  fault("\"suffix\": \"A0\"", "\"suffix\": \"AB\"",
        "x.json:36: /models/0/suffix: \"AB\" is not among the suffixes");
  fault("\"suffix\": \"A0\", ", "", "x.json:36: /models/0: \"suffix\" is missing");
  fault("{\"pwm\": false}", "{}", "x.json:35: /suffixes/A0: \"pwm\" is missing");
  fault("{\"pwm\": false}", "7", "x.json:35: /suffixes/A0: must be an object, not an integer");
  fault("24010", "-1", "x.json:36: /models/0/hardware_version: -1 is less than 0");
  fault("    \"0x01\": {\"default\": 0, \"min\": -60, \"max\": 60},\n", "",
        "x.json:35: /models/0: BLA50-24U-A0: 0x01 (command_speed) has no default, min and max");
  fault("24010}",
        "24010}, {\"voltage_class\": \"24U\", \"suffix\": \"A0\", "
        "\"hardware_version\": 24011}",
        "x.json:36: /models/1: the model BLA50-24U-A0 is described twice");
}

TEST_CASE("a fault is told once, not again where it shows") {
  CHECK(series_faults("\"max\": 500000", "\"max\": \"x\"") ==
        "x.json:17: /parameters/0x33/max: must be an integer, not a string");
}

TEST_CASE("two models must differ in what they answer, and two files in what they describe") {
  Directory twins;
  twins.with("x.json", changed(changed(series, "90,", "61,"), "24010", "12050"));
  CHECK(faults(twins) ==
        "x.json:36: /models/0: BLA50-24U-A0 has the model number and hardware version of "
        "BLA21-12U-AB");
  Directory doubled;
  doubled.with("a.json", series).with("b.json", series);
  CHECK(
      has_line(faults(doubled), "b.json:36: /models/0: the model BLA50-24U-A0 is described twice"));
  Directory families;
  families.with("a.json", built_in_file("BLA.json")).with("b.json", built_in_file("BLA.json"));
  CHECK(has_line(faults(families), "b.json:1: /: there is already a family, in " +
                                       families.path().string() + "/a.json") == false);
  CHECK(has_line(faults(families), "b.json:1: /: there is already a family, in a.json"));
}

TEST_CASE("faults of a family file have place and reason") {
  const auto fault = [](const std::string& from, const std::string& to, const std::string& end) {
    INFO(from << " -> " << to);
    const std::string message = family_faults(from, to);
    INFO(message);
    CHECK(message.find(end) != std::string::npos);
  };
  fault("\"0x00\"", "\"0x60\"", ": /parameters/0x60: \"0x60\" is not an address");
  fault("\"0x0A\"", "\"0x0a\"", ": /parameters/0x0a: \"0x0a\" is not an address");
  fault("\"command_angle\"", "\"Command Angle\"",
        ": /parameters/0x00/name: \"Command Angle\" is not a valid name");
  fault("\"command_angle\"", "\"command_torque\"",
        ": /parameters/0x02: command_torque is already the name of 0x00");
  fault("\"group\": \"command\"", "\"group\": \"commands\"",
        ": /parameters/0x00/group: \"commands\" is none of: command, status, operation, fault, "
        "config, control, pwm, limit, option, product, production");
  fault("\"access\": \"RW\"", "\"access\": \"rw\"",
        ": /parameters/0x00/access: \"rw\" is none of: R, W, RW");
  fault("\"unit\": \"deg\"", "\"unit\": \"rad\"",
        ": /parameters/0x00/unit: \"rad\" is none of: deg");
  fault("\"scale\": \"0.1\"", "\"scale\": 0.1",
        ": /parameters/0x00/scale: must be a string, not a number");
  fault("\"width\": \"int32\"", "\"width\": \"int64\"",
        ": /parameters/0x00/width: \"int64\" is none of: int8, uint8, int16");
  fault("\"per_model\": true,", "\"per_model\": true, \"default\": 0,",
        ": /parameters/0x01: a per_model register has its values in the series files");
  fault("\"default\": 0, \"min\": -100, \"max\": 100, ", "",
        ": /parameters/0x02: a register that can be written needs default, min, max");
  fault("\"saved\": false", "\"saved\": 0",
        ": /parameters/0x00/saved: must be true or false, not an integer");
  fault("\"raw\": 1, \"word\": \"off\"", "\"raw\": 0, \"word\": \"off\"",
        ": /parameters/0x20/choices/1: 0 occurs twice among the choices");
  fault("\"word\": \"off\"", "\"word\": \"on\"",
        ": /parameters/0x20/choices/1: on occurs twice among the choices");
  fault("\"bit\": 9", "\"bit\": 8", ": /fault_bits/1: 0x19 bit 8 is described twice");
  fault("\"code\": \"angle_limit_ccw\"", "\"code\": \"angle_limit_cw\"",
        ": /fault_bits/1: the code angle_limit_cw is used twice");
  fault("\"bit\": 9", "\"bit\": 32", ": /fault_bits/1/bit: 32 is more than 31");
  fault("\"bit\": 9", "\"bit\": 1", ": /fault_bits/1: bit 1 belongs to the group hardware");
  fault("\"register\": \"0x19\"", "\"register\": \"0x17\"",
        ": /fault_bits/0/register: \"0x17\" is none of: 0x18, 0x19, 0x1A, 0x1B");
  fault("\"register\": \"0x18\", \"bit\": 26", "\"register\": \"0x18\", \"bit\": 27",
        ": 0x18 has no bit 27");
  fault("\"register\": \"0x18\", \"bit\": 26", "\"register\": \"0x18\", \"bit\": 25",
        ": 0x18 bit 25 is described twice");
  fault("\"version\": 1100", "\"version\": 1010", ": /firmware/1: versions must ascend");
  fault("\"2021-01\"", "\"2021-13\"",
        ": /firmware/0/shipments/0/from: \"2021-13\" is not a month like 2024-06");
  fault("\"source\"", "\"sources\"", ": /sources: this key is not known");
}
