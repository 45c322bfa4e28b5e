#include "hmi_bridge/socket/json_fields.hpp"

#include <algorithm>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "core/nearest_name.hpp"

namespace taktwerk::hmi {

Error request_error(std::string code, std::string what, std::string remedy) {
    return {"request." + code, "", std::move(what), std::move(remedy)};
}

std::string shown(std::string_view text) {
    return nlohmann::json(text.substr(0, 64)).dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
}

std::string JsonFields::text(std::string_view key, bool required) {
    const auto* value = find(key, required);
    if (!value) return {};
    if (value->is_string()) return value->get<std::string>();
    return wrong(key, "a text"), std::string{};
}

double JsonFields::number(std::string_view key, bool required) {
    const auto* value = find(key, required);
    if (!value) return 0;
    if (value->is_number()) return value->get<double>();
    if (value->is_boolean() && key == "value") return value->get<bool>() ? 1 : 0;
    return wrong(key, "a number"), 0;
}

bool JsonFields::flag(std::string_view key) {
    const auto* value = find(key, false);
    if (!value) return false;
    if (value->is_boolean()) return value->get<bool>();
    return wrong(key, "true or false"), false;
}

std::optional<std::int64_t> JsonFields::maybe_integer(std::string_view key) {
    const auto* value = find(key, false);
    if (!value) return std::nullopt;
    if (value->is_number_unsigned() && value->get<std::uint64_t>() > INT64_MAX)
        return wrong(key, "a whole number below 2^63"), std::nullopt;
    if (value->is_number_integer()) return value->get<std::int64_t>();
    return wrong(key, "a whole number"), std::nullopt;
}

std::vector<std::string> JsonFields::texts(std::string_view key, std::size_t most) {
    std::vector<std::string> out;
    const auto* value = find(key, true);
    if (!value) return out;
    const auto wanted = fmt::format("a list of 1 to {} texts", most);
    if (!value->is_array() || value->empty() || value->size() > most) return wrong(key, wanted), out;
    for (const auto& text : *value) {
        if (!text.is_string()) return wrong(key, wanted), std::vector<std::string>{};
        out.push_back(text.get<std::string>());
    }
    return out;
}

std::optional<std::uint64_t> JsonFields::maybe_count(std::string_view key) {
    const auto number = maybe_integer(key);
    if (number && *number < 0) return wrong(key, "a whole number of 0 or more"), std::nullopt;
    return number ? std::optional{static_cast<std::uint64_t>(*number)} : std::nullopt;
}

const nlohmann::json* JsonFields::object(std::string_view key, bool required) {
    const auto* value = find(key, required);
    if (value && !value->is_object()) return wrong(key, "an object"), nullptr;
    return value;
}

void JsonFields::finish() {
    for (const auto& [key, value] : json_.items()) {
        if (error_ || std::find(known_.begin(), known_.end(), key) != known_.end()) continue;
        const auto near = nearest_name(std::string_view(key).substr(0, 64), known_);
        error_ =
            request_error("unknown_key", fmt::format("this command knows no key {}", shown(key)),
                          near.empty() ? fmt::format("It knows: {}.", fmt::join(known_, ", ")) : fmt::format("Did you mean \"{}\"?", near));
    }
}

const nlohmann::json* JsonFields::find(std::string_view key, bool required) {
    known_.emplace_back(key);
    const auto found = json_.find(std::string(key));
    if (found != json_.end()) return &*found;
    if (required && !error_) error_ = request_error("missing_key", fmt::format("\"{}\" is missing", key), fmt::format("Add \"{}\".", key));
    return nullptr;
}

void JsonFields::wrong(std::string_view key, std::string_view wanted) {
    if (!error_) error_ = request_error("wrong_type", fmt::format("\"{}\" is not {}", key, wanted), fmt::format("Give {}.", wanted));
}

}  // namespace taktwerk::hmi
