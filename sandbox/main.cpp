#include <cstdio>
#include <variant>

#include <candela/tools/live_reference.hpp>
#include "sandbox/command_line/options.hpp"
#include "sandbox/command_line/run.hpp"

using namespace candela::sandbox;

namespace {

int run_app(int count, char** arguments) {
    const auto parsed = parse_options(count, arguments);
    if (const auto* exit = std::get_if<EarlyExit>(&parsed)) {
        std::fputs(exit->text.c_str(), exit->status == 0 ? stdout : stderr);
        return exit->status;
    }
    return run(std::get<Options>(parsed), candela::tools::make_live_reference);
}

}  // namespace

int main(int count, char** arguments) {
    const int status = run_app(count, arguments);
    const bool is_written = std::fflush(stdout) == 0 && std::ferror(stdout) == 0;
    if (status == success && !is_written) {
        std::fputs("candela: the output cannot be written\n", stderr);
        return bad_input;
    }
    return status;
}
