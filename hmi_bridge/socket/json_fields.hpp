#pragma once
// The keys of one request of the local socket, read by their types. Unknown keys are errors: a misspelt "velocity" must not mean
// "no velocity". Not real-time.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/result.hpp"

namespace taktwerk::hmi {

/// Reads the keys by their types; the first problem stays. Errors: request.missing_key, request.wrong_type, request.unknown_key.
class JsonFields {
public:
    /// `json`: an object that outlives this.
    explicit JsonFields(const nlohmann::json& json) : json_(json) {}

    std::string text(std::string_view key, bool required);
    double number(std::string_view key, bool required);
    bool flag(std::string_view key);
    /// 0 when absent.
    std::int64_t integer(std::string_view key) { return maybe_integer(key).value_or(0); }
    /// Where 0 means something else than nothing.
    std::optional<std::int64_t> maybe_integer(std::string_view key);
    /// A list of 1 to `most` texts.
    std::vector<std::string> texts(std::string_view key, std::size_t most);
    /// A whole number of 0 or more.
    std::optional<std::uint64_t> maybe_count(std::string_view key);
    /// An object, for JsonFields of its own; its errors are the caller's to look at. nullptr when it is absent or none.
    const nlohmann::json* object(std::string_view key, bool required);
    /// The key is there, whatever its value.
    [[nodiscard]] bool has(std::string_view key) const { return json_.contains(std::string(key)); }
    /// Keys that nobody asked for.
    void finish();
    [[nodiscard]] const std::optional<Error>& error() const { return error_; }

private:
    const nlohmann::json* find(std::string_view key, bool required);
    void wrong(std::string_view key, std::string_view wanted);

    const nlohmann::json& json_;
    std::vector<std::string> known_;
    std::optional<Error> error_;
};

/// Code "request.<code>".
[[nodiscard]] Error request_error(std::string code, std::string what, std::string remedy);
/// What came from outside, quoted and fit for one line.
[[nodiscard]] std::string shown(std::string_view text);

}  // namespace taktwerk::hmi
