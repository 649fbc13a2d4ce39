#include "tests/renderer/context_fixture.hpp"

#include <doctest/doctest.h>

namespace candela {
namespace {

ContextKind& tested_kind() {
    static ContextKind kind = ContextKind::egl;
    return kind;
}

bool& verifying() {
    static bool on = false;
    return on;
}

}  // namespace

ContextKind tested_context() {
    return tested_kind();
}

void set_tested_context(ContextKind kind) {
    tested_kind() = kind;
}

bool tests_verify() {
    return verifying();
}

void set_tests_verify(bool on) {
    verifying() = on;
}

std::unique_ptr<HeadlessContext> make_current_context() {
    auto context = HeadlessContext::create(tested_context(), {.debug = true});
    context->make_current();
    return context;
}

GlFixture::GlFixture() : context(make_current_context()), device(context->get_proc(), gl::DebugOutput::on) {}

GlFixture::~GlFixture() {
    context->make_current();
    for (const gl::DebugMessage& message : device.take_messages()) {
        INFO(message.text);
        CHECK_FALSE(message.is_error());
    }
    CHECK(device.live() == gl::ObjectCounts{});
}

}  // namespace candela
