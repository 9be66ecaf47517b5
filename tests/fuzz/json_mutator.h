// Damage to a JSON document as a tree: what byte edits break at the first bracket, these carry behind the parser.
#pragma once
#include <nlohmann/json.hpp>

#include "tests/fuzz/target.h"

namespace noonmark::fuzz {

// One to four of: another value (odd numbers, near numbers, other types, copied from elsewhere in the document), a
// member under another name of `words`, members and elements left out, doubled, swapped or added, text edited by
// `edit`.
void mutate_json(nlohmann::json& document, Random& random, std::span<const std::string> words, const EditBytes& edit);

}  // namespace noonmark::fuzz
