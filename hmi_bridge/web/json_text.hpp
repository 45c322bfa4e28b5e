#pragma once
// JSON from a stranger: bounded in depth before the parser, whose calls nest as the text does, and in the keys of one object; a key that stands twice is an error. Nothing throws.

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "core/result.hpp"

namespace taktwerk::hmi::web {

/// Errors: web.too_deep, web.too_long (more than 64 keys in an object), web.not_json, web.duplicate_key.
[[nodiscard]] Result<nlohmann::ordered_json> read_json(std::string_view text, int deepest);
/// The text at `key`; empty where it is not there or no text, or `object` is none: what listens at a machine's path may be anything.
[[nodiscard]] std::string text_in(const nlohmann::ordered_json& object, const char* key);
/// RFC 3629: no surrogates, nothing overlong.
[[nodiscard]] bool is_utf8(std::string_view text);

}  // namespace taktwerk::hmi::web
