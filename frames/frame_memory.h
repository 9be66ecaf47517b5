// Whether a frame fits into memory, before the images that judge it are made.
//
//   require_frame_memory("shots/visibility.exr", width, height);
#pragma once
#include <string>

#include "base/memory.h"

namespace noonmark {

// What judging a frame of this size takes beside its scene, in bytes, an upper bound: receivers, truth, classes, the values
// that the checks sort, and the files that are written. Without the frame's own shadow map.
double frame_bytes(int width, int height);

// Throws Error(file) if it does not fit. name: of the frame, for the message.
void require_frame_memory(const std::string& name, int width, int height,
                          const AvailableMemory& available = available_memory());

}  // namespace noonmark
