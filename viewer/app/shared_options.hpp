// Options that several commands have, each with the one way in which it is said and read.
#pragma once

#include "viewer/app/sub_command.hpp"
#include "viewer/controller/run.hpp"

namespace impinge {

/// --set, any number of times.
void set_option(Options& options, std::vector<std::string>& overrides,
                const std::string& doc = "PATH=VALUE: a parameter or a body's key, instead of the scene's");
/// SCENE and --set.
void scene_options(Options& options, std::filesystem::path& scene, std::vector<std::string>& overrides);
/// --script.
void script_option(Options& options, std::filesystem::path& script,
                   const std::string& doc = "script file: commands by frame, and expectations");
/// --frames: the last frame's number.
void frames_option(
    Options& options, std::optional<int>& last,
    const std::string& doc = "the last frame's number (default: 240, or the script's last if that is later)");
/// --size: of pictures or a window, pixels.
void size_option(Options& options, int& width, int& height,
                 const std::string& doc = "WIDTHxHEIGHT of the pictures (default: 1280x720)");
/// --no-images.
void images_option(Options& options, bool& images);
/// --tolerance of pictures: of a channel, of 255.
void tolerance_option(Options& options, int& tolerance, const std::string& doc);
/// --memory-limit, which counts for the whole program and the jobs it starts.
void memory_option(Options& options);
/// --judge.
void judge_option(Options& options, RunOptions& run);
/// --threads, which counts for the whole program as soon as it is read.
void threads_option(Options& options);
/// --quiet.
void quiet_option(Options& options, bool& quiet, const std::string& doc = "say nothing but errors");

/// What a run, or what takes a run's place, is written into unless --out says so: out/SCENE with that ending.
std::filesystem::path default_out(const std::filesystem::path& scene, const std::string& ending = "");

}  // namespace impinge
