#include "sandbox/panels/graph_picture.hpp"

#include <doctest/doctest.h>

#include <candela/graph/compile.hpp>
#include <candela/graph/describe.hpp>
#include <candela/graph/frame_graph.hpp>

namespace candela::sandbox {

TEST_SUITE("graph picture") {
    TEST_CASE("passes, resources and edges are those of the graph, two passes having one edge at most") {
        FrameGraph graph;
        const auto number = graph.add("count", [&](Pass& pass) {
            const auto value = pass.write(graph.value<int>("number"));
            pass.run([](Execution&) {});
            return value;
        });
        const auto drawn = graph.add("draw", [&](Pass& pass) {
            pass.read(number);
            const auto colour =
                pass.write(graph.texture("colour", {{4, 4}, Format::rgba8}), Usage::colour_target);
            const auto depth =
                pass.write(graph.texture("depth", {{4, 4}, Format::depth32f}), Usage::depth_target);
            pass.run([](Execution&) {});
            return std::pair(colour, depth);
        });
        graph.add("show", [&](Pass& pass) {
            pass.read(drawn.first, Usage::sampled);
            pass.read(drawn.second, Usage::sampled);
            pass.side_effect();
            pass.run([](Execution&) {});
        });
        const GraphPicture picture = read_graph(describe_json(compile(std::move(graph)).take()));

        REQUIRE(picture.passes.size() == 3);
        CHECK(picture.passes[0].name == "count");
        CHECK_FALSE(picture.passes[0].gpu);
        CHECK(picture.passes[1].gpu);
        CHECK(picture.edges == std::vector<GraphEdge>{{0, 1}, {1, 2}});
        REQUIRE(picture.passes[2].reads.size() == 2);
        const GraphResource& colour = picture.resources[picture.passes[2].reads[0]];
        CHECK(colour.name == "colour");
        CHECK(colour.kind == GraphResource::Kind::texture);
        CHECK(picture.resources[picture.passes[1].reads[0]].kind == GraphResource::Kind::value);
    }
}

}  // namespace candela::sandbox
