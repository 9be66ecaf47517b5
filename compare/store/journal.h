// The journal with which a store is written. SQLite offers two that lose nothing that was committed:
// - The write-ahead log: a point costs one sync (of the log). It needs memory that all programs share which have the
//   store open (results.sqlite-shm), so all of them must run on one machine, and the folder must be on a file system of
//   that machine.
// - The rollback journal: a point costs five syncs (the folder twice, the journal twice, the store). It needs no shared
//   memory, so it works on network file systems, too.
#pragma once
#include <cstdint>

namespace noonmark {

namespace sqlite {
class Database;
}

// file_system: statfs's f_type. True for file systems that are known to be on disks or in memory of this machine. Any
// other one may be a network's.
bool holds_a_log(uint64_t file_system);

// Selects the log if the store's folder can hold one, otherwise the rollback journal.
void begin_writing(sqlite::Database& db);

// Moves the log into the store, so that it is one file again, which can be read where nothing can be written. If another
// program has the store open, the last one to end does it.
void end_writing(sqlite::Database& db) noexcept;

}  // namespace noonmark
