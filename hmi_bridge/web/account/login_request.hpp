#pragma once
// What a browser sends to log in: {"user":"anna","password":"..."}. Not real-time.

#include <string>
#include <string_view>

#include "core/result.hpp"

namespace taktwerk::hmi::web {

struct LoginRequest {
    static constexpr std::size_t longest = 4096;  ///< bytes

    std::string user, password;
};

/// Errors: web.login_body, web.too_deep, web.too_long, web.not_json, web.duplicate_key.
[[nodiscard]] Result<LoginRequest> read_login(std::string_view body);
/// "application/json", with or without parameters: a form of another page cannot say that without being asked first (CORS).
[[nodiscard]] bool is_json_type(std::string_view content_type);

}  // namespace taktwerk::hmi::web
