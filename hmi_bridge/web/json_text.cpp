#include "hmi_bridge/web/json_text.hpp"

#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

namespace taktwerk::hmi::web {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t most_keys = 64;  ///< of one object; no command has twenty

bool too_deep(std::string_view text, int deepest) {
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            if (c == '\\') ++i;
            else if (c == '"') quoted = false;
        } else if (c == '"') quoted = true;
        else if ((c == '{' || c == '[') && ++depth > deepest) return true;
        else if (c == '}' || c == ']') --depth;
    }
    return false;
}

}  // namespace

Result<Json> read_json(std::string_view text, int deepest) {
    const auto wrong = [](const char* code, std::string what) { return Error{code, "", std::move(what), "Reload the page."}; };
    if (too_deep(text, deepest)) return wrong("web.too_deep", fmt::format("there are more than {} levels", deepest));
    bool duplicate = false, too_many = false;
    std::vector<std::set<std::string>> keys;
    auto json = Json::parse(
        text,
        [&](int, Json::parse_event_t event, Json& value) {
            if (too_many) return false;
            if (event == Json::parse_event_t::object_start) keys.emplace_back();
            else if (event == Json::parse_event_t::object_end) keys.pop_back();
            else if (event == Json::parse_event_t::key) {
                // They are looked for one by one: some thousands in one message would hold up everybody else's stop.
                if (keys.back().size() >= most_keys) return too_many = true, false;
                duplicate = !keys.back().insert(value.get<std::string>()).second || duplicate;
            }
            return true;
        },
        false);
    if (too_many) return wrong("web.too_long", fmt::format("there are more than {} keys in one object", most_keys));
    if (json.is_discarded()) return wrong("web.not_json", "this is no JSON");
    if (duplicate) return wrong("web.duplicate_key", "a key stands twice: nobody can tell which one is meant");
    return json;
}

std::string text_in(const nlohmann::ordered_json& object, const char* key) {
    const auto found = object.is_object() ? object.find(key) : object.end();
    return found != object.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto lead = static_cast<unsigned char>(text[i]);
        const std::size_t more = lead < 0x80 ? 0 : lead >> 5 == 6 ? 1 : lead >> 4 == 14 ? 2 : lead >> 3 == 30 ? 3 : 4;
        if (more == 4 || i + more >= text.size()) return false;
        std::uint32_t code = more == 0 ? lead : lead & (0x3fu >> more);
        for (std::size_t k = 1; k <= more; ++k) {
            const auto next = static_cast<unsigned char>(text[i + k]);
            if (next >> 6 != 2) return false;
            code = code << 6 | (next & 63u);
        }
        constexpr std::uint32_t least[]{0, 0x80, 0x800, 0x10000};
        if (code < least[more] || code > 0x10ffff || (code >= 0xd800 && code < 0xe000)) return false;
        i += more + 1;
    }
    return true;
}

}  // namespace taktwerk::hmi::web
