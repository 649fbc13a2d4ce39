#pragma once

#include <cstdint>
#include <glm/mat3x3.hpp>
#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <initializer_list>
#include <string_view>
#include <variant>
#include <vector>

namespace candela::gl {

/// The value of a uniform outside of uniform blocks. An array is set from its first element on.
struct Uniform {
    using Value = std::variant<bool, int, std::uint32_t, float, glm::vec2, glm::vec3, glm::vec4, glm::uvec2,
                               glm::mat3, glm::mat4, std::vector<glm::vec4>>;
    std::string_view name;  ///< a literal
    Value value;
};

/// All uniforms of a draw or dispatch: `{{"exposure", 1.0F}, {"count", 3U}}`. Lists are joined by +.
class Uniforms {
 public:
    Uniforms() = default;
    Uniforms(std::initializer_list<Uniform> list) : list_(list) {}

    friend Uniforms operator+(Uniforms a, const Uniforms& b) {
        a.list_.insert(a.list_.end(), b.list_.begin(), b.list_.end());
        return a;
    }
    [[nodiscard]] auto begin() const { return list_.begin(); }
    [[nodiscard]] auto end() const { return list_.end(); }

 private:
    std::vector<Uniform> list_;
};

}  // namespace candela::gl
