#include "hmi_bridge/socket/answer_line.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace taktwerk::hmi {

std::string accepted_line(const std::string& id) { return fmt::format(R"({{"id":{},"ok":true}})", id); }

std::string refusal_line(const std::string& id, const Error& error) {
    const nlohmann::ordered_json words{{"code", error.code}, {"subject", error.subject}, {"what", error.what}, {"remedy", error.remedy}};
    return fmt::format(R"({{"id":{},"ok":false,"error":{}}})", id, words.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

}  // namespace taktwerk::hmi
