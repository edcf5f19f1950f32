// A film of a run's frames, by the ffmpeg program where there is one.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace impinge {

/// What the name of a film may end in: containers of H.264, and the moving pictures that a message shows: GIF, WebP.
const std::vector<std::string>& video_endings();

/// Whether there is an ffmpeg on PATH: known before the first picture is made.
bool has_ffmpeg();

/// Joins the six-digit PNG files of `frames`, in order, gaps allowed, into `output`; the file name's ending chooses the
/// container (.mp4). H.264, or MPEG-4 where ffmpeg has no x264; an odd width or height gains one black column or row.
/// A .gif or .webp begins again at its end and keeps size and duration; a GIF counts hundredths of a second, so above 50
/// frames a second it shows each second, third, … picture only.
/// Transparent pictures stay so in a .webp, and in a .gif where they are transparent by half or more; in all others they
/// are laid over grey (kBehind).
/// `output` appears complete or not at all. False where ffmpeg isn't installed. Throws InputError where there are no
/// frames, the rate is not a positive number, or ffmpeg fails.
bool make_video(const std::filesystem::path& frames, const std::filesystem::path& output, double frames_per_second);

}  // namespace impinge
