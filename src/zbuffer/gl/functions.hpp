/// The OpenGL functions that the backends call, filled through the context's own loader (no libGL is linked).
#pragma once

#include <GL/glcorearb.h>

#include <functional>
#include <string>

namespace rejoin::zbuffer::gl {

// X(member and name without "gl", type as in glcorearb.h)
#define REJOIN_GL_FUNCTIONS(X)                                 \
  X(AttachShader, PFNGLATTACHSHADERPROC)                       \
  X(BindBuffer, PFNGLBINDBUFFERPROC)                           \
  X(BindBufferBase, PFNGLBINDBUFFERBASEPROC)                   \
  X(BindFramebuffer, PFNGLBINDFRAMEBUFFERPROC)                 \
  X(BindTexture, PFNGLBINDTEXTUREPROC)                         \
  X(BindVertexArray, PFNGLBINDVERTEXARRAYPROC)                 \
  X(BlendEquation, PFNGLBLENDEQUATIONPROC)                     \
  X(BufferData, PFNGLBUFFERDATAPROC)                           \
  X(BufferSubData, PFNGLBUFFERSUBDATAPROC)                     \
  X(CheckFramebufferStatus, PFNGLCHECKFRAMEBUFFERSTATUSPROC)   \
  X(ClearBufferfv, PFNGLCLEARBUFFERFVPROC)                     \
  X(CompileShader, PFNGLCOMPILESHADERPROC)                     \
  X(CreateProgram, PFNGLCREATEPROGRAMPROC)                     \
  X(CreateShader, PFNGLCREATESHADERPROC)                       \
  X(DebugMessageCallback, PFNGLDEBUGMESSAGECALLBACKPROC)       \
  X(DeleteBuffers, PFNGLDELETEBUFFERSPROC)                     \
  X(DeleteFramebuffers, PFNGLDELETEFRAMEBUFFERSPROC)           \
  X(DeleteProgram, PFNGLDELETEPROGRAMPROC)                     \
  X(DeleteShader, PFNGLDELETESHADERPROC)                       \
  X(DeleteTextures, PFNGLDELETETEXTURESPROC)                   \
  X(DeleteVertexArrays, PFNGLDELETEVERTEXARRAYSPROC)           \
  X(Disable, PFNGLDISABLEPROC)                                 \
  X(DispatchCompute, PFNGLDISPATCHCOMPUTEPROC)                 \
  X(DrawElements, PFNGLDRAWELEMENTSPROC)                       \
  X(Enable, PFNGLENABLEPROC)                                   \
  X(EnableVertexAttribArray, PFNGLENABLEVERTEXATTRIBARRAYPROC) \
  X(FramebufferTextureLayer, PFNGLFRAMEBUFFERTEXTURELAYERPROC) \
  X(FrontFace, PFNGLFRONTFACEPROC)                             \
  X(GenBuffers, PFNGLGENBUFFERSPROC)                           \
  X(GenFramebuffers, PFNGLGENFRAMEBUFFERSPROC)                 \
  X(GenTextures, PFNGLGENTEXTURESPROC)                         \
  X(GenVertexArrays, PFNGLGENVERTEXARRAYSPROC)                 \
  X(GetBufferSubData, PFNGLGETBUFFERSUBDATAPROC)               \
  X(GetError, PFNGLGETERRORPROC)                               \
  X(GetInteger64v, PFNGLGETINTEGER64VPROC)                     \
  X(GetIntegeri_v, PFNGLGETINTEGERI_VPROC)                     \
  X(GetIntegerv, PFNGLGETINTEGERVPROC)                         \
  X(GetProgramInfoLog, PFNGLGETPROGRAMINFOLOGPROC)             \
  X(GetProgramiv, PFNGLGETPROGRAMIVPROC)                       \
  X(GetShaderInfoLog, PFNGLGETSHADERINFOLOGPROC)               \
  X(GetShaderiv, PFNGLGETSHADERIVPROC)                         \
  X(GetString, PFNGLGETSTRINGPROC)                             \
  X(GetUniformLocation, PFNGLGETUNIFORMLOCATIONPROC)           \
  X(LinkProgram, PFNGLLINKPROGRAMPROC)                         \
  X(MemoryBarrier, PFNGLMEMORYBARRIERPROC)                     \
  X(PixelStorei, PFNGLPIXELSTOREIPROC)                         \
  X(ReadPixels, PFNGLREADPIXELSPROC)                           \
  X(ShaderSource, PFNGLSHADERSOURCEPROC)                       \
  X(TexParameteri, PFNGLTEXPARAMETERIPROC)                     \
  X(TexStorage3D, PFNGLTEXSTORAGE3DPROC)                       \
  X(Uniform1f, PFNGLUNIFORM1FPROC)                             \
  X(Uniform1ui, PFNGLUNIFORM1UIPROC)                           \
  X(Uniform3ui, PFNGLUNIFORM3UIPROC)                           \
  X(Uniform4fv, PFNGLUNIFORM4FVPROC)                           \
  X(UseProgram, PFNGLUSEPROGRAMPROC)                           \
  X(VertexAttribPointer, PFNGLVERTEXATTRIBPOINTERPROC)         \
  X(Viewport, PFNGLVIEWPORTPROC)

struct Functions {
#define REJOIN_GL_MEMBER(name, type) type name = nullptr;
  REJOIN_GL_FUNCTIONS(REJOIN_GL_MEMBER)
#undef REJOIN_GL_MEMBER
};

using AnyFunction = void (*)();
using FunctionLoader = std::function<AnyFunction(const char* name)>;

/// Fills the table.  \pre a context is current
/// \throws BackendError  names the first function that the driver lacks
Functions load_functions(const std::string& subject, const FunctionLoader& loader);

/// \throws BackendError if GL has recorded an error since the last call; `doing` says what was going on
void check_errors(const Functions& gl, const std::string& subject, const char* doing);

}  // namespace rejoin::zbuffer::gl
