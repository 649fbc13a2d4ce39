#include <cstdio>
#include <variant>

#include <fmt/format.h>

#include "sandbox/live_reference.hpp"
#include "sandbox/options.hpp"
#include "sandbox/session.hpp"

using namespace candela::sandbox;

int main(int count, char** arguments) {
    const auto parsed = parse_options(count, arguments);
    if (const auto* exit = std::get_if<EarlyExit>(&parsed)) {
        fmt::print(exit->status == 0 ? stdout : stderr, "{}", exit->text);
        return exit->status;
    }
    return run(std::get<Options>(parsed), make_live_reference);
}
