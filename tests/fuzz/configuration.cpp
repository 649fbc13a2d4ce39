// Reading configurations: either valid and written back equal, or refused with errors.

#include <string>
#include <string_view>

#include <candela/configuration.hpp>
#include "tests/fuzz/fuzz.hpp"

using namespace candela;

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view json(reinterpret_cast<const char*>(data), size);
    const ConfigurationResult result = read_configuration(json);
    fuzz::require(result.configuration.has_value() == result.errors.empty(), "a configuration, or errors");
    for (const std::string& error : result.errors) {
        fuzz::require_readable(error);
    }
    if (result.configuration) {
        fuzz::require(validate(*result.configuration).empty(), "what was read is valid");
        const ConfigurationResult again = read_configuration(write_configuration(*result.configuration));
        fuzz::require(again.configuration == result.configuration, "what was written is read back");
    }
    return 0;
}
