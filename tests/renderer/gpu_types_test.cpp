#include <doctest/doctest.h>

#include <fmt/format.h>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "renderer/gl/compiling_program.hpp"
#include "renderer/gpu/gpu_types.hpp"
#include "renderer/passes/inspect/element_fields.hpp"
#include "tests/renderer/context_fixture.hpp"

TEST_SUITE("gpu types") {

using namespace candela;

namespace {

struct Member {
    std::string name;
    std::size_t offset;
};

/// The layout that C++ gives a struct of shaders/types.glsl.
struct Layout {
    std::string name;
    std::size_t stride;
    std::vector<Member> members;
};

#define MEMBER(type, name)               \
    Member {                             \
#name, offsetof(gpu::type, name) \
    }

const std::vector<Layout>& layouts() {
    static const std::vector<Layout> all = {
        {"Instance",
         sizeof(gpu::Instance),
         {{"world[0]", offsetof(gpu::Instance, world)},
          MEMBER(Instance, material),
          MEMBER(Instance, pad0),
          MEMBER(Instance, pad1),
          MEMBER(Instance, pad2)}},
        {"Material",
         sizeof(gpu::Material),
         {MEMBER(Material, base_colour),
          MEMBER(Material, first_texel),
          MEMBER(Material, texel_width),
          MEMBER(Material, texel_height),
          MEMBER(Material, flags),
          MEMBER(Material, alpha_cutoff),
          MEMBER(Material, first_emissive_texel),
          MEMBER(Material, emissive_width),
          MEMBER(Material, emissive_height),
          MEMBER(Material, emissive),
          MEMBER(Material, metalness),
          MEMBER(Material, mirror),
          MEMBER(Material, traced_mirror),
          MEMBER(Material, traced_share),
          MEMBER(Material, roughness),
          MEMBER(Material, normal_scale),
          MEMBER(Material, occlusion_strength),
          MEMBER(Material, mean_gloss),
          MEMBER(Material, first_normal_texel),
          MEMBER(Material, normal_width),
          MEMBER(Material, normal_height),
          MEMBER(Material, transmission)}},
        {"Light",
         sizeof(gpu::Light),
         {MEMBER(Light, position), MEMBER(Light, kind), MEMBER(Light, direction), MEMBER(Light, range),
          MEMBER(Light, intensity), MEMBER(Light, cos_outer), MEMBER(Light, shape), MEMBER(Light, pad0),
          MEMBER(Light, pad1)}},
        {"LightConstants",
         sizeof(gpu::LightConstants),
         {MEMBER(LightConstants, count), MEMBER(LightConstants, pad0), MEMBER(LightConstants, pad1),
          MEMBER(LightConstants, pad2)}},
        {"Shadow",
         sizeof(gpu::Shadow),
         {MEMBER(Shadow, from_world), MEMBER(Shadow, depth_scale), MEMBER(Shadow, layer),
          MEMBER(Shadow, kind), MEMBER(Shadow, ray_offset)}},
        {"ViewConstants",
         sizeof(gpu::ViewConstants),
         {MEMBER(ViewConstants, clip_from_world), MEMBER(ViewConstants, world_from_clip),
          MEMBER(ViewConstants, view_from_world), MEMBER(ViewConstants, target_size),
          MEMBER(ViewConstants, ray_scale), MEMBER(ViewConstants, ray_shift),
          MEMBER(ViewConstants, depth_terms), MEMBER(ViewConstants, orthographic),
          MEMBER(ViewConstants, pad0), MEMBER(ViewConstants, pad1), MEMBER(ViewConstants, pad2)}},
        {"CellConstants",
         sizeof(gpu::CellConstants),
         {MEMBER(CellConstants, tiles), MEMBER(CellConstants, target_size), MEMBER(CellConstants, slices),
          MEMBER(CellConstants, tile_size), MEMBER(CellConstants, first_depth),
          MEMBER(CellConstants, depth_ratio)}},
        {"TileDepth",
         sizeof(gpu::TileDepth),
         {MEMBER(TileDepth, nearest), MEMBER(TileDepth, farthest), MEMBER(TileDepth, mask),
          MEMBER(TileDepth, pad0)}},
        {"TracedVpl",
         sizeof(gpu::TracedVpl),
         {MEMBER(TracedVpl, position), MEMBER(TracedVpl, state), MEMBER(TracedVpl, normal),
          MEMBER(TracedVpl, radius2), MEMBER(TracedVpl, flux), MEMBER(TracedVpl, pad0),
          MEMBER(TracedVpl, edges_up), MEMBER(TracedVpl, pad1), MEMBER(TracedVpl, edges_down),
          MEMBER(TracedVpl, pad2)}},
        {"Surfel",
         sizeof(gpu::Surfel),
         {MEMBER(Surfel, position), MEMBER(Surfel, first_point), MEMBER(Surfel, normal),
          MEMBER(Surfel, point_count), MEMBER(Surfel, area), MEMBER(Surfel, width2), MEMBER(Surfel, map),
          MEMBER(Surfel, seed), MEMBER(Surfel, own), MEMBER(Surfel, pad0), MEMBER(Surfel, pad1),
          MEMBER(Surfel, pad2)}},
        {"LitSurfel",
         sizeof(gpu::LitSurfel),
         {MEMBER(LitSurfel, position), MEMBER(LitSurfel, first_point), MEMBER(LitSurfel, normal),
          MEMBER(LitSurfel, point_count), MEMBER(LitSurfel, centre), MEMBER(LitSurfel, radius2),
          MEMBER(LitSurfel, flux), MEMBER(LitSurfel, area), MEMBER(LitSurfel, width2), MEMBER(LitSurfel, map),
          MEMBER(LitSurfel, pad0), MEMBER(LitSurfel, pad1)}},
        {"LitEmitter",
         sizeof(gpu::LitEmitter),
         {MEMBER(LitEmitter, position), MEMBER(LitEmitter, first_point), MEMBER(LitEmitter, normal),
          MEMBER(LitEmitter, point_count), MEMBER(LitEmitter, flux), MEMBER(LitEmitter, area)}},
        {"LightReceiver",
         sizeof(gpu::LightReceiver),
         {MEMBER(LightReceiver, position), MEMBER(LightReceiver, pad0), MEMBER(LightReceiver, normal),
          MEMBER(LightReceiver, pad1)}},
        {"SkyPatch",
         sizeof(gpu::SkyPatch),
         {MEMBER(SkyPatch, direction), MEMBER(SkyPatch, half_width2), MEMBER(SkyPatch, light),
          MEMBER(SkyPatch, pad0)}},
        {"CellPoint",
         sizeof(gpu::CellPoint),
         {MEMBER(CellPoint, position), MEMBER(CellPoint, material), MEMBER(CellPoint, normal),
          MEMBER(CellPoint, area), MEMBER(CellPoint, uv), MEMBER(CellPoint, surfel),
          MEMBER(CellPoint, colour), MEMBER(CellPoint, middle), MEMBER(CellPoint, pad0)}},
        {"LitPoint",
         sizeof(gpu::LitPoint),
         {MEMBER(LitPoint, position), MEMBER(LitPoint, area), MEMBER(LitPoint, normal),
          MEMBER(LitPoint, pad0), MEMBER(LitPoint, flux), MEMBER(LitPoint, pad1)}},
        {"DirectPoint",
         sizeof(gpu::DirectPoint),
         {MEMBER(DirectPoint, arriving), MEMBER(DirectPoint, pad0), MEMBER(DirectPoint, albedo),
          MEMBER(DirectPoint, pad1), MEMBER(DirectPoint, emitted), MEMBER(DirectPoint, pad2),
          MEMBER(DirectPoint, from_emitters), MEMBER(DirectPoint, pad3)}},
        {"CellLight",
         sizeof(gpu::CellLight),
         {MEMBER(CellLight, centre), MEMBER(CellLight, radius2), MEMBER(CellLight, arriving),
          MEMBER(CellLight, pad2), MEMBER(CellLight, direct), MEMBER(CellLight, pad0),
          MEMBER(CellLight, emitted), MEMBER(CellLight, pad3), MEMBER(CellLight, from_emitters),
          MEMBER(CellLight, pad4), MEMBER(CellLight, albedo), MEMBER(CellLight, area),
          MEMBER(CellLight, indirect), MEMBER(CellLight, pad1)}},
        {"VplConstants",
         sizeof(gpu::VplConstants),
         {MEMBER(VplConstants, count), MEMBER(VplConstants, first_emitter),
          MEMBER(VplConstants, first_sky_patch), MEMBER(VplConstants, ray_offset),
          MEMBER(VplConstants, map_resolution), MEMBER(VplConstants, map_tiles),
          MEMBER(VplConstants, map_side), MEMBER(VplConstants, map_near), MEMBER(VplConstants, foci),
          MEMBER(VplConstants, mapped), MEMBER(VplConstants, first_direction),
          MEMBER(VplConstants, mean_record), MEMBER(VplConstants, pad0)}},
        {"WideNode",
         sizeof(gpu::WideNode),
         {MEMBER(WideNode, origin), MEMBER(WideNode, exponents), MEMBER(WideNode, lower),
          MEMBER(WideNode, upper), MEMBER(WideNode, children)}},
        {"ChangedBox",
         sizeof(gpu::ChangedBox),
         {MEMBER(ChangedBox, lower), MEMBER(ChangedBox, next), MEMBER(ChangedBox, upper),
          MEMBER(ChangedBox, pad0)}},
        {"TraceTriangle",
         sizeof(gpu::TraceTriangle),
         {MEMBER(TraceTriangle, a), MEMBER(TraceTriangle, material), MEMBER(TraceTriangle, edge_ab),
          MEMBER(TraceTriangle, id), MEMBER(TraceTriangle, edge_ac), MEMBER(TraceTriangle, colour_a),
          MEMBER(TraceTriangle, uv_a), MEMBER(TraceTriangle, uv_b), MEMBER(TraceTriangle, uv_c),
          MEMBER(TraceTriangle, colour_b), MEMBER(TraceTriangle, colour_c), MEMBER(TraceTriangle, normal_a),
          MEMBER(TraceTriangle, normal_b), MEMBER(TraceTriangle, normal_c), MEMBER(TraceTriangle, second)}},
        {"Path",
         sizeof(gpu::Path),
         {MEMBER(Path, flux), MEMBER(Path, light), MEMBER(Path, index), MEMBER(Path, seed),
          MEMBER(Path, first_vpl), MEMBER(Path, vpl_count)}},
        {"VplRecord",
         sizeof(gpu::VplRecord),
         {MEMBER(VplRecord, position), MEMBER(VplRecord, state), MEMBER(VplRecord, normal),
          MEMBER(VplRecord, pad0), MEMBER(VplRecord, throughput), MEMBER(VplRecord, pad1)}},
        {"FluxAccount",
         sizeof(gpu::FluxAccount),
         {MEMBER(FluxAccount, emitted), MEMBER(FluxAccount, pad0), MEMBER(FluxAccount, absorbed),
          MEMBER(FluxAccount, pad1), MEMBER(FluxAccount, escaped), MEMBER(FluxAccount, pad2),
          MEMBER(FluxAccount, truncated), MEMBER(FluxAccount, pad3), MEMBER(FluxAccount, roulette),
          MEMBER(FluxAccount, pad4), MEMBER(FluxAccount, bounce_groups), MEMBER(FluxAccount, pad5),
          MEMBER(FluxAccount, account_groups), MEMBER(FluxAccount, pad6)}}};
    return all;
}

/// A shader that copies one element over another, so that the compiler cannot remove any member.
std::string copying_shader(const std::string& type) {
    return fmt::format(
        "#include \"types.glsl\"\n"
        "layout(local_size_x = 1) in;\n"
        "layout(std430, binding = 0) buffer Block {{ {} element[]; }};\n"
        "void main() {{ element[0] = element[1]; }}\n",
        type);
}

/// A shader whose uniform block holds one element.
std::string shader_with_constants(const std::string& type) {
    return fmt::format(
        "#include \"types.glsl\"\n"
        "layout(local_size_x = 1) in;\n"
        "layout(std140, binding = 0) uniform Block {{ {0} constants; }};\n"
        "layout(std430, binding = 0) buffer Copy {{ {0} copy; }};\n"
        "void main() {{ copy = constants; }}\n",
        type);
}

/// What the driver reports about members of a program's buffers, or of its uniform blocks.
class BlockMembers {
 public:
    BlockMembers(const gl::Functions& gl, GLuint program, GLenum interface = GL_BUFFER_VARIABLE)
        : gl_(gl), program_(program), interface_(interface) {}

    [[nodiscard]] GLint count() const {
        GLint count = 0;
        gl_.GetProgramInterfaceiv(program_, interface_, GL_ACTIVE_RESOURCES, &count);
        return count;
    }
    /// -1 if there is no such variable.
    [[nodiscard]] GLint get(const std::string& variable, GLenum property) const {
        const GLuint index = gl_.GetProgramResourceIndex(program_, interface_, variable.c_str());
        GLint value = -1;
        if (index == GL_INVALID_INDEX) return value;
        gl_.GetProgramResourceiv(program_, interface_, index, 1, &property, 1, nullptr, &value);
        return value;
    }

 private:
    const gl::Functions& gl_;
    GLuint program_;
    GLenum interface_;
};

gl::Program compile_with_shipped(gl::Device& device, const std::string& compute_shader) {
    const auto shipped = gl::embedded_shaders();
    std::vector<gl::EmbeddedShader> files(shipped.begin(), shipped.end());
    files.push_back({"copy.comp", compute_shader});
    return gl::compile(device, gl::ShaderLibrary(files), {"copy.comp"});
}

}  // namespace

TEST_CASE_FIXTURE(GlFixture, "every struct has the layout in storage buffers that the driver reports") {
    for (const Layout& layout : layouts()) {
        CAPTURE(layout.name);
        const gl::Program program = compile_with_shipped(device, copying_shader(layout.name));
        const BlockMembers variables(device.gl(), program.name());
        CHECK(variables.count() == static_cast<GLint>(layout.members.size()));
        for (const Member& member : layout.members) {
            CAPTURE(member.name);
            const std::string name = "element[0]." + member.name;
            CHECK(variables.get(name, GL_OFFSET) == static_cast<GLint>(member.offset));
            CHECK(variables.get(name, GL_TOP_LEVEL_ARRAY_STRIDE) == static_cast<GLint>(layout.stride));
        }
        if (layout.name == "Instance") {
            CHECK(variables.get("element[0].world[0]", GL_ARRAY_STRIDE) == sizeof(gpu::Instance::world[0]));
        }
        if (layout.name == "Shadow") {
            CHECK(variables.get("element[0].from_world", GL_MATRIX_STRIDE) == sizeof(glm::vec4));
            CHECK(variables.get("element[0].from_world", GL_IS_ROW_MAJOR) == GL_FALSE);
        }
    }
}

TEST_CASE_FIXTURE(GlFixture, "structs in uniform blocks have the same layout as in storage buffers") {
    std::size_t blocks = 0;
    for (const Layout& layout : layouts()) {
        if (!layout.name.ends_with("Constants")) continue;
        CAPTURE(layout.name);
        ++blocks;
        const gl::Program program = compile_with_shipped(device, shader_with_constants(layout.name));
        const BlockMembers members(device.gl(), program.name(), GL_UNIFORM);
        for (const Member& member : layout.members) {
            CAPTURE(member.name);
            CHECK(members.get("constants." + member.name, GL_OFFSET) == static_cast<GLint>(member.offset));
        }
    }
    CHECK(blocks == 4);
}

TEST_CASE_FIXTURE(GlFixture, "every struct of types.glsl is compared") {
    const std::string types = gl::ShaderLibrary(gl::embedded_shaders()).load("types.glsl");
    std::size_t structs = 0;
    for (std::size_t at = types.find("\nstruct "); at != std::string::npos;
         at = types.find("\nstruct ", at + 1)) {
        ++structs;
    }
    CHECK(structs == layouts().size());
}

TEST_CASE("fields of inspected elements are where C++ has the members of the same name") {
    const std::string types = gl::ShaderLibrary(gl::embedded_shaders()).load("types.glsl");
    for (const Layout& layout : layouts()) {
        CAPTURE(layout.name);
        const std::vector<ElementField> fields = fields_of_struct(types, layout.name);
        std::size_t next = 0;
        for (const Member& member : layout.members) {
            if (member.name.starts_with("pad")) continue;
            CAPTURE(member.name);
            REQUIRE(next < fields.size());
            const ElementField& field = fields[next++];
            CHECK(field.name == member.name.substr(0, member.name.find('[')));
            CHECK(field.offset == member.offset);
        }
        CHECK(next == fields.size());
    }
    CHECK(fields_of_struct(types, "NoSuchStruct").empty());
    const std::vector<ElementField> instance = fields_of(typeid(gpu::Instance));
    REQUIRE(instance.size() == 2);
    CHECK(instance[0] == ElementField{"world", NumberType::float32, 12, 0});
    CHECK(instance[1] == ElementField{"material", NumberType::uint32, 1, 48});
}

}  // TEST_SUITE("gpu types")
