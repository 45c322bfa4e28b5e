#include "apps/machine/retain_json.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>
#include <vector>

#include <fmt/format.h>

#include "runtime/retain/kept_text.hpp"
#include "runtime/retain/value_type.hpp"

namespace taktwerk::apps {

namespace {

using Json = nlohmann::ordered_json;
using namespace runtime;

std::string text_at(const Json& one, const char* key) {
    return one.contains(key) && one[key].is_string() ? one[key].get<std::string>() : std::string{};
}

/// Starts without anybody who claimed it; 0 where nothing is said.
std::string read_unclaimed(const Json& one, Unclaimed& unclaimed) {
    const auto found = one.find("unclaimed");
    if (found == one.end()) return {};
    if (!found->is_number_unsigned() || found->get<std::uint64_t>() > std::numeric_limits<Unclaimed>::max())
        return "\"unclaimed\" is no number of starts";
    unclaimed = found->get<Unclaimed>();
    return {};
}

/// What stands in the file of kept values as it is: a space or line break in it would be another entry.
bool is_type_name(std::string_view text) {
    return !text.empty() && std::all_of(text.begin(), text.end(), [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
    });
}

/// Says where a file is wrong.
class Reading {
public:
    explicit Reading(const std::string& file) : file_(file) {}

    [[nodiscard]] Error wrong(const std::string& where, const std::string& what) const {
        return {"retain.import", file_, fmt::format("{}: {}", where, what), "compare with what `taktwerk retain export` writes"};
    }
    template <class T, class Read>
    std::optional<Error> list(const Json& all, const char* key, std::vector<T>& out, Read read) const {
        if (!all.contains(key)) return std::nullopt;
        if (!all[key].is_array()) return wrong(key, "it is no list");
        for (std::size_t i = 0; i < all[key].size(); ++i) {
            const Json& one = all[key][i];
            const auto where = fmt::format("{}[{}]", key, i);
            if (!one.is_object()) return wrong(where, "it is no object");
            T item;
            item.name = text_at(one, "name");
            if (item.name.empty()) return wrong(where, "it has no \"name\"");
            if (auto why = read(one, item); !why.empty()) return wrong(fmt::format("{} '{}'", where, item.name), why);
            if (auto why = read_unclaimed(one, item.unclaimed); !why.empty()) return wrong(fmt::format("{} '{}'", where, item.name), why);
            out.push_back(std::move(item));
        }
        std::vector<std::string_view> names;
        for (const auto& item : out) names.push_back(item.name);
        std::sort(names.begin(), names.end());
        if (const auto twice = std::adjacent_find(names.begin(), names.end()); twice != names.end())
            return wrong(key, fmt::format("'{}' stands in it twice", *twice));
        if (out.size() > most_kept_items)
            return wrong(key, fmt::format("it has {} entries, and at most {} are kept", out.size(), most_kept_items));
        return std::nullopt;
    }

private:
    const std::string& file_;
};

std::string read_kind(const Json& one, RetainKind& kind) {
    const auto found = find_retain_kind(text_at(one, "kind"));
    if (!found) return R"("kind" is neither "retain" nor "persistent")";
    kind = *found;
    return {};
}

std::string read_value(const Json& one, KeptValue& value) {
    if (auto why = read_kind(one, value.kind); !why.empty()) return why;
    const auto type = find_type(text_at(one, "type"));
    if (!type) return fmt::format("\"type\" is no type that is kept: '{}'", text_at(one, "type"));
    value.type = *type;
    const auto bits = bits_of(*type, text_at(one, "value"));
    if (!bits) return fmt::format("\"value\" is no {} as text: '{}'", word(*type), text_at(one, "value"));
    value.bits = bits_of(*type, text_of(*type, *bits)).value_or(*bits);  // of what is no number only that it is none
    return {};
}

std::string read_block(const Json& one, KeptBlock& block) {
    if (auto why = read_kind(one, block.kind); !why.empty()) return why;
    block.type = text_at(one, "type");
    if (!is_type_name(block.type)) return "\"type\" is no name of a block's type";
    const auto layout = text_at(one, "layout"), bytes = text_at(one, "bytes");
    const auto [end, error] = std::from_chars(layout.data(), layout.data() + layout.size(), block.layout, 16);
    if (layout.empty() || error != std::errc{} || end != layout.data() + layout.size()) return "\"layout\" is no hexadecimal number";
    auto read = bytes_of_hex(bytes);
    if (!read) return "\"bytes\" are no hexadecimal bytes of a block";
    block.bytes = std::move(*read);
    return {};
}

std::string read_parameter(const Json& one, KeptParameter& parameter) {
    for (auto [key, to] : {std::pair{"value", &parameter.value}, std::pair{"configured", &parameter.configured}}) {
        if (!one.contains(key) || !one[key].is_number()) return fmt::format("\"{}\" is no number", key);
        *to = one[key].get<double>();
        if (!std::isfinite(*to)) return fmt::format("\"{}\" is too large", key);
    }
    return {};
}

}  // namespace

Json json_of(const Kept& kept) {
    Json out{{"taktwerk_retain", 1}, {"number", kept.number}};
    auto& values = out["values"] = Json::array();
    for (const auto& value : kept.values) {  // text, so that no reader rounds what is no double
        values.push_back(
            {{"name", value.name}, {"kind", word(value.kind)}, {"type", word(value.type)}, {"value", text_of(value.type, value.bits)}});
        if (value.unclaimed > 0) values.back()["unclaimed"] = value.unclaimed;
    }
    auto& parameters = out["parameters"] = Json::array();
    for (const auto& parameter : kept.parameters) {
        parameters.push_back({{"name", parameter.name}, {"value", parameter.value}, {"configured", parameter.configured}});
        if (parameter.unclaimed > 0) parameters.back()["unclaimed"] = parameter.unclaimed;
    }
    auto& blocks = out["blocks"] = Json::array();
    for (const auto& block : kept.blocks) {
        blocks.push_back({{"name", block.name},
                          {"kind", word(block.kind)},
                          {"type", block.type},
                          {"layout", fmt::format("{:016x}", block.layout)},
                          {"bytes", hex_of(block.bytes)}});
        if (block.unclaimed > 0) blocks.back()["unclaimed"] = block.unclaimed;
    }
    auto& axes = out["axes"] = Json::array();  // for people alone: a position belongs to one encoder, and is not taken back from a file
    for (const auto& axis : kept.axes)
        axes.push_back({{"name", axis.name},
                        {"homed", axis.position.homed},
                        {"shift", axis.position.shift},
                        {"counts", axis.position.counts},
                        {"at_rest", axis.position.at_rest}});
    return out;
}

Result<Kept> kept_of_json(const std::string& file, const std::string& text) {
    const Reading reading(file);
    const auto all = Json::parse(text, nullptr, false);
    if (all.is_discarded()) return reading.wrong("the file", "it is not JSON");
    if (!all.is_object() || !all.contains("taktwerk_retain"))
        return reading.wrong("the file", "it has no \"taktwerk_retain\": it is none of these exports");
    if (all["taktwerk_retain"] != 1) return reading.wrong("taktwerk_retain", "this version reads 1");
    Kept out;
    if (auto error = reading.list(all, "values", out.values, read_value)) return *error;
    if (auto error = reading.list(all, "blocks", out.blocks, read_block)) return *error;
    if (auto error = reading.list(all, "parameters", out.parameters, read_parameter)) return *error;
    out.number = 1;
    // The very same comes back, and nothing beside it.
    const auto again = kept_of(text_of(out));
    if (!again || again->values != out.values || again->blocks != out.blocks || again->parameters != out.parameters || !again->axes.empty())
        return reading.wrong("the file", "it holds what cannot be kept");
    return out;
}

}  // namespace taktwerk::apps
