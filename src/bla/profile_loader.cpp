// Profiles::load(): finds the files and merges those of a directory with the built-in ones.

#include "blactl/base/json_reader.hpp"
#include "blactl/base/system_error.hpp"
#include "blactl/bla/profile.hpp"
#include "blactl/bla/value.hpp"

#include "bla/embedded_profiles.hpp"
#include "bla/profile_reader.hpp"
#include "bla/texts.hpp"

#include <algorithm>
#include <system_error>

namespace blactl::bla {
namespace {

struct File {
  json::Document document;
  bool built_in = false;
};

/// All errors of all files as one.
class Errors {
 public:
  void add(const Error& error) {
    message_ += (message_.empty() ? "" : "\n") + error.message;
    hint_ = error.hint;
  }

  void add(const Result<void>& result) {
    if (!result) {
      add(result.error());
    }
  }

  [[nodiscard]] Result<void> result() const {
    return message_.empty() ? Result<void>{} : fail(Code::bad_file, message_, hint_);
  }

 private:
  std::string message_;
  std::string hint_;
};

std::vector<File> read_built_in(Errors& errors) {
  std::vector<File> files;
  for (const EmbeddedProfile& profile : embedded_profiles()) {
    auto document = json::parse(profile.text, std::string(profile.file));
    if (document) {
      files.push_back({std::move(*document), true});
    } else {
      errors.add(document.error());
    }
  }
  return files;
}

/// The profile files of a directory, in the order of their names.
Result<std::vector<std::filesystem::path>> list(const std::filesystem::path& directory) {
  std::error_code error;
  std::filesystem::directory_iterator entries(directory, error);
  std::vector<std::filesystem::path> paths;
  while (!error && entries != std::filesystem::directory_iterator()) {
    const std::filesystem::path& path = entries->path();
    // The schema may lie beside the profiles, as it does where they are installed.
    if (path.extension() == ".json" && path.stem().extension() != ".schema") {
      paths.push_back(path);
    }
    entries.increment(error);
  }
  if (error) {
    return fail(
        Code::bad_file,
        say<texts::profile_directory>(printable(directory.string()), system_reason(error.value())),
        say<texts::profile_directory_hint>());
  }
  std::ranges::sort(paths);
  return paths;
}

void read_directory(const std::filesystem::path& directory, std::vector<File>& files,
                    Errors& errors) {
  const auto paths = list(directory);
  if (!paths) {
    errors.add(paths.error());
    return;
  }
  for (const std::filesystem::path& path : *paths) {
    auto document = json::parse_file(path);
    if (document) {
      files.push_back({std::move(*document), false});
    } else {
      errors.add(document.error());
    }
  }
}

/// The file of the family: the directory's, else the built-in one. Null: there is none.
File* choose_family(std::vector<File>& files) {
  File* chosen = nullptr;
  for (File& file : files) {
    if (describes_series(file.document)) {
      continue;
    }
    if (chosen != nullptr && chosen->built_in == file.built_in) {
      file.document.faults().add(file.document.root(), say<texts::profile_second_family>(
                                                           chosen->document.faults().file()));
    } else {
      chosen = &file;
    }
  }
  return chosen;
}

/// The register as assumed for an unknown model.
Parameter of_unknown(Parameter parameter) {
  parameter.default_raw = parameter.min = parameter.max = std::nullopt;
  return parameter;
}

/// What does not depend on the model.
Parameter description(const Parameter& parameter) {
  Parameter all = of_unknown(parameter);
  all.per_model = all.by_voltage_class = all.by_suffix = false;
  return all;
}

/// Adds the models of one file to `models`; those of the directory replace built-in ones.
class Merger {
 public:
  void add(Series series, File& file) {
    numbers_.push_back(std::move(series.number));
    for (Series::Model& model : series.models) {
      add(std::move(model), file);
    }
  }

  /// Refuses models that answer alike, since they cannot be distinguished.
  void check_twins() {
    for (std::size_t i = 0; i < models_.size(); ++i) {
      for (std::size_t j = 0; j < i; ++j) {
        const Profile& a = models_[i].profile;
        const Profile& b = models_[j].profile;
        if (a.model_number == b.model_number && a.hardware_version == b.hardware_version) {
          models_[i].file->document.faults().add(
              *models_[i].place, say<texts::profile_like_another>(a.model, b.model));
        }
      }
    }
  }

  /// The registers that the family lacks, each as one model has it. Refuses those that another
  /// describes otherwise: one name means one register, and so does an address.
  [[nodiscard]] std::vector<Parameter> own_registers(const Family& family) {
    std::vector<Parameter> all;
    for (const Entry& entry : models_) {
      for (const Parameter& one : entry.profile.parameters) {
        if (std::ranges::binary_search(family.parameters, one.address, {}, &Parameter::address)) {
          continue;
        }
        const auto same = std::ranges::find_if(all, [&](const Parameter& other) {
          return other.address == one.address || other.name == one.name;
        });
        if (same == all.end()) {
          all.push_back(one);
        } else if (description(*same) != description(one)) {
          entry.file->document.faults().add(
              *entry.place, say<texts::profile_described_otherwise>(
                                one.name, one.address.name(), same->name, same->address.name()));
        }
      }
    }
    return all;
  }

  /// The models, each with the words for all model numbers.
  [[nodiscard]] std::vector<Profile> profiles() const {
    std::vector<Profile> profiles;
    for (const Entry& entry : models_) {
      profiles.push_back(entry.profile);
      for (Parameter& parameter : profiles.back().parameters) {
        if (parameter.address == address::model_number) {
          parameter.choices = choices();
        }
      }
    }
    std::ranges::sort(profiles, {}, &Profile::model);
    return profiles;
  }

  [[nodiscard]] const std::vector<std::string>& replaced() const { return replaced_; }

 private:
  struct Entry {
    Profile profile;
    const json::Value* place;
    File* file;
  };

  void add(Series::Model model, File& file) {
    const auto same = std::ranges::find_if(
        models_, [&](const Entry& entry) { return entry.profile.model == model.profile.model; });
    if (same == models_.end()) {
      models_.push_back({std::move(model.profile), model.place, &file});
    } else if (same->file->built_in && !file.built_in) {
      replaced_.push_back(model.profile.model);
      *same = {std::move(model.profile), model.place, &file};
    } else if (same->file != &file) { // else the file's reader has reported it
      file.document.faults().add(*model.place,
                                 say<texts::profile_model_twice>(model.profile.model));
    }
  }

  [[nodiscard]] std::vector<Choice> choices() const {
    std::vector<Choice> choices;
    for (const Choice& number : numbers_) {
      if (std::ranges::find(choices, number.raw, &Choice::raw) == choices.end()) {
        choices.push_back(number);
      }
    }
    std::ranges::sort(choices, {}, &Choice::raw);
    return choices;
  }

  std::vector<Choice> numbers_;
  std::vector<Entry> models_;
  std::vector<std::string> replaced_;
};

/// Widens `all` to hold what `one` allows.
void widen(Parameter& all, const Parameter& one) {
  if (one.min && one.max) {
    all.min = std::min(all.min.value_or(*one.min), *one.min);
    all.max = std::max(all.max.value_or(*one.max), *one.max);
  }
  all.by_voltage_class = all.by_voltage_class || one.by_voltage_class;
  all.by_suffix = all.by_suffix || one.by_suffix;
}

/// An example value: one that no model refuses, if possible.
std::optional<Parameter::Example> find_example(Address address, std::span<const Profile> profiles) {
  std::vector<Parameter::Example> defaults;
  for (const Profile& profile : profiles) {
    const Parameter* one = profile.find(address);
    if (one != nullptr && one->default_raw && profile.takes(*one)) {
      defaults.push_back({*one->default_raw, profile.model});
    }
  }
  for (const Parameter::Example& example : defaults) {
    const bool fits_all = std::ranges::all_of(profiles, [&](const Profile& profile) {
      const Parameter* one = profile.find(address);
      return one == nullptr || !profile.takes(*one) || check_range(*one, example.raw);
    });
    if (fits_all) {
      return Parameter::Example{example.raw, {}};
    }
  }
  return defaults.empty() ? std::nullopt : std::optional(defaults.front());
}

/// The register as all models together have it.
Parameter unite(const Parameter& general, std::span<const Profile> profiles) {
  Parameter all = general;
  bool first = true;
  for (const bool writable : {true, false}) {
    for (const Profile& profile : profiles) {
      const Parameter* one = profile.find(general.address);
      if (one == nullptr || profile.takes(*one) != writable) {
        continue;
      }
      if (first) {
        all = *one;
      }
      if (all.default_raw != one->default_raw) {
        all.default_raw.reset();
      }
      first = false;
      widen(all, *one);
    }
    if (!first) {
      break; // read-only ranges count only if no model can write it
    }
  }
  all.example = find_example(general.address, profiles);
  return all;
}

} // namespace

Result<Profiles> Profiles::load(const std::optional<std::filesystem::path>& directory) {
  Errors errors;
  std::vector<File> files = read_built_in(errors);
  if (directory) {
    read_directory(*directory, files, errors);
  }
  File* const family_file = choose_family(files);
  if (family_file == nullptr) {
    errors.add(Error{Code::bad_file, say<texts::profile_no_family>()});
    return std::unexpected(errors.result().error());
  }
  Family family = read_family(family_file->document);
  Merger merger;
  for (File& file : files) {
    if (describes_series(file.document)) {
      merger.add(read_series(file.document, family), file);
    }
  }
  merger.check_twins();
  for (Parameter& own : merger.own_registers(family)) {
    family.parameters.push_back(std::move(own));
  }
  std::ranges::sort(family.parameters, {}, &Parameter::address);
  for (File& file : files) {
    errors.add(file.document.faults().result());
  }
  if (auto result = errors.result(); !result) {
    return std::unexpected(std::move(result.error()));
  }
  Profiles profiles;
  profiles.profiles_ = merger.profiles();
  for (const Parameter& parameter : family.parameters) {
    profiles.registers_.push_back(unite(parameter, profiles.profiles_));
    profiles.registers_of_unknown_.push_back(of_unknown(profiles.registers_.back()));
  }
  profiles.summary_bits_ = std::move(family.summary_bits);
  profiles.fault_bits_ = std::move(family.fault_bits);
  profiles.firmware_ = std::move(family.firmware);
  profiles.replaced_ = merger.replaced();
  if (!family_file->built_in) {
    // It describes every model anew.
    profiles.replaced_.clear();
    for (const Profile& profile : profiles.profiles_) {
      profiles.replaced_.push_back(profile.model);
    }
  }
  return profiles;
}

} // namespace blactl::bla
