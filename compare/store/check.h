// Whether a file is a whole store of this version, with nothing in it that works by itself.
#pragma once

namespace noonmark {

namespace sqlite {
class Database;
}

// Throws Error(usage) for the store of another version; Error(scene) for a database of somebody else's, for tables,
// indexes, views and triggers other than those that store_schema() makes, and for damage, down to the order of rows.
void check_store(sqlite::Database& db);

}  // namespace noonmark
