// Damage to a JSON document as a tree: what byte edits break at the first bracket, these carry behind the parser.
#pragma once
#include <nlohmann/json.hpp>

#include "tests/fuzz/target.h"

namespace noonmark::fuzz {

// A few of: another value (odd numbers, near numbers, other types, copied from elsewhere in the document), a key
// renamed to another key of the document, members and elements left out, doubled, moved or swapped, two subtrees
// exchanged, text edited. `words`: keys and texts that the format knows.
void mutate_json(nlohmann::json& document, Random& random, std::span<const std::string> words, const EditBytes& edit);

}  // namespace noonmark::fuzz
