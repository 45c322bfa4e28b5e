// Any bytes as JSON of a stranger: what is taken is what nlohmann takes too, no deeper than allowed and without a key twice; and as text or bytes that we
// write into JSON ourselves: it reads back as it was.
#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "apps/terminal/json_text.hpp"
#include "hmi_bridge/socket/base64.hpp"
#include "hmi_bridge/socket/json_fields.hpp"
#include "hmi_bridge/web/json_text.hpp"
#include "tests/hmi_bridge/base64_text.hpp"

using namespace taktwerk;
using namespace taktwerk::hmi;

namespace {

int depth_of(const nlohmann::ordered_json& json) {
    int deepest = 0;
    if (json.is_structured())
        for (const auto& part : json) deepest = std::max(deepest, depth_of(part));
    return json.is_structured() ? deepest + 1 : 0;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    constexpr int deepest = 4;
    const auto json = web::read_json(text, deepest);
    if (json) {
        if (depth_of(*json) > deepest || *json != nlohmann::ordered_json::parse(text)) std::abort();
    } else if (!json.error().code.starts_with("web.") || json.error().what.empty()) {
        std::abort();
    } else if (json.error().code == "web.not_json" && nlohmann::json::accept(text)) {
        std::abort();
    }
    // nlohmann refuses to write what is no UTF-8.
    const auto quoted = nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::ignore);
    const bool whole = nlohmann::json::parse(quoted).get_ref<const std::string&>() == text;
    if (web::is_utf8(text) != whole) std::abort();
    if (whole && nlohmann::json::parse(apps::json_text(text)).get_ref<const std::string&>() != text) std::abort();
    if (!nlohmann::json::accept(shown(text))) std::abort();
    std::string encoded;
    append_base64(encoded, std::as_bytes(std::span{data, size}));
    const auto numbers = numbers_of(encoded);
    if (encoded.size() != (size + 2) / 3 * 4 || numbers.size() != size / 8) std::abort();
    if (!numbers.empty() && std::memcmp(numbers.data(), data, numbers.size() * 8) != 0) std::abort();
    return 0;
}
