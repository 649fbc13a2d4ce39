#include "engine/json/json.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "engine/readable.hpp"

namespace candela {

namespace {

constexpr std::size_t deepest_nesting = 256;

JsonError error_of(const nlohmann::json::exception& error) {
    const std::string_view message = error.what();
    const std::size_t prefix = message.find("] ");  // [json.exception.parse_error.101]
    std::string fault(message.substr(prefix == std::string_view::npos ? 0 : prefix + 2));
    if (const std::size_t quote = fault.find("; last read: "); quote != std::string::npos) {
        const std::size_t expected = fault.rfind("; expected ");
        fault.erase(quote, expected == std::string::npos || expected < quote ? expected : expected - quote);
    }
    return JsonError("invalid JSON: " + fault);
}

/// Sorts the members by name. Of several with the same name the last counts.
void finish(JsonObject& object) {
    std::vector<JsonMember>& members = object.members;
    std::ranges::stable_sort(members, {}, &JsonMember::name);
    const auto same = [](const JsonMember& a, const JsonMember& b) { return a.name == b.name; };
    const auto unused = std::unique(members.rbegin(), members.rend(), same);
    members.erase(members.begin(), unused.base());
    object.sorted = true;
}

/// The value of an object's member, null where there is none. `Object` is JsonObject, const or not.
template <class Object>
auto* value_in(Object& object, std::string_view name) {
    const auto found = object.sorted ? std::ranges::lower_bound(object.members, name, {}, &JsonMember::name)
                                     : std::ranges::find(object.members, name, &JsonMember::name);
    return found != object.members.end() && found->name == name ? &found->value : nullptr;
}

}  // namespace

/// Makes a value of what the library's parser finds.
class JsonBuilder : public nlohmann::json_sax<nlohmann::json> {
 public:
    Json root;

    bool null() override { return add(nullptr); }
    bool boolean(bool flag) override { return add(flag); }
    bool number_integer(std::int64_t number) override { return add(number); }
    bool number_unsigned(std::uint64_t number) override { return add(number); }
    bool number_float(double number, const std::string& /*text*/) override { return add(number); }
    bool string(std::string& text) override { return add(std::move(text)); }
    bool binary(nlohmann::json::binary_t& /*bytes*/) override { return false; }  // not in texts
    bool key(std::string& name) override {
        name_ = std::move(name);
        return true;
    }
    bool start_object(std::size_t /*size*/) override { return open(Json::object()); }
    bool start_array(std::size_t /*size*/) override { return open(Json::array()); }
    bool end_object() override {
        finish(std::get<JsonObject>(open_.back()->value_));
        return close();
    }
    bool end_array() override { return close(); }
    bool parse_error(std::size_t /*position*/, const std::string& /*token*/,
                     const nlohmann::json::exception& error) override {
        throw error_of(error);
    }

 private:
    bool add(Json value) {
        insert(std::move(value));
        return true;
    }
    bool open(Json value) {
        if (open_.size() == deepest_nesting) throw JsonError("its JSON is nested too deeply");
        open_.push_back(&insert(std::move(value)));
        return true;
    }
    bool close() {
        open_.pop_back();
        return true;
    }
    Json& insert(Json value) {
        if (open_.empty()) return root = std::move(value);
        if (auto* const items = std::get_if<Json::Array>(&open_.back()->value_)) {
            return items->emplace_back(std::move(value));
        }
        auto& object = std::get<JsonObject>(open_.back()->value_);
        return object.members.emplace_back(JsonMember{std::move(name_), std::move(value)}).value;
    }

    std::vector<Json*> open_;  // arrays and objects, the innermost last; none grows while one inside is open
    std::string name_;
};

/// Writes values as text.
class JsonWriter {
 public:
    JsonWriter(int indent, Json::Faulty faulty) : indent_(indent), faulty_(faulty) {}

    std::string text;

    void write(const Json& json) {
        std::visit([this](const auto& value) { write_value(value); }, json.value_);
    }

 private:
    void write_value(std::monostate) { text += "null"; }
    void write_value(bool flag) { text += flag ? "true" : "false"; }
    void write_value(std::int64_t number) { fmt::format_to(std::back_inserter(text), "{}", number); }
    void write_value(std::uint64_t number) { fmt::format_to(std::back_inserter(text), "{}", number); }
    void write_value(double number) {
        if (!std::isfinite(number)) {
            text += "null";
            return;
        }
        const std::string digits = fmt::format("{}", number);
        // A number with a fraction of zero is read back as such.
        text += digits.find_first_of(".e") == std::string::npos ? digits + ".0" : digits;
    }
    void write_value(const std::string& string) {
        text += '"';
        for (std::size_t at = 0; at < string.size();) {
            const std::size_t length = utf8_length(std::string_view(string).substr(at));
            if (length == 0 && faulty_ == Json::Faulty::refused) {
                throw JsonError(fmt::format("not UTF-8: '{}'", readable(string)));
            }
            if (length == 0) {
                text += "\uFFFD";
            } else if (length == 1) {
                write_ascii(string[at]);
            } else {
                text.append(string, at, length);
            }
            at += std::max<std::size_t>(length, 1);
        }
        text += '"';
    }
    void write_ascii(char c) {
        constexpr std::string_view special = "\"\\\b\f\n\r\t";
        constexpr std::string_view letters = "\"\\bfnrt";
        const std::size_t found = special.find(c);
        if (found != std::string_view::npos) {
            text += {'\\', letters[found]};
        } else if (c < ' ') {
            text += fmt::format("\\u{:04x}", c);
        } else {
            text += c;
        }
    }
    void write_value(const Json::Array& items) {
        write_list('[', items, ']', [this](const Json& item) { write(item); });
    }
    void write_value(const JsonObject& object) {
        write_list('{', object.members, '}', [this](const JsonMember& member) {
            write_value(member.name);
            text += indent_ < 0 ? ":" : ": ";
            write(member.value);
        });
    }

    template <class Items, class WriteItem>
    void write_list(char first, const Items& items, char last, WriteItem write_item) {
        text += first;
        ++level_;
        for (const auto& item : items) {
            text += &item == items.data() ? "" : ",";
            break_line();
            write_item(item);
        }
        --level_;
        if (!items.empty()) break_line();
        text += last;
    }

    void break_line() {
        if (indent_ >= 0) {
            text += '\n';
            text.append(static_cast<std::size_t>(indent_) * static_cast<std::size_t>(level_), ' ');
        }
    }

    int indent_;
    Json::Faulty faulty_;
    int level_ = 0;
};

JsonObject::JsonObject() = default;
JsonObject::JsonObject(const JsonObject& other) = default;
JsonObject::JsonObject(JsonObject&& other) noexcept = default;
JsonObject& JsonObject::operator=(const JsonObject& other) = default;
JsonObject& JsonObject::operator=(JsonObject&& other) noexcept = default;
JsonObject::~JsonObject() = default;

Json::Json(std::initializer_list<Json> items) {
    const bool names_all = std::ranges::all_of(
        items, [](const Json& item) { return item.is_array() && item.size() == 2 && item[0].is_string(); });
    if (!names_all) {
        value_ = Array(items);
        return;
    }
    value_ = JsonObject{};
    for (const Json& item : items) {
        (*this)[item[0].text()] = item[1];
    }
}

Json Json::array(std::vector<Json> items) {
    Json json;
    json.value_ = std::move(items);
    return json;
}

Json Json::object() {
    Json json;
    json.value_ = JsonObject{};
    return json;
}

Json Json::parse(std::string_view text) {
    JsonBuilder builder;
    nlohmann::json::sax_parse(text.begin(), text.end(), &builder);
    return std::move(builder.root);
}

std::string Json::dump(int indent, Faulty faulty) const {
    JsonWriter writer(indent, faulty);
    writer.write(*this);
    return std::move(writer.text);
}

double Json::number() const {
    const auto* const real = std::get_if<double>(&value_);
    if (real) return *real;
    return is_not_negative() ? static_cast<double>(std::get<std::uint64_t>(value_))
                             : static_cast<double>(std::get<std::int64_t>(value_));
}

std::span<const Json> Json::items() const {
    const auto* const items = std::get_if<Array>(&value_);
    return items ? std::span(*items) : std::span<const Json>();
}

std::span<Json> Json::items() {
    auto* const items = std::get_if<Array>(&value_);
    return items ? std::span(*items) : std::span<Json>();
}

std::span<const JsonMember> Json::members() const {
    const auto* const object = std::get_if<JsonObject>(&value_);
    return object ? std::span(object->members) : std::span<const JsonMember>();
}

const Json* Json::find(std::string_view name) const {
    const auto* const object = std::get_if<JsonObject>(&value_);
    return object ? value_in(*object, name) : nullptr;
}

const Json* Json::find_path(std::string_view names) const {
    const Json* json = this;
    while (json && !names.empty()) {
        const std::size_t slash = std::min(names.find('/'), names.size());
        json = json->find(names.substr(0, slash));
        names.remove_prefix(std::min(slash + 1, names.size()));
    }
    return json;
}

const Json& Json::at(std::string_view name) const {
    if (const Json* const found = find(name)) return *found;
    throw std::out_of_range(fmt::format("there is no \"{}\"", name));
}

Json& Json::operator[](std::string_view name) {
    if (is_null()) value_ = JsonObject{};
    auto& object = std::get<JsonObject>(value_);
    if (Json* const found = value_in(object, name)) return *found;
    object.sorted = object.sorted && (object.members.empty() || object.members.back().name < name);
    return object.members.emplace_back(JsonMember{std::string(name), Json()}).value;
}

void Json::push_back(Json item) {
    if (is_null()) value_ = Array();
    std::get<Array>(value_).push_back(std::move(item));
}

void Json::erase(std::string_view name) {
    if (auto* const object = std::get_if<JsonObject>(&value_)) {
        std::erase_if(object->members, [name](const JsonMember& member) { return member.name == name; });
    }
}

void Json::update(const Json& other) {
    for (const JsonMember& member : other.members()) {
        (*this)[member.name] = member.value;
    }
}

}  // namespace candela
