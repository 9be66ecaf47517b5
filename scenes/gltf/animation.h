// One animation of the file at one time. It moves, rotates, scales and hides nodes and sets the weights of morph
// targets.
#pragma once
#include <string>
#include <vector>

#include "scenes/gltf/accessor.h"

namespace noonmark::gltf {

// Sets the nodes of document.model to their values in document.guarded.animation at time_s. Before the first key they
// have the first key's values, after the last key the last key's (glTF 2.0, section 3.11). Animated properties of
// objects other than nodes and morph targets go into notes. Throws Error(file) if keys are not in order or not finite,
// or if a sampler does not fit its property.
void pose(Document& document, Readers& readers, double time_s, std::vector<std::string>& notes);

}  // namespace noonmark::gltf
