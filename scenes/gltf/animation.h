// One animation of the file at one time: it moves, turns and scales nodes, weighs morph targets and hides.
#pragma once
#include <string>
#include <vector>

#include "scenes/gltf/accessor.h"

namespace noonmark::gltf {

// Sets the nodes of document.model as document.guarded.animation has them at time_s: before the first key as the first,
// after the last as the last (glTF 2.0, section 3.11). What it animates that is neither a node's nor a morph target's
// goes into notes. Throws Error(scene) where keys are not in order or not finite, or samplers do not fit what they
// move.
void pose(Document& document, Readers& readers, double time_s, std::vector<std::string>& notes);

}  // namespace noonmark::gltf
