#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "tests/budgets/shader_cost.hpp"

namespace candela::budgets {

/// What shaders may cost. A row is a shader file, apart for each set of rays that its variants trace, because
/// these decide most; of each figure it has the worst of the variants.
struct BudgetTable {
    std::string driver;  ///< which decides on the figures
    std::map<std::string, Costs> rows;
    bool operator==(const BudgetTable&) const = default;
};

/// Throws std::runtime_error that names the line if it has another form than those of `write`.
[[nodiscard]] BudgetTable read_budgets(const std::filesystem::path& path);
void write_budgets(const BudgetTable& table, const std::filesystem::path& path);

/// A variant of a shader, as measured.
struct MeasuredShader {
    std::string row;
    std::string variant;  ///< the words that it is compiled with
    Costs costs{};
};

[[nodiscard]] BudgetTable table_of(const std::vector<MeasuredShader>& shaders, std::string driver);

/// How the shaders differ from the table, one per string.
struct Differences {
    std::vector<std::string> faults;  ///< what is worse, and rows that only one of the two has
    std::vector<std::string> better;
};
[[nodiscard]] Differences compare(const std::vector<MeasuredShader>& shaders, const BudgetTable& table);

}  // namespace candela::budgets
