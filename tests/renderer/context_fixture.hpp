#pragma once

#include <memory>
#include <utility>

#include <candela/headless_context.hpp>
#include <candela/renderer.hpp>
#include "renderer/gl/device.hpp"

namespace candela {

/// The kind of context that this run of the tests uses: `--context=egl|osmesa`.
[[nodiscard]] ContextKind tested_context();
void set_tested_context(ContextKind kind);

/// Whether all renderers of this run of the tests verify their frames: `--verify`.
[[nodiscard]] bool tests_verify();
void set_tests_verify(bool on);

/// A renderer with debug output and the options of this run of the tests.
class TestedRenderer : public Renderer {
 public:
    explicit TestedRenderer(const gl::GetProc& get_proc, RendererOptions options = {})
        : Renderer(get_proc, with_debug_output(std::move(options))) {
        verify(tests_verify());
    }

 private:
    static RendererOptions with_debug_output(RendererOptions options) {
        options.debug_output = true;
        return options;
    }
};

/// Makes a context of the tested kind current.
[[nodiscard]] std::unique_ptr<HeadlessContext> make_current_context();

/// Each test case has its own current context and device. At the end of the test case all objects made for
/// the device must be gone, and the driver must not have reported anything.
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
