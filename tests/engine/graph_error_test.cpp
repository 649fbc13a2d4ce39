// Every invalid declaration of a graph, and what compiling reports about it.

#include <doctest/doctest.h>

#include <algorithm>
#include <initializer_list>
#include <string>
#include <vector>

#include <candela/graph/compile.hpp>
#include <candela/graph/describe.hpp>

TEST_SUITE("graph error") {

namespace {

using namespace candela;

const TextureDesc colour{{64, 32}, Format::rgba16f};
const TextureDesc depth{{64, 32}, Format::depth32f};

std::vector<CompileError> errors_of(FrameGraph& graph) {
    return compile(std::move(graph)).errors;
}

/// The only error of a graph; it must have exactly one.
CompileError error_of(FrameGraph& graph) {
    const std::vector<CompileError> errors = errors_of(graph);
    REQUIRE(errors.size() == 1);
    return errors.front();
}

TextureHandle add_draw(FrameGraph& graph, std::string_view pass_name, TextureHandle target) {
    return graph.add(pass_name, [&](Pass& pass) { return pass.write(target, Usage::colour_target); });
}

void add_read(FrameGraph& graph, std::string_view pass_name, TextureHandle source) {
    graph.add(pass_name, [&](Pass& pass) {
        pass.read(source, Usage::sampled);
        pass.side_effect();
    });
}

TEST_CASE("graph error: handles without a graph, of another graph, of another kind") {
    FrameGraph other;
    const TextureHandle foreign = other.texture("elsewhere", colour);

    FrameGraph graph;
    const TextureHandle own = graph.texture("own", colour);
    add_read(graph, "default", {});
    add_read(graph, "other graph", foreign);
    (void)add_draw(graph, "write", foreign);
    add_read(graph, "unknown version", TextureHandle{{own.graph, own.resource, 7}});
    add_read(graph, "unknown resource", TextureHandle{{own.graph, 99, 0}});
    graph.add("kind", [&](Pass& pass) {
        pass.read(BufferHandle<int>{{own.graph, own.resource, 0}}, Usage::storage);
    });

    const std::vector<CompileError> errors = errors_of(graph);
    REQUIRE(errors.size() == 6);
    for (const CompileError& error : errors) {
        CHECK(error.code == ErrorCode::foreign_handle);
    }
    CHECK(errors[0].message == "pass 'default' reads a texture by a null handle");
    CHECK(errors[2].message == "pass 'write' writes a texture of another graph");
    CHECK(errors[5].message == "pass 'kind' reads a buffer by a handle that is not of one");
}

TEST_CASE("graph error: reading an overwritten version names both passes") {
    FrameGraph graph;
    const TextureHandle first = add_draw(graph, "draw", graph.texture("image", colour));
    const TextureHandle second = add_draw(graph, "overdraw", first);
    (void)add_draw(graph, "overdraw more", second);
    add_read(graph, "show", first);
    CHECK(error_of(graph) ==
          CompileError{ErrorCode::stale_handle,
                       "pass 'show' reads texture 'image' as it was before pass 'overdraw' wrote it"});
}

TEST_CASE("graph error: two writers of one version") {
    FrameGraph graph;
    const TextureHandle blank = graph.texture("image", colour);
    (void)add_draw(graph, "draw", blank);
    (void)add_draw(graph, "draw too", blank);
    CHECK(error_of(graph) == CompileError{ErrorCode::two_writers,
                                          "passes 'draw' and 'draw too' both write version 1 of "
                                          "texture 'image'"});
}

TEST_CASE("graph error: reads of resources that no pass writes") {
    FrameGraph graph;
    add_read(graph, "show", graph.texture("image", colour));
    add_read(graph, "show kept", graph.texture("kept", colour, Lifetime::persistent));
    graph.add("use", [&](Pass& pass) { pass.read(graph.value<int>("number")); });
    const std::vector<CompileError> errors = errors_of(graph);
    REQUIRE(errors.size() == 3);
    CHECK(errors[0] == CompileError{ErrorCode::unwritten_read,
                                    "pass 'show' reads texture 'image', which no pass has written"});
    CHECK(errors[1].message == "pass 'show kept' reads texture 'kept', which no pass has written");
    CHECK(errors[2].message == "pass 'use' reads value 'number', which no pass has written");
}

TEST_CASE("graph: imported resources may be read before they are written") {
    FrameGraph graph;
    add_read(graph, "environment", graph.texture("sky", colour, Lifetime::imported));
    graph.add("exposure", [&](Pass& pass) {
        pass.read(graph.import_value<float>("exposure"));
        pass.side_effect();
    });
    CHECK(compile(std::move(graph)).errors.empty());
}

TEST_CASE("graph error: a write of a value that the host sets") {
    FrameGraph graph;
    graph.add("host", [&](Pass& pass) { (void)pass.write(graph.import_value<int>("number")); });
    CHECK(error_of(graph) ==
          CompileError{ErrorCode::wrong_usage, "pass 'host' writes value 'number', which the host sets"});
}

TEST_CASE("graph error: updates of resources that do not keep the previous frame's content") {
    FrameGraph graph;
    const TextureHandle kept = graph.texture("kept", colour, Lifetime::persistent);
    graph.add("update", [&](Pass& pass) {
        (void)pass.update(graph.texture("transient", colour), Usage::storage);
        (void)pass.update(graph.buffer<int>("imported", 4, Lifetime::imported), Usage::storage);
        (void)pass.update(pass.update(kept, Usage::storage), Usage::storage);
    });
    const std::vector<CompileError> errors = errors_of(graph);
    REQUIRE(errors.size() == 3);
    for (const CompileError& error : errors) CHECK(error.code == ErrorCode::wrong_usage);
    CHECK(errors[0].message ==
          "pass 'update' updates texture 'transient': "
          "only version 0 of what is persistent can be updated");
}

/// Whether a pass that accesses an imported texture or buffer with `access` is invalid.
template <class Access>
bool bad(const TextureDesc& desc, Access access) {
    FrameGraph graph;
    const TextureHandle texture = graph.texture("texture", desc, Lifetime::imported);
    const BufferHandle<int> buffer = graph.buffer<int>("buffer", 8, Lifetime::imported);
    graph.add("pass", [&](Pass& pass) { access(pass, texture, buffer); });
    return !errors_of(graph).empty();
}

TEST_CASE("graph error: each usage that reads or writes of textures or buffers do not allow") {
    using enum Usage;
    const auto one_of = [](Usage usage, std::initializer_list<Usage> usages) {
        return std::find(usages.begin(), usages.end(), usage) != usages.end();
    };
    for (const Usage usage : {sampled, storage, uniform, vertex, index, indirect, colour_target, depth_target,
                              layer_target, copy}) {
        CAPTURE(to_string(usage));
        const TextureDesc& desc = usage == depth_target ? depth : colour;
        CHECK(bad(desc, [&](Pass& pass, auto texture, auto) { pass.read(texture, usage); }) !=
              one_of(usage, {sampled, storage, depth_target, copy}));
        CHECK(bad(desc, [&](Pass& pass, auto texture, auto) { (void)pass.write(texture, usage); }) !=
              one_of(usage, {storage, colour_target, depth_target, layer_target, copy}));
        CHECK(bad(desc, [&](Pass& pass, auto, auto buffer) { pass.read(buffer, usage); }) !=
              one_of(usage, {sampled, storage, uniform, vertex, index, indirect, copy}));
        CHECK(bad(desc, [&](Pass& pass, auto, auto buffer) { (void)pass.write(buffer, usage); }) !=
              one_of(usage, {storage, copy}));
    }
}

TEST_CASE("graph error: wrong usage and wrong format are named") {
    FrameGraph graph;
    graph.add("draw", [&](Pass& pass) {
        (void)pass.write(graph.texture("normal", colour), Usage::sampled);
        (void)pass.write(graph.texture("z", depth), Usage::colour_target);
        (void)pass.write(graph.texture("albedo", colour), Usage::depth_target);
    });
    const std::vector<CompileError> errors = errors_of(graph);
    REQUIRE(errors.size() == 3);
    CHECK(errors[0] ==
          CompileError{ErrorCode::wrong_usage, "pass 'draw' writes texture 'normal' as sampled"});
    CHECK(errors[1] ==
          CompileError{ErrorCode::wrong_usage,
                       "pass 'draw' writes texture 'z' as colour target, but its format is depth32f"});
    CHECK(errors[2] ==
          CompileError{ErrorCode::wrong_usage,
                       "pass 'draw' writes texture 'albedo' as depth target, but its format is rgba16f"});
}

TEST_CASE("graph error: passes held by what no host sets") {
    FrameGraph graph;
    static_cast<void>(graph.scope({.held = graph.value<bool>("own")}));
    const std::vector<CompileError> errors = errors_of(graph);
    REQUIRE(errors.size() == 1);
    CHECK(errors[0] ==
          CompileError{ErrorCode::wrong_usage, "passes are held by value 'own', which is not imported"});
}

TEST_CASE("graph error: a pass reads what it overwrites, in either order of declaration") {
    for (const bool read_first : {true, false}) {
        FrameGraph graph;
        const TextureHandle image = add_draw(graph, "draw", graph.texture("image", colour));
        graph.add("loop", [&](Pass& pass) {
            if (read_first) pass.read(image, Usage::sampled);
            (void)pass.write(image, Usage::colour_target);
            if (!read_first) pass.read(image, Usage::sampled);
            pass.side_effect();
        });
        CHECK(error_of(graph) == CompileError{ErrorCode::feedback,
                                              "pass 'loop' reads texture 'image' and overwrites it: a "
                                              "write from version 1 on depends on what was there by "
                                              "itself"});
    }
}

TEST_CASE("graph: a pass may read back its own result, and write it in steps") {
    FrameGraph graph;
    graph.add("count", [&](Pass& pass) {
        const auto cleared = pass.write(graph.buffer<int>("counts", 4), Usage::copy);
        const auto counted = pass.write(cleared, Usage::storage);
        pass.read(counted, Usage::indirect);
        pass.side_effect();
    });
    CHECK(compile(std::move(graph)).errors.empty());
}

TEST_CASE("graph error: attachments of different sizes, and two depth targets") {
    FrameGraph graph;
    graph.add("draw", [&](Pass& pass) {
        (void)pass.write(graph.texture("albedo", colour), Usage::colour_target);
        (void)pass.write(graph.texture("normal", {{64, 64}, Format::rgba16f}), Usage::colour_target);
        (void)pass.write(graph.texture("near", depth), Usage::depth_target);
        (void)pass.write(graph.texture("far", depth), Usage::depth_target);
    });
    const std::vector<CompileError> errors = errors_of(graph);
    REQUIRE(errors.size() == 2);
    CHECK(
        errors[0] ==
        CompileError{ErrorCode::attachment_mismatch,
                     "pass 'draw' has attachments of different sizes: 'albedo' is 64x32, 'normal' is 64x64"});
    CHECK(errors[1] == CompileError{ErrorCode::attachment_mismatch,
                                    "pass 'draw' has two depth targets, 'near' and 'far'"});
}

TEST_CASE("graph error: two resources at one binding point") {
    FrameGraph graph;
    const TextureHandle one = add_draw(graph, "draw one", graph.texture("one", colour));
    const TextureHandle two = add_draw(graph, "draw two", graph.texture("two", colour));
    const auto numbers = graph.buffer<int>("numbers", 4, Lifetime::imported);
    graph.add("show", [&](Pass& pass) {
        pass.read(one, {Usage::sampled, 3});
        pass.read(two, {Usage::sampled, 3});
        pass.read(numbers, {Usage::storage, 3});  // storage blocks have numbers of their own
        pass.side_effect();
    });
    CHECK(error_of(graph) ==
          CompileError{ErrorCode::shared_point,
                       "pass 'show' has texture 'one' and texture 'two' at texture unit 3"});
}

TEST_CASE("graph error: textures that cannot be") {
    const auto why = [](const TextureDesc& desc) {
        FrameGraph graph;
        (void)add_draw(graph, "draw", graph.texture("image", desc, Lifetime::imported));
        const CompileError error = error_of(graph);
        CHECK(error.code == ErrorCode::impossible_texture);
        return error.message.substr(std::string_view("texture 'image' is not possible: ").size());
    };
    constexpr glm::uvec2 size{8, 5};
    CHECK(why({.size = {0, 4}}) == "its size is 0x4");
    // Levels of 8x5, 4x2, 2x1 and 1x1.
    CHECK(why({.size = size, .mips = 5}) == "8x5 texels have 1 to 4 mip levels, not 5");
    CHECK(why({.size = size, .mips = 0}) == "8x5 texels have 1 to 4 mip levels, not 0");
    CHECK(why({.size = size, .shape = TextureShape::array, .layers = 0}) == "it has no layers");
    CHECK(why({.size = size, .layers = 2}) == "it is flat, but has 2 layers");
    CHECK(why({.size = glm::uvec2(8), .shape = TextureShape::cube_array, .layers = 8}) ==
          "cubes have six layers each, and it has 8");
    CHECK(why({.size = size, .shape = TextureShape::cube_array, .layers = 6}) ==
          "the sides of cubes are square");
    CHECK(why_impossible({.size = size, .shape = TextureShape::array, .layers = 3, .mips = 4}).empty());
}

TEST_CASE("graph error: names used twice") {
    FrameGraph graph;
    for (int time = 0; time < 2; ++time) {
        graph.add("draw", [&](Pass& pass) {
            (void)pass.write(graph.texture("transient", colour), Usage::colour_target);
            (void)pass.write(graph.texture("kept", colour, Lifetime::persistent), Usage::colour_target);
        });
    }
    (void)graph.value<int>("kept");  // another kind: no clash
    const std::vector<CompileError> errors = errors_of(graph);
    REQUIRE(errors.size() == 2);
    CHECK(errors[0] == CompileError{ErrorCode::duplicate_pass, "two passes are called 'draw'"});
    CHECK(errors[1] == CompileError{ErrorCode::duplicate_resource,
                                    "two textures that are kept or imported are called 'kept'"});
}

TEST_CASE("the same passes can be declared twice in scopes with other names") {
    FrameGraph graph;
    const auto declare = [&] {
        const TextureHandle image = graph.texture("image", colour, Lifetime::persistent);
        graph.add("draw", [&](Pass& pass) {
            pass.side_effect();
            (void)pass.write(image, Usage::colour_target);
        });
    };
    declare();
    {
        const Scope scope = graph.scope({.name_ending = " 2"});
        declare();
    }
    graph.add("last", [](Pass& pass) { pass.side_effect(); });
    const std::string text = describe_text(describe(compile(std::move(graph)).take()));
    for (const std::string line :
         {"0 draw (side", "1 draw 2 (side", "2 last (side", "  image:", "  image 2:"}) {
        CAPTURE(line);
        CHECK(text.find(line) != std::string::npos);
    }
}

TEST_CASE("graph error: a pass inside a pass") {
    FrameGraph graph;
    graph.add("outer", [&](Pass&) { graph.add("inner", [](Pass&) {}); });
    CHECK(error_of(graph) ==
          CompileError{ErrorCode::nested_pass, "pass 'inner' is declared inside pass 'outer'"});
}

TEST_CASE("graph error: all errors are found at once, and take() throws them") {
    FrameGraph graph;
    add_read(graph, "show", {});
    add_read(graph, "show", graph.texture("image", colour));
    CompileResult result = compile(std::move(graph));
    CHECK_FALSE(result);
    CHECK(result.errors.size() == 3);
    CHECK_THROWS_WITH_AS((void)std::move(result).take(), R"(the frame graph does not compile:
  pass 'show' reads a texture by a null handle
  pass 'show' reads texture 'image', which no pass has written
  two passes are called 'show')",
                         GraphError);
}

}  // namespace

}  // TEST_SUITE("graph error")
