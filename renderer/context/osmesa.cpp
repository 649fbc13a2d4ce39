#include "renderer/context/kinds.hpp"
#include "renderer/context/library.hpp"

// Include after glcorearb.h: the gl.h that osmesa.h includes hides types that glcorearb.h would declare
// later.
#include <GL/osmesa.h>
#include <fmt/format.h>

#include <array>
#include <cstdint>

namespace candela {
namespace {

/// The functions of OSMesa.
struct OsMesa {
    decltype(&OSMesaCreateContextAttribs) create = nullptr;
    decltype(&OSMesaDestroyContext) destroy = nullptr;
    decltype(&OSMesaMakeCurrent) make_current = nullptr;
    decltype(&OSMesaGetCurrentContext) current = nullptr;
    decltype(&OSMesaGetProcAddress) get_proc = nullptr;
};

OsMesa open_osmesa() {
    const Library library{"libOSMesa.so.8", "libOSMesa.so.6"};
    OsMesa api;
    library.find("OSMesaCreateContextAttribs", api.create);
    library.find("OSMesaDestroyContext", api.destroy);
    library.find("OSMesaMakeCurrent", api.make_current);
    library.find("OSMesaGetCurrentContext", api.current);
    library.find("OSMesaGetProcAddress", api.get_proc);
    return api;
}

class OsMesaContext final : public HeadlessContext {
 public:
    OsMesaContext() : api_(open_osmesa()) {
        constexpr std::array attributes = {OSMESA_FORMAT,
                                           OSMESA_RGBA,
                                           OSMESA_CONTEXT_MAJOR_VERSION,
                                           4,
                                           OSMESA_CONTEXT_MINOR_VERSION,
                                           5,
                                           OSMESA_PROFILE,
                                           OSMESA_CORE_PROFILE,
                                           0};
        context_ = api_.create(attributes.data(), nullptr);
        if (!context_) throw ContextError("it offers no OpenGL 4.5 core context");
    }
    OsMesaContext(const OsMesaContext&) = delete;
    OsMesaContext& operator=(const OsMesaContext&) = delete;
    ~OsMesaContext() override {
        if (api_.current() == context_) api_.make_current(nullptr, nullptr, 0, 0, 0);
        api_.destroy(context_);
    }

    void make_current() override {
        if (!api_.make_current(context_, picture_.data(), GL_UNSIGNED_BYTE, side, side)) {
            throw ContextError("OSMesa: the context cannot be made current");
        }
    }
    [[nodiscard]] gl::GetProc get_proc() const override { return api_.get_proc; }
    [[nodiscard]] std::string description() const override { return "OSMesa"; }

 private:
    // OSMesa requires memory for a default framebuffer; nothing is drawn into it.
    static constexpr int side = 4;
    static constexpr std::size_t pixels = 16;

    OsMesa api_;
    OSMesaContext context_ = nullptr;
    std::array<std::uint32_t, pixels> picture_{};
};

}  // namespace

std::unique_ptr<HeadlessContext> create_osmesa_context(const ContextOptions&) {
    try {
        return std::make_unique<OsMesaContext>();
    } catch (const ContextError& error) {
        throw ContextError(fmt::format("no OSMesa context: {}", error.what()));
    }
}

bool has_osmesa() {
    return true;
}

}  // namespace candela
