/// Which of the two ways of OpenGL is the faster one here: measured once, then remembered.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "zbuffer/gl/gl_scorer.hpp"

namespace rejoin::zbuffer::gl {

/// What a measurement holds for.
struct ChoiceKey {
  std::string renderer;  ///< GL_RENDERER
  std::string version;   ///< GL_VERSION, which names the driver's
  int resolution = 0;    ///< pixels
};

ChoiceKey choice_key(const Engine& engine, int resolution);

/// rejoin/opengl-ways in the folder that XDG_CACHE_HOME names, else in ~/.cache; empty if there is neither.
std::filesystem::path choices_file();

/// Path::Compute or Path::Pipeline as the file says; nullopt if it says nothing about the key, cannot be read or is damaged.
std::optional<Path> remembered_path(const std::filesystem::path& file, const ChoiceKey& key);

/// Adds to the file, which appears whole or not at all; what else it holds is kept, what makes no sense is dropped.  Where it
/// cannot be written nothing happens: the next process measures again.
void remember_path(const std::filesystem::path& file, const ChoiceKey& key, Path path);

/// What the file says, or the faster of Path::Compute and Path::Pipeline by a measurement of some tenths of a second (two
/// surfaces of 10,000 faces), which the file then holds.
/// \throws BackendError  neither can draw
Path faster_path(const std::shared_ptr<Engine>& engine, Backend backend, int resolution,
                 const std::filesystem::path& file);

/// How a scorer should draw whose user did not say: faster_path() with choices_file(), found out once a process.  Software
/// always computes, without a measurement: that covers exactly the pixels that the rasteriser covers, everywhere.
/// \return Path::Auto or Path::Pipeline
Path preferred_path(const std::shared_ptr<Engine>& engine, Backend backend, int resolution);

}  // namespace rejoin::zbuffer::gl
