/// Contexts, and what is said when there is none.
#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "core/error.hpp"
#include "zbuffer/gl/context.hpp"
#include "zbuffer/gl/gl_backend.hpp"
#include "zbuffer/gl/objects.hpp"

namespace rejoin::zbuffer::gl {
namespace {

class GlContext : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    const BackendInfo info = probe(GetParam());
    ASSERT_TRUE(info.available) << name_of(GetParam()) << ": " << info.why_not << "; run scripts/setup";
  }
};

TEST_P(GlContext, SaysWhatDraws) {
  const BackendInfo info = probe(GetParam());
  EXPECT_EQ(info.backend, GetParam());
  EXPECT_FALSE(info.renderer.empty());
  EXPECT_TRUE(info.why_not.empty());
  EXPECT_EQ(make_context(GetParam())->renderer(), info.renderer);
}

TEST_P(GlContext, BelongsToOneThreadAfterTheOther) {
  const auto context = make_context(GetParam());
  const auto major = [&] {
    const Bound bound(*context);
    GLint version = 0;
    context->gl().GetIntegerv(GL_MAJOR_VERSION, &version);
    context->check("asking for the version");
    return version;
  };
  EXPECT_GE(major(), 4);
  int elsewhere = 0;
  std::thread([&] { elsewhere = major(); }).join();
  EXPECT_EQ(elsewhere, major());
}

TEST_P(GlContext, SecondContextDoesNotDisturbTheFirst) {
  const auto first = make_context(GetParam());
  GLuint buffer = 0;
  {
    const Bound bound(*first);
    first->gl().GenBuffers(1, &buffer);
    first->gl().BindBuffer(GL_ARRAY_BUFFER, buffer);
  }
  {
    const auto second = make_context(GetParam());
    const Bound bound(*second);
    GLint current = -1;
    second->gl().GetIntegerv(GL_ARRAY_BUFFER_BINDING, &current);
    EXPECT_EQ(current, 0);
  }
  const Bound bound(*first);
  GLint current = -1;
  first->gl().GetIntegerv(GL_ARRAY_BUFFER_BINDING, &current);
  EXPECT_EQ(static_cast<GLuint>(current), buffer);
  first->gl().DeleteBuffers(1, &buffer);
}

TEST_P(GlContext, MisuseIsReported) {
  for (const bool debug : {false, true}) {
    const auto context = make_context(GetParam(), {.soname = {}, .debug = debug});
    const Bound bound(*context);
    EXPECT_NO_THROW(context->check("doing nothing"));
    context->gl().Enable(0xdead);
    EXPECT_THROW(context->check("enabling nonsense"), BackendError);
    // A debug context keeps the error itself too.
    context->gl().GetError();
    EXPECT_NO_THROW(context->check("doing nothing"));
  }
}

TEST_P(GlContext, ShaderThatDoesNotCompileIsNamed) {
  const auto context = make_context(GetParam());
  const Bound bound(*context);
  try {
    make_program(context->gl(), context->subject(), {{GL_COMPUTE_SHADER, {"compare.glsl", "rasterise.glsl"}}},
                 {});
    FAIL() << "compiled without its definitions";
  } catch (const BackendError& error) {
    EXPECT_NE(std::string(error.what()).find("rasterise.glsl"), std::string::npos) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
  }
}

INSTANTIATE_TEST_SUITE_P(Backends, GlContext, testing::Values(Backend::Gpu, Backend::OsMesa),
                         [](const auto& info) { return std::string(name_of(info.param)); });

TEST(GlLibrary, MissingOneIsABackendErrorWithItsMend) {
  for (const Backend backend : {Backend::Gpu, Backend::OsMesa}) {
    try {
      make_context(backend, {.soname = "libnot-there.so.1", .debug = false});
      FAIL() << "made a context out of nothing";
    } catch (const BackendError& error) {
      const std::string message = error.what();
      EXPECT_EQ(message.find("backend " + std::string(name_of(backend)) + ": "), 0U) << message;
      EXPECT_NE(message.find("libnot-there.so.1"), std::string::npos) << message;
      EXPECT_NE(message.find("install"), std::string::npos) << message;
      EXPECT_NE(message.find("--backend raster"), std::string::npos) << message;
      EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
}

TEST(GlLibrary, WrongOneIsABackendError) {
  for (const Backend backend : {Backend::Gpu, Backend::OsMesa}) {
    EXPECT_THROW(make_context(backend, {.soname = "libc.so.6", .debug = false}), BackendError);
  }
}

TEST(GlRenderer, SoftwareIsToldFromHardware) {
  for (const char* name :
       {"llvmpipe (LLVM 15.0.6, 256 bits)", "softpipe", "Software Rasterizer", "zink (llvmpipe)",
        "ANGLE (Google, Vulkan 1.3.0 (SwiftShader Device), SwiftShader driver)"}) {
    EXPECT_TRUE(is_software({Backend::Gpu, true, name, {}})) << name;
  }
  for (const char* name :
       {"NVIDIA H200/PCIe/SSE2", "AMD Radeon RX 6800 (radeonsi, navi21, LLVM 15.0.6, DRM 3.49)",
        "Mesa Intel(R) UHD Graphics 620 (KBL GT2)"}) {
    EXPECT_FALSE(is_software({Backend::Gpu, true, name, {}})) << name;
  }
}

}  // namespace
}  // namespace rejoin::zbuffer::gl
