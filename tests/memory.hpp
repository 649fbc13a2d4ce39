#pragma once

#include <cstdint>
#include <fstream>
#include <string>

namespace candela::test {

// Whether AddressSanitizer is on. GCC defines the macro, Clang has the feature.
#if defined(__SANITIZE_ADDRESS__)
inline constexpr bool is_sanitized = true;
#elif !defined(__has_feature)
inline constexpr bool is_sanitized = false;
#elif __has_feature(address_sanitizer)
inline constexpr bool is_sanitized = true;
#else
inline constexpr bool is_sanitized = false;
#endif

/// Resident memory of this process, bytes. 0 where the system does not tell, which is all but Linux.
inline std::uint64_t resident_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;) {
        std::uint64_t kibibytes = 0;
        if (word == "VmRSS:" && status >> kibibytes) return kibibytes * 1024;
    }
    return 0;
}

}  // namespace candela::test
