#pragma once
// A JSON object of strangers, read key by key: what is not there or of another type is a problem in words, never an exception. Not real-time.
// For the folders that read files with JSON in them (../scope_file/, ../bundle/).

#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace taktwerk::runtime {

/// `problem` keeps the first one, for all objects of a file; what is read behind it has some value of its type.
class JsonFields {
public:
    using Json = nlohmann::ordered_json;
    JsonFields(const Json& json, std::string& problem) : json_(json), problem_(problem) {
        if (!json.is_object()) wrong("it", "an object");
    }
    std::string text(const char* key) {
        return text(
            key, [](std::string_view) { return true; }, "a text");
    }
    /// One that is `good`; `wanted` says what that is.
    std::string text(const char* key, bool (*good)(std::string_view), const char* wanted) {
        const auto* value = find(key);
        if (value != nullptr && value->is_string())
            if (auto text = value->get<std::string>(); good(text)) return text;
        return wrong(key, wanted), std::string{};
    }
    std::uint64_t number(const char* key, std::uint64_t least, std::uint64_t most) {
        const auto* value = find(key);
        if (value != nullptr && value->is_number_integer() && (value->is_number_unsigned() || value->get<std::int64_t>() >= 0)) {
            const auto n = value->get<std::uint64_t>();
            if (n >= least && n <= most) return n;
        }
        return wrong(key, fmt::format("a whole number from {} to {}", least, most)), least;
    }
    std::int64_t any_number(const char* key) {
        const auto* value = find(key);
        if (value != nullptr && value->is_number_integer()) return value->get<std::int64_t>();
        return wrong(key, "a whole number"), 0;
    }
    double positive(const char* key) {
        const auto* value = find(key);
        if (value != nullptr && value->is_number())
            if (const auto n = value->get<double>(); std::isfinite(n) && n > 0) return n;
        return wrong(key, "a number above 0"), 1;
    }
    bool flag(const char* key) {
        const auto* value = find(key);
        if (value != nullptr && value->is_boolean()) return value->get<bool>();
        return wrong(key, "true or false"), false;
    }
    /// Its place in `words`.
    template <std::size_t Count>
    std::size_t word(const char* key, const std::array<std::string_view, Count>& words) {
        const auto given = text(key);
        for (std::size_t i = 0; i < Count; ++i)
            if (words[i] == given) return i;
        return wrong(key, "a known word"), 0;
    }
    const Json& list(const char* key, std::size_t most = SIZE_MAX) {
        static const Json none = Json::array();
        const auto* value = find(key);
        if (value != nullptr && value->is_array() && value->size() <= most) return *value;
        return wrong(key, "a list"), none;
    }
    void wrong(std::string_view key, std::string_view wanted) {
        if (problem_.empty()) problem_ = fmt::format("\"{}\" is not {}", key, wanted);
    }

private:
    const Json* find(const char* key) {
        if (!json_.is_object()) return nullptr;
        const auto found = json_.find(key);
        return found == json_.end() ? nullptr : &*found;
    }
    const Json& json_;
    std::string& problem_;
};

}  // namespace taktwerk::runtime
