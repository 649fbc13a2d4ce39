// Mip levels and layers of textures as resources of their own.

#include <doctest/doctest.h>

#include <algorithm>
#include <iterator>
#include <string>
#include <vector>

#include "tests/engine/graph_fixture.hpp"

TEST_SUITE("graph parts") {

namespace {

using namespace candela;

const TextureDesc chain{{64, 32}, Format::rgba16f, TextureShape::flat, 1, 4};
const TextureDesc stack{{16, 16}, Format::r32f, TextureShape::array, 3, 2};

struct Parts : GraphFixture {
    TextureHandle fill(std::string_view name, TextureHandle target, ValueHandle<int> source) {
        return graph.add(name, [&](Pass& pass) {
            pass.read(source);
            return pass.write(target, Usage::colour_target);
        });
    }
    void show(TextureHandle texture) {
        graph.add("show", [&](Pass& pass) {
            pass.read(texture, {Usage::sampled, 3});
            pass.side_effect();
        });
    }
    std::vector<CompileError> errors() { return compile(std::move(graph)).errors; }
};

TEST_CASE_FIXTURE(Parts, "each mip is drawn from the previous one, and all are read as one texture") {
    const TextureHandle bloom = graph.texture("bloom", chain);
    const auto light = graph.import_value<int>("light");
    TextureHandle level = fill("bright", graph.mip(bloom, 0), light);
    for (std::uint32_t mip = 1; mip < chain.mips; ++mip) {
        level = draw("down " + std::to_string(mip), {level}, graph.mip(bloom, mip));
    }
    show(bloom);
    switch_to();
    runtime.set(light, 1);

    CHECK(run() == "bright down 1 down 2 down 3 show");
    REQUIRE(backend.bound.size() == 1);
    CHECK(backend.bound[0].first == runtime.object(bloom));
    CHECK(backend.objects.at(runtime.object(level)).texture_desc == TextureDesc{{8, 4}, Format::rgba16f});
    CHECK(backend.objects.size() == 5);
    CHECK(runtime.memory().texture_bytes == byte_size(chain));
    CHECK(run() == "show");
    CHECK(backend.misuse.empty());
}

TEST_CASE_FIXTURE(Parts, "if a part changes, only its readers and readers of the whole texture run") {
    const TextureHandle shadows = graph.texture("shadows", stack);
    const auto sun = graph.import_value<int>("sun");
    const auto lamp = graph.import_value<int>("lamp");
    const TextureHandle sun_map = fill("sun map", graph.layer(shadows, 0), sun);
    (void)fill("lamp map", graph.layer(shadows, 1), lamp);
    const TextureHandle seen = draw("sun only", {sun_map}, texture("seen", Lifetime::persistent));
    std::vector<bool> changed;
    const TextureHandle shaded = graph.add("shade", [&](Pass& pass) {
        pass.read(shadows, Usage::sampled);
        pass.run([&, shadows](Execution& run) { changed.push_back(run.changed(shadows)); });
        return pass.write(texture("shaded", Lifetime::persistent), Usage::colour_target);
    });
    graph.add("show", [&](Pass& pass) {
        pass.read(shaded, Usage::sampled);
        pass.read(seen, Usage::sampled);
        pass.side_effect();
    });
    switch_to();
    runtime.set(sun, 1);
    runtime.set(lamp, 1);
    CHECK(run() == "sun map lamp map sun only shade show");
    runtime.set(lamp, 2);
    CHECK(run() == "lamp map shade show");
    runtime.set(sun, 2);
    CHECK(run() == "sun map sun only shade show");
    CHECK(run() == "show");
    CHECK(changed == std::vector<bool>{true, true, true});
}

TEST_CASE_FIXTURE(Parts, "incoherent writes of parts are visible to readers of the whole texture") {
    const TextureHandle whole = graph.texture("whole", chain);
    graph.add("write", [&](Pass& pass) { (void)pass.write(graph.mip(whole, 1), Usage::storage); });
    show(whole);
    switch_to();
    (void)run();
    const auto shown = std::ranges::find(backend.log, "begin show");
    REQUIRE(shown - backend.log.begin() > 0);
    CHECK(*std::prev(shown) == "barrier texture fetch");
}

TEST_CASE_FIXTURE(Parts, "a switch keeps a texture with its parts, and a new size creates new ones") {
    const auto declare = [&](const TextureDesc& desc) {
        graph = FrameGraph();
        const TextureHandle whole = graph.texture("whole", desc);
        const TextureHandle part = draw("draw", {}, graph.mip(whole, 2));
        show(whole);
        switch_to();
        const std::string passes = run();
        CHECK(backend.misuse.empty());
        return std::pair(runtime.object(part), passes);
    };
    const TextureDesc odd{{65, 33}, chain.format, chain.shape, 1, 4};  // mip 2 has the same size
    const auto first = declare(chain);
    CHECK(first.second == "draw show");
    CHECK(declare(chain) == std::pair(first.first, std::string("show")));
    const auto other = declare(odd);
    CHECK(other.first != first.first);
    CHECK(other.second == "draw show");
    CHECK(declare(chain).first == first.first);  // from the free pool
    (void)declare(chain);                        // destroys what is still in the pool
    CHECK(backend.objects.size() == 2);
}

TEST_CASE_FIXTURE(Parts, "a switch that fails while it creates parts leaves the graph unchanged") {
    show(draw("draw", {}, texture("drawn")));
    switch_to();
    const std::size_t before = backend.objects.size();
    graph = FrameGraph();
    const TextureHandle whole = graph.texture("whole", chain);
    show(draw("draw", {}, graph.mip(whole, 0)));
    backend.creations_left = 1;
    CHECK_THROWS_AS(switch_to(), std::runtime_error);
    CHECK(backend.objects.size() == before);
    CHECK(run() == "draw show");
}

TEST_CASE_FIXTURE(Parts, "errors name invalid parts") {
    const TextureHandle sky = graph.texture("sky", chain, Lifetime::imported);
    const TextureHandle flat = graph.texture("flat", chain);
    const TextureHandle layers = graph.texture("layers", stack);
    (void)graph.mip(sky, 0);
    (void)graph.mip(flat, 4);
    (void)graph.layer(flat, 0);
    (void)graph.mip(layers, 1);
    CHECK(graph.mip(layers, 1) == graph.mip(layers, 1));
    (void)graph.layer(layers, 2, 1);
    (void)graph.mip(graph.mip(layers, 1), 0);
    (void)graph.history(layers);
    graph.add("write", [&](Pass& pass) { (void)pass.write(layers, Usage::storage); });
    show(layers);
    std::vector<std::string> messages;
    for (const CompileError& error : errors()) {
        messages.push_back(error.message);
    }
    CHECK(messages ==
          std::vector<std::string>{
              "texture 'sky' has no mip 0: it is imported", "texture 'flat' has no mip 4: there are fewer",
              "texture 'flat' has no layer 0: there are fewer",
              "texture 'layers' has no layer 2 mip 1: it overlaps another part",
              "texture 'layers mip 1' has no mip 0: it has a history, is one, or is a part itself",
              "texture 'layers' has no history: it has parts or is one",
              "pass 'write' writes texture 'layers', which has parts: only they can be written",
              "pass 'show' reads texture 'layers mip 1', which no pass has written"});
}

TEST_CASE_FIXTURE(Parts, "a pass may not write a part of a texture that it reads as a whole") {
    const TextureHandle whole = graph.texture("whole", chain);
    const TextureHandle drawn = draw("draw", {}, graph.mip(whole, 0));
    graph.add("both", [&](Pass& pass) {
        pass.read(whole, Usage::sampled);
        (void)pass.write(drawn, Usage::storage);
    });
    const std::vector<CompileError> found = errors();
    REQUIRE(found.size() == 1);
    CHECK(found[0].code == ErrorCode::feedback);
}
}  // namespace

}  // TEST_SUITE("graph parts")
