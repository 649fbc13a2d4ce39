#pragma once

#include <memory>

#include "renderer/context/headless.hpp"
#include "renderer/gl/device.hpp"

namespace candela {

/// The kind of context that this run of the tests asks for: `--context=egl|osmesa`.
[[nodiscard]] ContextKind tested_context();
void set_tested_context(ContextKind kind);

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
