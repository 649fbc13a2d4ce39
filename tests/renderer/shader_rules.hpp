#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace candela {

/// What in a preprocessed shader means different things to different drivers: a fetch with implicit
/// derivatives after a statement by which some invocations of a quad leave, a barrier that orders no writes
/// to shared memory, a division by a literal zero, an assignment whose value is assigned again, which reads
/// what may be write-only. Each fault names its function or shows its text.
[[nodiscard]] std::vector<std::string> ambiguities(std::string_view shader);

}  // namespace candela
