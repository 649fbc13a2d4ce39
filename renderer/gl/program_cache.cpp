#include "renderer/gl/program_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <optional>
#include <random>
#include <string_view>
#include <system_error>
#include <utility>

namespace candela::gl {
namespace {

namespace fs = std::filesystem;

/// What a file begins with. The driver's binary follows.
struct Header {
    std::array<char, 8> mark{'c', 'a', 'n', 'd', 'e', 'l', 'a', '1'};  // with the version of this layout
    std::array<std::uint64_t, 2> key{};
    std::uint64_t checksum = 0;  // of the binary
    std::uint64_t size = 0;      // of the binary, bytes
    std::uint32_t format = 0;
    std::uint32_t padding = 0;  // so that no byte of the file is undefined
};
static_assert(sizeof(Header) == 48);

/// FNV-1a, 64 bits: http://www.isthe.com/chongo/tech/comp/fnv/
class Hash {
 public:
    explicit Hash(std::uint64_t start = 0) { add(start); }

    void add(std::string_view text) {
        for (const char each : text) {
            value_ = (value_ ^ static_cast<unsigned char>(each)) * 0x100000001B3;
        }
    }
    void add(std::uint64_t number) {
        std::array<char, sizeof(number)> bytes{};
        std::memcpy(bytes.data(), &number, sizeof(number));
        add(std::string_view(bytes.data(), bytes.size()));
    }
    [[nodiscard]] std::uint64_t value() const { return value_; }

 private:
    std::uint64_t value_ = 0xCBF29CE484222325;
};

std::uint64_t checksum_of(std::span<const char> binary) {
    Hash hash;
    hash.add(std::string_view(binary.data(), binary.size()));
    return hash.value();
}

std::vector<GLenum> formats_of(const Functions& gl) {
    std::vector<GLint> numbers(get_unsigned(gl, GL_NUM_PROGRAM_BINARY_FORMATS));
    if (!numbers.empty()) gl.GetIntegerv(GL_PROGRAM_BINARY_FORMATS, numbers.data());
    return {numbers.begin(), numbers.end()};
}

struct Binary {
    Header header;
    std::vector<char> bytes;
};

/// None if the file is missing, cut short or too long. Its content may still be damaged.
std::optional<Binary> read_file(const fs::path& path) {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(path, error);
    Binary read;
    std::ifstream file(path, std::ios::binary);
    if (error || !file.read(reinterpret_cast<char*>(&read.header), sizeof(Header))) return std::nullopt;
    if (size - sizeof(Header) != read.header.size) return std::nullopt;
    read.bytes.resize(static_cast<std::size_t>(read.header.size));
    if (!file.read(read.bytes.data(), static_cast<std::streamsize>(read.bytes.size()))) return std::nullopt;
    return read;
}

/// Throws fs::filesystem_error.
void write_file(const fs::path& path, const Header& header, std::span<const char> binary) {
    std::ofstream file(path, std::ios::binary);
    file.write(reinterpret_cast<const char*>(&header), sizeof(Header));
    file.write(binary.data(), static_cast<std::streamsize>(binary.size()));
    file.close();
    if (!file) {
        throw fs::filesystem_error("cannot write", path, std::make_error_code(std::errc::io_error));
    }
}

/// The end of a name that no other process uses.
std::string unique_ending() {
    std::random_device random;
    return fmt::format(".{:08x}{:08x}.part", random(), random());
}

}  // namespace

ProgramCache::ProgramCache(const Device& device, fs::path directory, std::function<void(std::string)> warn)
    : device_(&device),
      directory_(std::move(directory)),
      warn_(std::move(warn)),
      formats_(formats_of(device.gl())),
      writes_(!formats_.empty()) {}

/// Two hashes of the same text that begin differently: that both are equal by chance need not be feared.
ProgramCache::Key ProgramCache::key_of(const ProgramSource& source) const {
    Key key{};
    for (std::size_t i = 0; i < key.size(); ++i) {
        Hash hash(i);
        const auto add = [&](std::string_view text) {
            hash.add(text.size());
            hash.add(text);
        };
        add(device_->vendor());
        add(device_->renderer());
        add(device_->version());
        for (const ProgramStage& stage : source) {
            hash.add(stage.kind);
            add(stage.source.text);
        }
        key[i] = hash.value();
    }
    return key;
}

fs::path ProgramCache::path_of(const Key& key) const {
    return directory_ / fmt::format("{:016x}{:016x}.program", key[0], key[1]);
}

bool ProgramCache::load(GLuint program, const ProgramSource& source) const {
    if (formats_.empty()) return false;
    const Key key = key_of(source);
    const std::optional<Binary> read = read_file(path_of(key));
    if (!read) return false;
    const Header& header = read->header;
    const bool whole = header.mark == Header{}.mark && header.key == key &&
                       header.checksum == checksum_of(read->bytes) &&
                       std::ranges::find(formats_, header.format) != formats_.end();
    if (!whole) return false;
    device_->gl().ProgramBinary(program, header.format, read->bytes.data(),
                                static_cast<GLsizei>(read->bytes.size()));
    return true;
}

void ProgramCache::store(GLuint program, const ProgramSource& source) {
    if (!writes_) return;
    GLint size = 0;
    device_->gl().GetProgramiv(program, GL_PROGRAM_BINARY_LENGTH, &size);
    if (size <= 0) return;
    std::vector<char> binary(static_cast<std::size_t>(size));
    GLsizei written = 0;
    GLenum format = 0;
    device_->gl().GetProgramBinary(program, size, &written, &format, binary.data());
    binary.resize(static_cast<std::size_t>(written));
    try {
        write(key_of(source), format, binary);
    } catch (const fs::filesystem_error& error) {
        writes_ = false;
        warn_(fmt::format("the program cache is not written: {}", error.what()));
    }
}

/// Throws fs::filesystem_error. What another process has written meanwhile is the same.
void ProgramCache::write(const Key& key, GLenum format, std::span<const char> binary) const {
    fs::create_directories(directory_);
    const fs::path path = path_of(key);
    fs::path part = path;
    part += unique_ending();
    const Header header{.key = key, .checksum = checksum_of(binary), .size = binary.size(), .format = format};
    try {
        write_file(part, header, binary);
        fs::rename(part, path);
    } catch (const fs::filesystem_error&) {
        std::error_code ignored;
        fs::remove(part, ignored);
        throw;
    }
}

}  // namespace candela::gl
