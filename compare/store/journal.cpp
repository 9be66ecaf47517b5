#include "compare/store/journal.h"

#include <linux/magic.h>
#include <sqlite3.h>
#include <sys/vfs.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <system_error>

#include "compare/store/sqlite.h"

namespace noonmark {
namespace {

// <linux/magic.h> does not name all of these.
constexpr uint64_t jfs = 0x3153464a, zfs = 0x2fc12fc1, bcachefs = 0xca451a4e;
constexpr uint64_t local_file_systems[] = {EXT4_SUPER_MAGIC,
                                           XFS_SUPER_MAGIC,
                                           BTRFS_SUPER_MAGIC,
                                           F2FS_SUPER_MAGIC,
                                           OVERLAYFS_SUPER_MAGIC,
                                           TMPFS_MAGIC,
                                           RAMFS_MAGIC,
                                           REISERFS_SUPER_MAGIC,
                                           jfs,
                                           zfs,
                                           bcachefs};

// SQLite keeps its files beside the file that a link leads to.
bool folder_holds_a_log(const std::string& path) {
  std::error_code none;
  const std::filesystem::path file = std::filesystem::canonical(path, none);
  struct statfs status {};
  return !file.empty() && ::statfs(file.parent_path().c_str(), &status) == 0 &&
         holds_a_log(static_cast<uint32_t>(status.f_type));
}

}  // namespace

bool holds_a_log(uint64_t file_system) {
  return std::find(std::begin(local_file_systems), std::end(local_file_systems), file_system) !=
         std::end(local_file_systems);
}

void begin_writing(sqlite::Database& db) {
  // SQLite stays with the rollback journal if it cannot make a log. Another tool may have selected any other one.
  if (!folder_holds_a_log(db.path()) || db.ask("PRAGMA journal_mode = WAL") != "wal")
    db.execute("PRAGMA journal_mode = DELETE");
}

void end_writing(sqlite::Database& db) noexcept {
  // Does not wait for a reader: the store is whole with its log, too.
  sqlite3_busy_timeout(db.handle(), 0);
  sqlite3_exec(db.handle(), "PRAGMA journal_mode = DELETE", nullptr, nullptr, nullptr);
}

}  // namespace noonmark
