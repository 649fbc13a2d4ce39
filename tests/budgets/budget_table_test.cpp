#include <doctest/doctest.h>

#include <cstddef>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/budgets/budget_table.hpp"
#include "tests/sandbox/temporary_folder.hpp"
#include "tests/throws.hpp"

TEST_SUITE("budget table") {

using namespace candela;
using namespace candela::budgets;

namespace {

constexpr ShaderCost cost{.waves = 8, .registers = 64, .spilled = 2, .scratch = 592};

/// A file with two variants, of which the second costs more on one GPU, and another file.
std::vector<MeasuredShader> shaders() {
    Costs more{cost, cost, cost};
    more[1] = {.waves = 6, .registers = 80, .spilled = 2, .scratch = 592};
    return {{"a.comp", "SMALL", {cost, cost, cost}},
            {"a.comp", "LARGE", more},
            {"b.frag", "", {cost, cost, cost}}};
}

}  // namespace

TEST_CASE("a table is read as it was written, and holds what it was made of") {
    const sandbox::TemporaryFolder folder;
    const BudgetTable table = table_of(shaders(), "Mesa 1.2");
    CHECK(table.rows.at("a.comp") == shaders()[1].costs);
    write_budgets(table, folder / "table.txt");
    CHECK(read_budgets(folder / "table.txt") == table);
    CHECK(compare(shaders(), table).faults.empty());
    CHECK(compare(shaders(), table).better.empty());
    std::ofstream(folder / "table.txt", std::ios::app) << "c.comp 1 2 3\n";
    CHECK(throws<std::runtime_error>([&] { static_cast<void>(read_budgets(folder / "table.txt")); },
                                     ": no line of budgets"));
}

TEST_CASE("what is worse is a fault with the variant's words, what is better is none") {
    const BudgetTable table = table_of(shaders(), "");
    const auto differences_with = [&](std::uint32_t ShaderCost::*figure, std::uint32_t value) {
        std::vector<MeasuredShader> changed = shaders();
        changed[1].costs[1].*figure = value;
        return compare(changed, table);
    };
    for (const Figure& figure : figures) {
        const bool more_is_worse = figure.of != &ShaderCost::waves;
        const std::uint32_t budget = table.rows.at("a.comp")[1].*figure.of;
        const Differences more = differences_with(figure.of, budget + 1);
        CHECK(more.faults.size() == (more_is_worse ? 1 : 0));
        CHECK(more.better.size() == (more_is_worse ? 0 : 1));
    }
    CHECK(differences_with(&ShaderCost::scratch, 600).faults.at(0) ==
          "a.comp on gfx1100: 600 scratch instead of 592, with: LARGE");
}

TEST_CASE("a row that only one of both has is a fault") {
    const BudgetTable table = table_of(shaders(), "");
    std::vector<MeasuredShader> fewer = shaders();
    fewer.pop_back();
    CHECK(compare(fewer, table).faults ==
          std::vector<std::string>{"b.frag: is in the table, but in no program"});
    CHECK(compare(shaders(), table_of(fewer, "")).faults ==
          std::vector<std::string>{"b.frag: is not in the table"});
}

}  // TEST_SUITE("budget table")
