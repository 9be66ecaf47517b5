// The files of a judged frame: PNGs for people, and frame.exr for programs.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "app/pictures/image_file.h"
#include "compare/results/records.h"
#include "frames/judge.h"

namespace noonmark {

// Each picture of a judged frame.
inline constexpr std::string_view frame_picture_names[] = {"truth", "frame", "classes", "difference"};

// Writes <folder>/<stem>-<name>.png. The paths in the records begin with `relative`, not `folder`.
std::vector<PictureRecord> write_frame_pictures(const FrameVerdict& verdict, const GivenFrame& frame,
                                                const std::string& folder, const std::string& relative,
                                                const std::string& stem);

// Writes the file with 32-bit channels: V (the frame; NaN: no surface), R1, R0, error, class (the index of FrameClass), flags
// (1 facing, 2 counted, 4 ambiguous), primitive (-1: no surface), P.X P.Y P.Z, N.X N.Y N.Z.
ImageRecord write_frame_exr(const FrameVerdict& verdict, const GivenFrame& frame, const std::string& path,
                            const std::string& relative_path);

}  // namespace noonmark
