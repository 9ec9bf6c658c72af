/// The files of shaders/, embedded at build.
#pragma once

#include <string_view>

namespace rejoin::zbuffer::gl {

/// Text of one file, "depth_draw.vert"; empty if there is no such file.
std::string_view shader_source(std::string_view file);

}  // namespace rejoin::zbuffer::gl
