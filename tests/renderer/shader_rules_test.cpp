#include "tests/renderer/shader_rules.hpp"

#include <doctest/doctest.h>

TEST_SUITE("shader rules") {

using namespace candela;

TEST_CASE("a fetch with implicit derivatives follows nothing by which invocations of a quad leave") {
    CHECK(ambiguities("void main() { c = texture(t, uv); if (c.a < 0.5) discard; }").empty());
    CHECK(ambiguities("void main() { if (c.a < 0.5) discard; c = texture(t, uv); }").size() == 1);
    CHECK(ambiguities("void main() { if (gl_HelperInvocation) return; c = texture(t, uv); }").size() == 1);
    CHECK(ambiguities("void main() { if (gl_HelperInvocation) return; c = texelFetch(t, at, 0); }").empty());
    // Through functions.
    CHECK(ambiguities("vec4 f() { return texture(t, uv); } void g() { discard; } void main() { f(); g(); }")
              .empty());
    CHECK(ambiguities("vec4 f() { return texture(t, uv); } void g() { discard; } void main() { g(); f(); }")
              .size() == 1);
    CHECK(ambiguities("vec2 f() { if (x) return y; return dFdx(uv); } void main() { f(); }").size() == 1);
}

TEST_CASE("a barrier also orders writes to shared memory") {
    CHECK(ambiguities("void main() { a = 1; memoryBarrierShared(); barrier(); }").empty());
    CHECK(ambiguities("void main() { a = 1; barrier(); }").size() == 1);
    CHECK(ambiguities("void main() { memoryBarrierShared(); a = 1; barrier(); }").size() == 1);
}

TEST_CASE("infinity is no quotient") {
    CHECK(ambiguities("const float a = 1.0 / 0.5;").empty());
    CHECK(ambiguities("const float a = 1.0 / 0.0;").size() == 1);
    CHECK(ambiguities("float f() { return -1.0/0; }").size() == 1);
}

TEST_CASE("the value of an assignment is not read") {
    CHECK(ambiguities("void main() { a = 1; b = a == 1; for (uint i = 0, j = 1; i <= 2; ++i) c += i; }")
              .empty());
    CHECK(ambiguities("void main() { a = b = 1; }").size() == 1);
    CHECK(ambiguities("void main() { a[0] = a[1] = b; }").size() == 1);
}

}  // TEST_SUITE("shader rules")
