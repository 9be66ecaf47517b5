// Checks that a file is a complete store of this version, and that it contains nothing that runs by itself.
#pragma once

namespace noonmark {

namespace sqlite {
class Database;
}

// Throws Error(usage) for the store of another version. Throws Error(file) for a database that is not Noonmark's, for
// tables, indexes, views and triggers that store_schema() does not make, and for damage, including a wrong order of
// rows.
void check_store(sqlite::Database& db);
// The same but for damage. Enough for what reads every row and compares it with its seal (compare/store/seals.h), because
// that notices damage too; looking for it costs as much as reading the rows.
void check_tables(sqlite::Database& db);

}  // namespace noonmark
