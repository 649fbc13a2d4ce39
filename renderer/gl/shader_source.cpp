#include "renderer/gl/shader_source.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <system_error>
#include <utility>

namespace candela::gl {
namespace {

// Each of these functions removes something from the front of `text`, or returns false if it is not there.

bool take(std::string_view& text, std::string_view literal) {
    if (!text.starts_with(literal)) return false;
    text.remove_prefix(literal.size());
    return true;
}

bool take_number(std::string_view& text, std::size_t& number) {
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc()) return false;
    text.remove_prefix(static_cast<std::size_t>(end - text.data()));
    return true;
}

bool take_blanks(std::string_view& text) {
    text.remove_prefix(std::min(text.find_first_not_of(" \t"), text.size()));
    return true;
}

/// The file that an #include line names; none for other lines.
std::optional<std::string> included_file(std::string_view line) {
    const bool is_include = take_blanks(line) && take(line, "#") && take_blanks(line) &&
                            take(line, "include") && take_blanks(line) && take(line, "\"");
    const std::size_t end = line.find('"');
    if (!is_include || end == std::string_view::npos) return std::nullopt;
    return std::string(line.substr(0, end));
}

/// A driver's message: the number of the file, the line, and the text.
struct Remark {
    std::size_t file = 0;
    std::size_t line = 0;
    std::string_view words;
};

std::optional<Remark> read_mesa(std::string_view text) {
    Remark remark;
    std::size_t column = 0;
    if (!take_number(text, remark.file) || !take(text, ":") || !take_number(text, remark.line)) {
        return std::nullopt;
    }
    if (!take(text, "(") || !take_number(text, column) || !take(text, "): ")) return std::nullopt;
    remark.words = text;
    return remark;
}

std::optional<Remark> read_nvidia(std::string_view text) {
    Remark remark;
    if (!take_number(text, remark.file) || !take(text, "(") || !take_number(text, remark.line))
        return std::nullopt;
    if (!take(text, ") : ")) return std::nullopt;
    remark.words = text;
    return remark;
}

std::string map_line(const std::string& line, std::span<const std::string> files) {
    std::optional<Remark> remark = read_mesa(line);
    if (!remark) remark = read_nvidia(line);
    if (!remark || remark->file >= files.size()) return line;
    return fmt::format("shaders/{}:{}: {}", files[remark->file], remark->line, remark->words);
}

class Assembler {
 public:
    /// `numbers_lines`: with #line directives.
    Assembler(const ShaderLibrary& library, bool numbers_lines)
        : library_(library), numbers_lines_(numbers_lines) {}

    /// Appends a file; each file that it includes takes the place of its #include line.
    void append(const std::string& name) {
        const std::size_t number = source_.files.size();
        source_.files.push_back(name);
        open_.push_back(name);
        std::istringstream text(library_.load(name));
        begin_line(1, number);
        std::string line;
        for (std::size_t n = 1; std::getline(text, line); ++n) {
            if (const auto file = included_file(line)) {
                include(*file, fmt::format("shaders/{}:{}", name, n));
                begin_line(n + 1, number);
            } else {
                source_.text += line + '\n';
            }
        }
        open_.pop_back();
    }

    void prologue(std::string_view text) { source_.text += text; }
    void define(std::span<const Define> defines) {
        for (const Define& define : defines) {
            prologue(fmt::format("#define {} {}\n", define.name, define.value));
        }
    }

    [[nodiscard]] ShaderSource take() { return std::move(source_); }

 private:
    void include(const std::string& file, const std::string& where) {
        if (std::find(open_.begin(), open_.end(), file) != open_.end()) {
            throw ProgramError(fmt::format("{}: \"{}\" includes itself: {} -> {}", where, file,
                                           fmt::join(open_, " -> "), file));
        }
        if (std::find(source_.files.begin(), source_.files.end(), file) != source_.files.end()) return;
        if (!library_.contains(file)) {
            throw ProgramError(fmt::format("{}: there is no shader file \"{}\" to include", where, file));
        }
        append(file);
    }

    void begin_line(std::size_t line, std::size_t file) {
        if (numbers_lines_) source_.text += fmt::format("#line {} {}\n", line, file);
    }

    const ShaderLibrary& library_;
    bool numbers_lines_;
    ShaderSource source_;
    std::vector<std::string> open_;
};

}  // namespace

bool ShaderLibrary::contains(std::string_view name) const {
    std::error_code ignored;
    if (!directory_.empty()) return std::filesystem::is_regular_file(directory_ / name, ignored);
    return std::any_of(files_.begin(), files_.end(),
                       [&](const EmbeddedShader& file) { return file.name == name; });
}

std::string ShaderLibrary::load(std::string_view name) const {
    if (directory_.empty()) {
        const auto file = std::find_if(files_.begin(), files_.end(), [&](const EmbeddedShader& candidate) {
            return candidate.name == name;
        });
        if (file != files_.end()) return std::string(file->text);
    } else if (contains(name)) {
        std::ifstream file(directory_ / name, std::ios::binary);
        std::string text{std::istreambuf_iterator<char>(file), {}};
        if (file) return text;
    }
    throw ProgramError(fmt::format("shaders/{}: there is no such shader file", name));
}

ShaderSource assemble(const ShaderLibrary& library, std::string_view name, std::span<const Define> defines) {
    Assembler assembler(library, true);
    assembler.prologue("#version 450 core\n");
    assembler.define(defines);
    assembler.append(std::string(name));
    return assembler.take();
}

std::string assemble_part(const ShaderLibrary& library, std::string_view name,
                          std::span<const Define> defines) {
    Assembler assembler(library, false);
    assembler.define(defines);
    assembler.append(std::string(name));
    return assembler.take().text;
}

std::string map_log(std::string_view log, std::span<const std::string> files) {
    std::istringstream lines{std::string(log)};
    std::string mapped;
    for (std::string line; std::getline(lines, line);) mapped += map_line(line, files) + '\n';
    return mapped;
}

}  // namespace candela::gl
