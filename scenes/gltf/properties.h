// The properties of a glTF file that are read, as a table (glTF 2.0, section 5). parse_json (json.h) keeps no other
// properties; the guard (guard.h) checks that each has the type and the range that the table says.
#pragma once
#include <cstdint>
#include <span>
#include <string_view>

namespace noonmark::gltf {

// references: an object with indices by name, of which the ones of is_read_reference() are kept. reference_lists: an
// array of such objects. unchecked: of any type; the guard reads it itself and takes it out of the document.
enum class Kind {
  integer,
  integers,
  number,
  numbers,
  flag,
  text,
  texts,
  object,
  objects,
  references,
  reference_lists,
  unchecked
};

inline constexpr uint64_t max_index = 0x7fffffff;  // tinygltf keeps these in an int
inline constexpr uint64_t any_count = 0;

struct Field {
  std::string_view name;
  Kind kind;
  bool is_required = false;
  uint64_t limit = max_index;       // integer(s): the largest; numbers: how many, any_count: any number
  std::span<const Field> fields{};  // object(s): the properties that are read
};

// Of a whole file. posed: the contents of its animations are read too.
std::span<const Field> root_properties(bool posed);
// The first of them: the version of glTF, which decides what the others mean.
std::span<const Field> asset_properties();
std::span<const Field> animation_properties();
// The lists of the root that a mask needs: images, samplers, textures.
std::span<const Field> masking_properties();

// Attributes of primitives, morph targets and instances.
bool is_read_reference(std::string_view name);

}  // namespace noonmark::gltf
