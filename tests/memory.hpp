#pragma once

#include <unistd.h>

#include <cstdint>
#include <fstream>

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

/// Resident memory of this process, bytes.
inline std::uint64_t resident_bytes() {
    std::uint64_t total = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> total >> resident;
    return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

}  // namespace candela::test
