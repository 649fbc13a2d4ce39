#include "tests/budgets/budget_table.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <cstddef>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string_view>
#include <utility>

namespace candela::budgets {
namespace {

constexpr std::string_view head =
    R"(# What the shaders of the shipped scenes cost on AMD's GPUs, as Mesa's compiler for these says: of each figure the
# worst of the variants. After a + stand the rays that they trace: of mirrors, of shadows, and between VPLs and surfaces.
# budgets_test.cpp compares, and with CANDELA_NEW_BUDGETS=1 writes this file.
#
# waves      that a SIMD holds at a time, of 16 (navi21, gfx1100) or 10 (vega10); with fewer, memory is waited for
# registers  vector registers of a lane
# spilled    registers that are kept in memory for lack of room, vector and scalar
# scratch    bytes of memory of a lane: what is spilled, and arrays
)";
constexpr int row_width = 50;

/// Of the variant that costs as much.
const std::string& variant_with(const std::vector<MeasuredShader>& shaders, const std::string& row,
                                std::size_t gpu, const Figure& figure, std::uint32_t value) {
    return std::ranges::find_if(shaders,
                                [&](const MeasuredShader& shader) {
                                    return shader.row == row && shader.costs.at(gpu).*figure.of == value;
                                })
        ->variant;
}

}  // namespace

BudgetTable read_budgets(const std::filesystem::path& path) {
    std::ifstream file(path);
    BudgetTable table;
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
        std::istringstream words(line);
        std::string name;
        if (line.starts_with("#") || !(words >> name)) continue;
        if (name == "driver") {
            std::getline(words >> std::ws, table.driver);
            continue;
        }
        Costs& costs = table.rows[name];
        for (ShaderCost& cost : costs) {
            for (const Figure& figure : figures) words >> cost.*figure.of;
        }
        if (!words || !(words >> std::ws).eof()) {
            throw std::runtime_error(fmt::format("{}:{}: no line of budgets", path.string(), number));
        }
    }
    return table;
}

void write_budgets(const BudgetTable& table, const std::filesystem::path& path) {
    std::ofstream out(path);
    const auto print_row = [&](const std::string& name, const auto& print_of_gpu) {
        fmt::print(out, "{:{}}", name, row_width);
        for (std::size_t gpu = 0; gpu < gpus.size(); ++gpu) {
            out << "  ";
            print_of_gpu(gpu);
        }
        out << '\n';
    };
    const auto print_figures = [&](const auto& of) {
        for (const Figure& figure : figures)
            fmt::print(out, " {:>{}}", of(figure), std::string_view(figure.name).size());
    };
    fmt::print(out, "{}\ndriver {}\n\n", head, table.driver);
    print_row("# on", [&](std::size_t gpu) { fmt::print(out, "{:>32}", gpus.at(gpu)); });
    print_row("# shader",
              [&](std::size_t) { print_figures([](const Figure& figure) { return figure.name; }); });
    for (const auto& [row, costs] : table.rows) {
        print_row(row, [&, &costs = costs](std::size_t gpu) {
            print_figures([&](const Figure& figure) { return costs.at(gpu).*figure.of; });
        });
    }
}

BudgetTable table_of(const std::vector<MeasuredShader>& shaders, std::string driver) {
    BudgetTable table{.driver = std::move(driver), .rows = {}};
    for (const MeasuredShader& shader : shaders) {
        const auto [row, is_new] = table.rows.emplace(shader.row, shader.costs);
        for (std::size_t gpu = 0; gpu < gpus.size(); ++gpu) {
            row->second.at(gpu) = worst(row->second.at(gpu), shader.costs.at(gpu));
        }
    }
    return table;
}

Differences compare(const std::vector<MeasuredShader>& shaders, const BudgetTable& table) {
    Differences differences;
    const BudgetTable measured = table_of(shaders, table.driver);
    for (const auto& [row, budgets] : table.rows) {
        if (!measured.rows.contains(row))
            differences.faults.push_back(row + ": is in the table, but in no program");
    }
    for (const auto& [row, costs] : measured.rows) {
        const auto budgets = table.rows.find(row);
        if (budgets == table.rows.end()) {
            differences.faults.push_back(row + ": is not in the table");
            continue;
        }
        for (std::size_t gpu = 0; gpu < gpus.size(); ++gpu) {
            for (const Figure& figure : figures) {
                const ShaderCost& cost = costs.at(gpu);
                const ShaderCost& budget = budgets->second.at(gpu);
                if (cost.*figure.of == budget.*figure.of) continue;
                const bool is_worse = figure.is_worse(cost, budget);
                (is_worse ? differences.faults : differences.better)
                    .push_back(fmt::format("{} on {}: {} {} instead of {}, with: {}", row, gpus.at(gpu),
                                           cost.*figure.of, figure.name, budget.*figure.of,
                                           variant_with(shaders, row, gpu, figure, cost.*figure.of)));
            }
        }
    }
    return differences;
}

}  // namespace candela::budgets
