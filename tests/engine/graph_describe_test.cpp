// Descriptions of compiled graphs of every shape. Each expected text was derived by hand from the rules in
// compile.hpp.

#include <doctest/doctest.h>

#include <candela/graph/describe.hpp>

TEST_SUITE("graph describe") {

namespace {

using namespace candela;

const TextureDesc colour{{64, 32}, Format::rgba16f};

struct PointLight {
    float intensity = 1;
};

TextureHandle import_target(FrameGraph& graph) {
    return graph.texture("target", {{64, 32}, Format::rgba8}, Lifetime::imported);
}

/// Adds a pass that shows `source` on the target; it is the root of these graphs.
void add_show(FrameGraph& graph, TextureHandle source, TextureHandle target) {
    graph.add("show", [&](Pass& pass) {
        pass.read(source, Usage::sampled);
        (void)pass.write(target, Usage::colour_target);
    });
}

TextureHandle add_draw(FrameGraph& graph, std::string_view pass_name, std::string_view texture) {
    return graph.add(pass_name, [&](Pass& pass) {
        return pass.write(graph.texture(texture, colour), Usage::colour_target);
    });
}

TextureHandle add_filter(FrameGraph& graph, std::string_view pass_name, TextureHandle source,
                         std::string_view texture) {
    return graph.add(pass_name, [&](Pass& pass) {
        pass.read(source, Usage::sampled);
        return pass.write(graph.texture(texture, colour), Usage::colour_target);
    });
}

std::string text_of(FrameGraph& graph) {
    return "\n" + describe_text(describe(compile(std::move(graph)).take()));
}

TEST_CASE("graph description: in a chain, transients with disjoint lifetimes share objects") {
    FrameGraph graph;
    const TextureHandle a = add_draw(graph, "draw", "a");
    const TextureHandle b = add_filter(graph, "blur", a, "b");
    const TextureHandle c = add_filter(graph, "sharpen", b, "c");
    add_show(graph, c, import_target(graph));
    CHECK(text_of(graph) == R"(
passes
  0 draw
      write a v1 (colour target)
  1 blur
      after draw (result: a)
      read a v1 (sampled)
      write b v1 (colour target)
  2 sharpen
      after blur (result: b)
      read b v1 (sampled)
      write c v1 (colour target)
  3 show
      after sharpen (result: c)
      read c v1 (sampled)
      write target v1 (colour target)
resources
  a: texture 64x32 rgba16f, transient [0..1], object 0
  b: texture 64x32 rgba16f, transient [1..2], object 1
  c: texture 64x32 rgba16f, transient [2..3], object 0
  target: texture 64x32 rgba8, imported [3..3], object 2
)");
}

TEST_CASE("graph description: a diamond") {
    FrameGraph graph;
    const TextureHandle source = add_draw(graph, "draw", "source");
    const TextureHandle left = add_filter(graph, "left", source, "left");
    const TextureHandle right = add_filter(graph, "right", source, "right");
    graph.add("join", [&](Pass& pass) {
        pass.read(left, Usage::sampled);
        pass.read(right, Usage::sampled);
        pass.side_effect();
    });
    CHECK(text_of(graph) == R"(
passes
  0 draw
      write source v1 (colour target)
  1 left
      after draw (result: source)
      read source v1 (sampled)
      write left v1 (colour target)
  2 right
      after draw (result: source)
      read source v1 (sampled)
      write right v1 (colour target)
  3 join (side effect)
      after left (result: left)
      after right (result: right)
      read left v1 (sampled)
      read right v1 (sampled)
resources
  source: texture 64x32 rgba16f, transient [0..2], object 0
  left: texture 64x32 rgba16f, transient [1..3], object 1
  right: texture 64x32 rgba16f, transient [2..3], object 2
)");
}

TEST_CASE("graph description: an unneeded branch is culled, a side effect and its inputs are kept") {
    FrameGraph graph;
    const TextureHandle a = add_draw(graph, "draw", "a");
    const TextureHandle unseen = add_filter(graph, "unseen", a, "u");
    (void)add_filter(graph, "unseen too", unseen, "v");
    const TextureHandle probed = add_filter(graph, "probed", a, "p");
    graph.add("probe", [&](Pass& pass) {
        pass.read(probed, Usage::copy);
        pass.side_effect();
    });
    CHECK(text_of(graph) == R"(
passes
  0 draw
      write a v1 (colour target)
  1 probed
      after draw (result: a)
      read a v1 (sampled)
      write p v1 (colour target)
  2 probe (side effect)
      after probed (result: p)
      read p v1 (copy)
culled
  unseen
  unseen too
resources
  a: texture 64x32 rgba16f, transient [0..1], object 0
  p: texture 64x32 rgba16f, transient [1..2], object 1
)");
}

TEST_CASE("graph description: systems, values and planned barriers") {
    FrameGraph graph;
    const auto lights = graph.add("gather-lights", [&](Pass& pass) {
        pass.read<PointLight>();
        return pass.write(graph.value<int>("lights"));
    });
    const auto vpls = graph.add("trace", [&](Pass& pass) {
        pass.read(lights);
        return pass.write(graph.buffer<float>("vpls", 256), Usage::storage);
    });
    const auto lit = graph.add("light", [&](Pass& pass) {
        pass.read(vpls, Usage::storage);
        return pass.write(graph.texture("lit", colour), Usage::storage);
    });
    graph.add("count", [&](Pass& pass) {
        pass.read(vpls, Usage::storage);
        pass.side_effect();
    });
    add_show(graph, lit, import_target(graph));
    // Some barriers wait for the previous frame: "trace" overwrites what "light" and "count" have read,
    // "light" overwrites what "show" has sampled.
    CHECK(text_of(graph) == R"(
passes
  0 gather-lights
      world PointLight
      write lights v1
  1 trace
      after gather-lights (result: lights)
      read lights v1
      write vpls v1 (storage)
  2 light
      after trace (result: vpls)
      barrier image access + storage
      read vpls v1 (storage)
      write lit v1 (storage)
  3 count (side effect)
      after trace (result: vpls)
      read vpls v1 (storage)
  4 show
      after light (result: lit)
      barrier texture fetch + storage
      read lit v1 (sampled)
      write target v1 (colour target)
resources
  lights: value, persistent [0..1]
  vpls: buffer of 256 x 4 bytes, transient [1..3], object 0
  lit: texture 64x32 rgba16f, transient [2..4], object 1
  target: texture 64x32 rgba8, imported [4..4], object 2
)");
}

TEST_CASE("graph description: an empty graph") {
    FrameGraph graph;
    CHECK(text_of(graph) == "\npasses\nresources\n");
}

TEST_CASE("graph description: passes, resources and edges, two passes having one edge of each kind at most") {
    FrameGraph graph;
    const auto number =
        graph.add("count", [&](Pass& pass) { return pass.write(graph.value<int>("number")); });
    const auto drawn = graph.add("draw", [&](Pass& pass) {
        pass.read(number);
        const auto image = pass.write(graph.texture("colour", colour), Usage::colour_target);
        const auto counts = pass.write(graph.buffer<int>("counts", 3), Usage::storage);
        return std::pair(image, counts);
    });
    graph.add("unseen", [&](Pass& pass) { (void)pass.write(graph.value<int>("other")); });
    graph.add("mix", [&](Pass& pass) {
        const TextureHandle mixed = graph.texture("mixed", colour);
        pass.read(drawn.first, Usage::sampled);
        pass.read(drawn.second, Usage::uniform);
        (void)pass.write(mixed, Usage::colour_target);
        pass.side_effect();
    });
    const GraphDescription description = describe(compile(std::move(graph)).take());

    REQUIRE(description.passes.size() == 3);
    CHECK_FALSE(description.passes[0].gpu);
    CHECK(description.passes[1].gpu);
    CHECK(description.culled == std::vector<std::string>{"unseen"});
    REQUIRE(description.resources.size() == 4);
    CHECK(description.resources[1].texture == colour);
    CHECK(description.resources[2].buffer == BufferDesc{3, sizeof(int)});
    CHECK(description.edges ==
          std::vector<DescribedEdge>{{0, 1, DependencyKind::result, {"number"}},
                                     {1, 2, DependencyKind::result, {"colour", "counts"}}});

    const DescribedPass& mix = description.passes[2];
    CHECK(mix.name == "mix");
    CHECK(mix.side_effect);
    CHECK(mix.barrier == Barrier::uniform);
    REQUIRE(mix.accesses.size() == 3);
    CHECK(mix.accesses[1].usage == Usage::uniform);
    CHECK_FALSE(mix.accesses[1].write);
    CHECK(mix.accesses[2].write);
}

}  // namespace

}  // TEST_SUITE("graph describe")
