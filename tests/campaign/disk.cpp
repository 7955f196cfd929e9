#include "disk.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <new>
#include <optional>
#include <span>

namespace blactl::campaign {
namespace {

using Bytes = DiskFile::Bytes;

/// What a disk writes whole or not at all.
constexpr std::size_t sector = 512;

/// An open file. SQLite gives the memory, in which the usual one follows.
struct OpenFile {
  sqlite3_file base;
  Disk* disk;
  DiskFile* file;
  const char* path; ///< SQLite keeps it while the file is open
};

OpenFile& own(sqlite3_file* file) {
  return *reinterpret_cast<OpenFile*>(file); // NOLINT: C's way to derive
}

sqlite3_file* usual(sqlite3_file* file) {
  return reinterpret_cast<sqlite3_file*>(&own(file) + 1); // NOLINT
}

Bytes content_of(const char* path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

template <class Call> int if_powered(sqlite3_file* file, int failure, Call call) {
  OpenFile& open = own(file);
  if (open.file != nullptr && !open.disk->has_power()) {
    return failure;
  }
  return call(open);
}

int write(sqlite3_file* file, const void* data, int size, sqlite3_int64 at) {
  return if_powered(file, SQLITE_IOERR_WRITE, [&](OpenFile& open) {
    if (open.file != nullptr) {
      const std::span bytes(static_cast<const std::uint8_t*>(data), static_cast<std::size_t>(size));
      open.file->later.push_back({static_cast<std::size_t>(at), Bytes(bytes.begin(), bytes.end())});
    }
    return usual(file)->pMethods->xWrite(usual(file), data, size, at);
  });
}

int truncate(sqlite3_file* file, sqlite3_int64 size) {
  return if_powered(file, SQLITE_IOERR_TRUNCATE, [&](OpenFile& open) {
    if (open.file != nullptr) {
      open.file->later.push_back({static_cast<std::size_t>(size), {}});
    }
    return usual(file)->pMethods->xTruncate(usual(file), size);
  });
}

int sync(sqlite3_file* file, int flags) {
  return if_powered(file, SQLITE_IOERR_FSYNC, [&](OpenFile& open) {
    if (open.file != nullptr) {
      *open.file = {
          .is_certain = true, .is_removed = false, .synced = content_of(open.path), .later = {}};
    }
    return usual(file)->pMethods->xSync(usual(file), flags);
  });
}

/// The rest is as usual.
constexpr sqlite3_io_methods methods{
    .iVersion = 1,
    .xClose = [](sqlite3_file* file) { return usual(file)->pMethods->xClose(usual(file)); },
    .xRead =
        [](sqlite3_file* file, void* to, int size, sqlite3_int64 at) {
          return usual(file)->pMethods->xRead(usual(file), to, size, at);
        },
    .xWrite = write,
    .xTruncate = truncate,
    .xSync = sync,
    .xFileSize =
        [](sqlite3_file* file, sqlite3_int64* size) {
          return usual(file)->pMethods->xFileSize(usual(file), size);
        },
    .xLock = [](sqlite3_file* file,
                int level) { return usual(file)->pMethods->xLock(usual(file), level); },
    .xUnlock = [](sqlite3_file* file,
                  int level) { return usual(file)->pMethods->xUnlock(usual(file), level); },
    .xCheckReservedLock =
        [](sqlite3_file* file, int* is_reserved) {
          return usual(file)->pMethods->xCheckReservedLock(usual(file), is_reserved);
        },
    .xFileControl =
        [](sqlite3_file* file, int operation, void* argument) {
          return usual(file)->pMethods->xFileControl(usual(file), operation, argument);
        },
    .xSectorSize =
        [](sqlite3_file* file) { return usual(file)->pMethods->xSectorSize(usual(file)); },
    .xDeviceCharacteristics =
        [](sqlite3_file* file) {
          return usual(file)->pMethods->xDeviceCharacteristics(usual(file));
        },
    .xShmMap = nullptr,
    .xShmLock = nullptr,
    .xShmBarrier = nullptr,
    .xShmUnmap = nullptr,
    .xFetch = nullptr,
    .xUnfetch = nullptr,
};

sqlite3_vfs* usual_vfs = nullptr;

Disk& disk_of(sqlite3_vfs* vfs) {
  return *static_cast<Disk*>(vfs->pAppData);
}

int open(sqlite3_vfs* vfs, const char* path, sqlite3_file* file, int flags, int* flags_out) {
  constexpr int kept = SQLITE_OPEN_MAIN_DB | SQLITE_OPEN_MAIN_JOURNAL;
  auto* opened =
      new (file) OpenFile{.base = {}, .disk = &disk_of(vfs), .file = nullptr, .path = path};
  if (path != nullptr && (flags & kept) != 0) {
    const bool was_there = std::filesystem::exists(path);
    const auto [found, is_new] = opened->disk->files().try_emplace(path);
    opened->file = &found->second;
    if (is_new && was_there) {
      *opened->file = {
          .is_certain = true, .is_removed = false, .synced = content_of(path), .later = {}};
    }
    opened->file->is_removed = false;
  }
  const int result = usual_vfs->xOpen(usual_vfs, path, usual(file), flags, flags_out);
  opened->base.pMethods = usual(file)->pMethods != nullptr ? &methods : nullptr;
  return result;
}

int remove(sqlite3_vfs* vfs, const char* path, int is_synced) {
  Disk& disk = disk_of(vfs);
  if (!disk.has_power()) {
    return SQLITE_IOERR_DELETE;
  }
  if (const auto found = disk.files().find(path); found != disk.files().end()) {
    if (is_synced != 0) {
      disk.files().erase(found);
    } else {
      found->second.is_removed = true;
    }
  }
  return usual_vfs->xDelete(usual_vfs, path, is_synced);
}

/// Each sector of what was not synced may be there, or not.
Bytes left_of(const DiskFile& file, Chance& chance) {
  Bytes bytes = file.synced;
  for (const auto& [at, later] : file.later) {
    if (later.empty()) {
      bytes.resize(chance.comes(0.5) ? at : bytes.size());
    }
    for (std::size_t i = 0; i < later.size(); i += sector) {
      const std::span part = std::span(later).subspan(i, std::min(sector, later.size() - i));
      if (chance.comes(0.5)) {
        bytes.resize(std::max(bytes.size(), at + i + part.size()));
        std::ranges::copy(part, bytes.begin() + static_cast<std::ptrdiff_t>(at + i));
      }
    }
  }
  return bytes;
}

} // namespace

Disk::Disk(Disturbance& cut)
    : cut_(cut), usual_(sqlite3_vfs_find(nullptr)), own_(std::make_unique<sqlite3_vfs>(*usual_)) {
  usual_vfs = usual_;
  own_->szOsFile = static_cast<int>(sizeof(OpenFile)) + usual_->szOsFile;
  own_->zName = "disk";
  own_->pAppData = this;
  own_->xOpen = open;
  own_->xDelete = remove;
  sqlite3_vfs_register(own_.get(), 1);
}

Disk::~Disk() {
  sqlite3_vfs_unregister(own_.get());
  sqlite3_vfs_register(usual_, 1);
}

void Disk::come_back(Chance chance) {
  for (const auto& [path, file] : files_) {
    const bool may_be_gone = file.is_removed || !file.is_certain;
    if (may_be_gone && chance.comes(0.5)) {
      std::filesystem::remove(path);
      continue;
    }
    const Bytes bytes = left_of(file, chance);
    std::ofstream(path, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(bytes.data()), // NOLINT: bytes
               static_cast<std::streamsize>(bytes.size()));
  }
}

} // namespace blactl::campaign
