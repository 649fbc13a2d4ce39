#pragma once

#include <iostream>
#include <string_view>

namespace candela {

/// Whether `call` throws an Exception whose message contains `part`. Prints a message that does not contain
/// it. Other exceptions propagate. (doctest has its own check for this since version 2.4.9.)
template <class Exception, class Call>
[[nodiscard]] bool throws(Call call, std::string_view part) {
    try {
        call();
    } catch (const Exception& exception) {
        const std::string_view message = exception.what();
        if (message.find(part) != std::string_view::npos) return true;
        std::cerr << "'" << message << "' does not contain '" << part << "'\n";
    }
    return false;
}

}  // namespace candela
