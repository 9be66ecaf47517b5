// Mutations of a JSON document as a tree. Edits of bytes are mostly refused by the parser; these pass it.
#pragma once
#include <nlohmann/json.hpp>

#include "tests/fuzz/target.h"

namespace noonmark::fuzz {

// Makes one to four mutations: another value (odd numbers, near numbers, other types, copies from elsewhere in the
// document), a member under another name of `words`, members and elements removed, doubled, swapped or added, text
// edited by `edit`.
void mutate_json(nlohmann::json& document, Random& random, std::span<const std::string> words, const EditBytes& edit);

}  // namespace noonmark::fuzz
