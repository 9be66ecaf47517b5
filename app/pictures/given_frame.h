// Reads the pictures that a frame.json names (frames/frame_file.h), or one picture of visibility alone.
//
//   const FrameFile file = read_frame_file("shots/frame.json");
//   const Scene scene = scene_of(file);
//   const GivenFrame frame = given_frame(file, scene);
#pragma once
#include <string>

#include "frames/frame.h"
#include "frames/frame_file.h"
#include "frames/judge.h"
#include "technique/settings.h"

namespace noonmark {

// Throws Error(file).
FrameFile read_frame_file(const std::string& path);

// Where an error belongs to an edge or a contact, as the file says.
JudgeRules rules_of(const FrameFile& file);

// A path that stands in the file, as seen from the working directory. Built-in names of scenes stay.
std::string path_in(const FrameFile& file, const std::string& named);

// The scene that the file shows: a built-in name, or a path as seen from the working directory; and that scene, made. Throw
// Error(file).
std::string scene_name_of(const FrameFile& file);
Scene scene_of(const FrameFile& file);

// The frame, with the camera and the light of the scene where the file gives none. Throws Error(file).
GivenFrame given_frame(const FrameFile& file, const Scene& scene);

// A picture of visibility of what the settings show. Throws Error(file); Error(usage) if the settings give no camera.
GivenFrame given_frame(const std::string& picture, ValueEncoding encoding, const Scene& scene,
                       const Settings& settings);

}  // namespace noonmark
