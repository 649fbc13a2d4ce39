#include <doctest/doctest.h>

#include "tests/seed.hpp"

int main(int argc, char** argv) {
    if (!candela::take_test_seed()) return 2;
    return doctest::Context(argc, argv).run();
}
