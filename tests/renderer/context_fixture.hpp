#pragma once

#include <filesystem>
#include <memory>

#include "renderer/context/headless.hpp"
#include "renderer/gl/device.hpp"
#include "renderer/renderer.hpp"

namespace candela {

/// The kind of context that this run of the tests asks for: `--context=egl|osmesa`.
[[nodiscard]] ContextKind tested_context();
void set_tested_context(ContextKind kind);

/// Whether all renderers of this run of the tests verify their frames: `--verify`.
[[nodiscard]] bool tests_verify();
void set_tests_verify(bool on);

/// A renderer as this run of the tests asks for it.
class TestedRenderer : public Renderer {
 public:
    explicit TestedRenderer(const gl::GetProc& get_proc, const std::filesystem::path& shader_directory = {})
        : Renderer(get_proc, shader_directory) {
        verify(tests_verify());
    }
};

/// Makes a context of the tested kind current.
[[nodiscard]] std::unique_ptr<HeadlessContext> make_current_context();

/// A context of its own, current, and a device for each test case. At the end of the test case nothing may be
/// left of the objects made for the device, and the driver must have had nothing to complain about.
class GlFixture {
 public:
    GlFixture();
    GlFixture(const GlFixture&) = delete;
    GlFixture& operator=(const GlFixture&) = delete;
    ~GlFixture();

 protected:
    std::unique_ptr<HeadlessContext> context;
    gl::Device device;
};

}  // namespace candela
