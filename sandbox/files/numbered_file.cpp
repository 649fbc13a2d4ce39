#include "sandbox/files/numbered_file.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <string>
#include <system_error>

#include <fmt/format.h>

namespace candela::sandbox {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view beginning = "candela-";

/// The number in a name of the kind; 0 if it is another name.
int number_of(std::string_view name, std::string_view ending) {
    if (!name.starts_with(beginning) || !name.ends_with(ending) ||
        name.size() < beginning.size() + ending.size()) {
        return 0;
    }
    name.remove_prefix(beginning.size());
    name.remove_suffix(ending.size());
    int number = 0;
    const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    const bool is_number = error == std::errc() && end == name.data() + name.size();
    return is_number && number < std::numeric_limits<int>::max() ? number : 0;
}

}  // namespace

fs::path next_numbered_file(std::string_view ending, const fs::path& folder) {
    int highest = 0;
    std::error_code ignored;
    for (const fs::directory_entry& file : fs::directory_iterator(folder, ignored)) {
        highest = std::max(highest, number_of(file.path().filename().string(), ending));
    }
    return folder / fmt::format("{}{:03}{}", beginning, highest + 1, ending);
}

}  // namespace candela::sandbox
