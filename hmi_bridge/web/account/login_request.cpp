#include "hmi_bridge/web/account/login_request.hpp"

#include <algorithm>

#include "hmi_bridge/web/account/password.hpp"
#include "hmi_bridge/web/json_text.hpp"

namespace taktwerk::hmi::web {

Result<LoginRequest> read_login(std::string_view body) {
    const Error wrong{"web.login_body", "", "this is no {\"user\":...,\"password\":...}", "Reload the page."};
    if (body.size() > LoginRequest::longest) return wrong;
    const auto json = read_json(body, 2);
    if (!json) return json.error();
    if (!json->is_object() || json->size() != 2) return wrong;
    for (const char* key : {"user", "password"})
        if (!json->contains(key) || !(*json)[key].is_string()) return wrong;
    LoginRequest request{(*json)["user"].get<std::string>(), (*json)["password"].get<std::string>()};
    if (request.user.size() > 64 || request.password.size() > longest_password) return wrong;
    return request;
}

bool is_json_type(std::string_view content_type) {
    constexpr std::string_view json = "application/json";
    const auto type = content_type.substr(0, content_type.find(';'));
    const auto end = type.find_last_not_of(" \t");
    const auto name = end == std::string_view::npos ? std::string_view{} : type.substr(0, end + 1);
    return std::equal(name.begin(), name.end(), json.begin(), json.end(),
                      [](char a, char b) { return (a >= 'A' && a <= 'Z' ? static_cast<char>(a - 'A' + 'a') : a) == b; });
}

}  // namespace taktwerk::hmi::web
