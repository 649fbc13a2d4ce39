# cmake -D OUTPUT=FILE.cpp -P embed.cmake SHADER...
#
# Writes candela::gl::embedded_shaders(), which renderer/gl/shader_source.hpp declares: every shader's name and text.
# One string literal a line of GLSL keeps within what compilers accept and leaves the generated file readable.

math(EXPR last "${CMAKE_ARGC} - 1")
set(entries "")
set(count 0)
set(first_shader FALSE)
foreach(index RANGE ${last})
    set(argument "${CMAKE_ARGV${index}}")
    if(first_shader)
        cmake_path(RELATIVE_PATH argument BASE_DIRECTORY "${CMAKE_CURRENT_LIST_DIR}" OUTPUT_VARIABLE name)
        file(READ "${argument}" text)
        string(REPLACE "\\" "\\\\" text "${text}")
        string(REPLACE "\"" "\\\"" text "${text}")
        string(REPLACE "\n" "\\n\"\n     \"" text "${text}")
        string(APPEND entries "    {\"${name}\",\n     \"${text}\"},\n")
        math(EXPR count "${count} + 1")
    elseif(argument MATCHES "embed\\.cmake$")
        set(first_shader TRUE)
    endif()
endforeach()

file(WRITE "${OUTPUT}" "// Written by shaders/embed.cmake.

#include <array>

#include \"renderer/gl/shader_source.hpp\"

namespace candela::gl {

namespace {

constexpr std::array<EmbeddedShader, ${count}> shaders{{
${entries}}};

}  // namespace

std::span<const EmbeddedShader> embedded_shaders() { return shaders; }

}  // namespace candela::gl
")
