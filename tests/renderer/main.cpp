#include <cstdio>
#include <string_view>
#include <vector>

#include "tests/renderer/context_fixture.hpp"
#include "tests/run_tests.hpp"

/// Like tests/main.cpp, with two more options: `--context=egl|osmesa` (default: egl), and `--verify` for
/// renderers that run clean passes again and compare their results.
int main(int argc, char** argv) {
    constexpr std::string_view option = "--context=";
    std::vector<char*> others;
    for (int i = 0; i < argc; ++i) {
        const std::string_view argument = argv[i];
        if (argument == "--verify") {
            candela::set_tests_verify(true);
            continue;
        }
        if (!argument.starts_with(option)) {
            others.push_back(argv[i]);
            continue;
        }
        const std::string_view kind = argument.substr(option.size());
        if (kind != "egl" && kind != "osmesa") {
            std::fprintf(stderr, "%s: the contexts are egl and osmesa\n", argv[i]);
            return 2;
        }
        candela::set_tested_context(kind == "egl" ? candela::ContextKind::egl : candela::ContextKind::osmesa);
    }
    return candela::run_tests(static_cast<int>(others.size()), others.data());
}
