#include "tests/renderer/shader_rules.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <set>

namespace candela {
namespace {

using Tokens = std::vector<std::string>;

bool is_word(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.';
}

/// Words, numbers and single other characters; calls with their parenthesis: `sin(`. Without directives of
/// the preprocessor.
Tokens tokens_of(std::string_view text) {
    Tokens tokens;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t end = at + 1;
        if (text[at] == '#') {
            end = std::min(text.find('\n', at), text.size());
        } else if (is_word(text[at])) {
            while (end < text.size() && is_word(text[end])) ++end;
            const std::size_t next = std::min(text.find_first_not_of(" \n", end), text.size());
            const bool calls = next < text.size() && text[next] == '(';
            tokens.push_back(std::string(text.substr(at, end - at)) + (calls ? "(" : ""));
            if (calls) end = next + 1;
        } else if (std::isspace(static_cast<unsigned char>(text[at])) == 0) {
            tokens.emplace_back(1, text[at]);
        }
        at = end;
    }
    return tokens;
}

/// The bodies of the functions, by name; those of one name are joined.
std::map<std::string, Tokens> functions_of(const Tokens& tokens) {
    std::map<std::string, Tokens> functions;
    int depth = 0;
    std::string name;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        if (tokens[i] == "}") --depth;
        if (depth == 0 && tokens[i].ends_with("(")) name = tokens[i];
        if (depth == 0 && tokens[i] == ";") name.clear();
        if (depth > 0 && !name.empty()) functions[name].push_back(tokens[i]);
        if (tokens[i] == "{") ++depth;
    }
    return functions;
}

/// These words, and the functions that use one of them, also through others.
std::set<std::string> users_of(std::set<std::string> words, const std::map<std::string, Tokens>& functions) {
    for (bool grows = true; grows;) {
        grows = false;
        for (const auto& [name, body] : functions) {
            const bool uses =
                std::ranges::any_of(body, [&](const auto& token) { return words.contains(token); });
            grows |= uses && words.insert(name).second;
        }
    }
    return words;
}

/// Whether a fetch comes after the end of a statement in which invocations leave. A `return` ends those of
/// main that take it, and elsewhere skips the rest of the function.
bool fetches_after_leaving(const Tokens& body, const std::set<std::string>& fetches,
                           const std::set<std::string>& leaves) {
    bool leaving = false;
    bool left = false;
    for (const std::string& token : body) {
        if (left && fetches.contains(token)) return true;
        leaving |= leaves.contains(token);
        left |= leaving && token == ";";
    }
    return false;
}

bool is_zero(const std::string& token) {
    return token.find_first_of("0") == 0 && token.find_first_not_of("0.") == std::string::npos;
}

bool is_one_of(const std::string& token, std::string_view characters) {
    return token.size() == 1 && characters.find(token) != std::string_view::npos;
}

bool is_assignment(const Tokens& tokens, std::size_t i) {
    return tokens[i] == "=" && i > 0 && i + 1 < tokens.size() && !is_one_of(tokens[i - 1], "=<>!") &&
           tokens[i + 1] != "=";
}

/// Whether a declarator, a statement, or what follows the parenthesis of a `for`, may end with this token.
bool may_end_statement(const Tokens& tokens, std::size_t i) {
    const bool in_front_of_word = i + 1 < tokens.size() && is_word(tokens[i + 1].front());
    return is_one_of(tokens[i], ";{},") || (tokens[i] == ")" && in_front_of_word);
}

/// Whether a declarator or a statement assigns twice.
bool assigns_again(const Tokens& tokens) {
    bool assigned = false;
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        const bool assigns = is_assignment(tokens, i);
        if (assigned && assigns) return true;
        assigned = (assigned || assigns) && !may_end_statement(tokens, i);
    }
    return false;
}

}  // namespace

std::vector<std::string> ambiguities(std::string_view shader) {
    std::vector<std::string> faults;
    const Tokens tokens = tokens_of(shader);
    const std::map<std::string, Tokens> functions = functions_of(tokens);
    const std::set<std::string> fetches =
        users_of({"texture(", "textureOffset(", "textureProj(", "dFdx(", "dFdy(", "fwidth("}, functions);
    std::set<std::string> leaves = users_of({"discard"}, functions);
    leaves.merge(std::set<std::string>{"return", "return("});
    for (const auto& [name, body] : functions) {
        if (fetches_after_leaving(body, fetches, leaves)) faults.push_back(name + "): a fetch after leaving");
    }
    constexpr std::array<std::string_view, 3> ordered{"memoryBarrierShared(", ")", ";"};
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        if (tokens[i] == "barrier(" &&
            (i < ordered.size() ||
             !std::equal(ordered.begin(), ordered.end(),
                         tokens.begin() + static_cast<std::ptrdiff_t>(i - ordered.size())))) {
            faults.emplace_back("a barrier without memoryBarrierShared");
        }
        if (tokens[i] == "/" && i + 1 < tokens.size() && is_zero(tokens[i + 1])) {
            faults.emplace_back("a division by zero");
        }
    }
    if (assigns_again(tokens)) faults.emplace_back("the value of an assignment is assigned");
    return faults;
}

}  // namespace candela
