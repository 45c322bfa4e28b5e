#include "hmi_bridge/socket/json_writer.hpp"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace taktwerk::hmi {

/// Names and words are mostly plain; what is not goes the library's way, which also replaces bytes that are no UTF-8.
void JsonWriter::put_text(std::string_view text) {
    const bool plain = std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~' && c != '"' && c != '\\'; });
    if (!plain) {
        text_ += nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
        return;
    }
    text_ += '"';
    text_ += text;
    text_ += '"';
}

}  // namespace taktwerk::hmi
