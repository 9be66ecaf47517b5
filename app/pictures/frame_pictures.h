// The files of a judged frame: PNGs for people, and frame.exr for programs.
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "app/pictures/image_file.h"
#include "compare/ladder/ladder.h"
#include "compare/results/records.h"
#include "frames/judge.h"

namespace noonmark {

// Each picture of a judged frame.
inline constexpr std::string_view frame_picture_names[] = {"truth", "frame", "classes", "causes", "difference"};

// Writes <folder>/<stem>-<name>.png. The paths in the records begin with `relative`, not `folder`. ladder: of a frame with its
// own map; null: there is no picture "causes".
std::vector<PictureRecord> write_frame_pictures(const FrameVerdict& verdict, const GivenFrame& frame,
                                                const Ladder* ladder, const std::string& folder,
                                                const std::string& relative, const std::string& stem);

// Of each of these pixels its surroundings, enlarged (crop_px): the truth, the frame, and why it differs.
std::vector<Image<Color>> frame_pixel_pictures(const FrameVerdict& verdict, const GivenFrame& frame,
                                               const Ladder* ladder, std::span<const PointRecord::WorstOf> pixels);

// Writes the file with 32-bit channels: V (the frame; NaN: no surface), R1, R0, error, class (the index of FrameClass), flags
// (1 facing, 2 counted, 4 ambiguous), primitive (-1: no surface), P.X P.Y P.Z, N.X N.Y N.Z. With a ladder also R2, R3, R4, R5 and
// step.<cause>, the signed step of each cause.
ImageRecord write_frame_exr(const FrameVerdict& verdict, const GivenFrame& frame, const Ladder* ladder,
                            const std::string& path, const std::string& relative_path);

}  // namespace noonmark
