// Resources found by their names while a graph is declared.

#include <doctest/doctest.h>

#include <any>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/engine/graph_fixture.hpp"

TEST_SUITE("graph find") {

namespace {

using namespace candela;

using Find = GraphFixture;

TEST_CASE_FIXTURE(Find, "the newest version of a texture, by its name") {
    CHECK_FALSE(graph.find_texture("scene"));
    const TextureHandle blank = texture("scene");
    CHECK_FALSE(graph.find_texture("scene"));
    const TextureHandle first = draw("surfaces", {}, blank);
    CHECK(graph.find_texture("scene")->handle == first);
    CHECK(graph.find_texture("scene")->desc == colour);
    const TextureHandle second = draw("sky", {}, first);
    CHECK(graph.find_texture("scene")->handle == second);
    CHECK_FALSE(graph.find_texture("scen"));
    CHECK_FALSE(graph.find_buffer("scene"));

    // The handle is one that a pass may read, and that keeps the texture alive.
    graph.add("look", [&](Pass& pass) {
        pass.side_effect();
        pass.read(graph.find_texture("scene")->handle, Usage::sampled);
    });
    switch_to();
    CHECK(run() == "surfaces sky look");
    CHECK(backend.misuse.empty());
}

TEST_CASE_FIXTURE(Find, "the description of a texture, by its handle") {
    const TextureHandle blank = texture("scene");
    CHECK(graph.desc(blank) == colour);
    CHECK(graph.desc(draw("surfaces", {}, blank)) == colour);
    CHECK_FALSE(graph.desc({}));
    FrameGraph other;
    CHECK_FALSE(graph.desc(other.texture("scene", colour)));
    CHECK_FALSE(graph.desc({graph.buffer<int>("numbers", 1)}));
}

TEST_CASE_FIXTURE(Find, "the names of the passes so far") {
    CHECK(graph.pass_names().empty());
    const TextureHandle drawn = draw("surfaces", {}, texture("scene"));
    {
        const Scope scope = graph.scope({.name_ending = " 2"});
        static_cast<void>(draw("sky", {}, drawn));
    }
    const std::vector<std::string_view> names = graph.pass_names();
    CHECK(names == std::vector<std::string_view>{"surfaces", "sky 2"});
    const CompileResult compiled = compile(std::move(graph));
    REQUIRE(compiled.graph);
    CHECK(names.back() == "sky 2");
}

TEST_CASE_FIXTURE(Find, "names have the endings of views, and of equal names, the last is found") {
    const TextureHandle first = draw("draw", {}, texture("depth"));
    const TextureHandle second = [&] {
        const Scope scope = graph.scope({.name_ending = " 2"});
        return draw("draw", {}, texture("depth"));
    }();
    CHECK(graph.find_texture("depth")->handle == first);
    CHECK(graph.find_texture("depth 2")->handle == second);
    const TextureHandle again = draw("draw again", {}, texture("depth"));
    CHECK(graph.find_texture("depth")->handle == again);
    static_cast<void>(texture("depth"));  // not written
    CHECK(graph.find_texture("depth")->handle == again);
}

TEST_CASE_FIXTURE(Find, "buffers with the size of their elements") {
    const auto buffer = graph.buffer<double>("sums", 3);
    CHECK_FALSE(graph.find_buffer("sums"));
    std::optional<BufferHandle<double>> written;
    graph.add("sum", [&](Pass& pass) { written = pass.write(buffer, Usage::storage); });
    CHECK(graph.find_buffer("sums")->handle == static_cast<ResourceHandle>(*written));
    CHECK(graph.find_buffer("sums")->stride == sizeof(double));
    CHECK(graph.find_buffer("sums")->element == typeid(double));
    CHECK_FALSE(graph.find_texture("sums"));
}

TEST_CASE_FIXTURE(Find, "the note on a resource, of the type that its producer chose") {
    struct Unit {
        std::string name;
        ValueHandle<int> scale;
    };
    const auto scale = graph.value<int>("scale");
    const TextureHandle depth = draw("draw", {}, texture("depth"));
    CHECK(graph.find_texture("depth")->note == nullptr);
    graph.note(depth, 1);
    graph.note(depth, Unit{"metres", scale});
    const std::any* const note = graph.find_texture("depth")->note;
    CHECK(std::any_cast<int>(note) == nullptr);
    REQUIRE(std::any_cast<Unit>(note) != nullptr);
    CHECK(std::any_cast<Unit>(note)->name == "metres");
    CHECK(std::any_cast<Unit>(note)->scale == scale);

    // It stays on later versions.
    static_cast<void>(draw("draw on", {}, depth));
    CHECK(graph.find_texture("depth")->note != nullptr);
}

TEST_CASE_FIXTURE(Find, "imports are not found") {
    const TextureHandle mean = texture("mean");
    const TextureHandle host = texture("host", Lifetime::imported);
    CHECK_FALSE(graph.find_texture("mean"));
    CHECK_FALSE(graph.find_texture("host"));
    const TextureHandle newest = draw("add", {host}, mean);
    CHECK(graph.find_texture("mean")->handle == newest);
}
}  // namespace

}  // TEST_SUITE("graph find")
