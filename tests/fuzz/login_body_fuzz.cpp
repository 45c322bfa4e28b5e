// Any bytes as what a browser sends to log in: the body, then its headers Cookie, Host, Origin, Content-Type from the same bytes.
#include <cstdint>
#include <cstdlib>

#include "hmi_bridge/web/account/login_request.hpp"
#include "hmi_bridge/web/account/password.hpp"
#include "hmi_bridge/web/account/sessions.hpp"
#include "hmi_bridge/web/page_origin.hpp"

using namespace taktwerk::hmi::web;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text{reinterpret_cast<const char*>(data), size};
    if (const auto request = read_login(text); request) {
        if (request->user.size() > 64 || request->password.size() > longest_password) std::abort();
    } else if (!request.error().code.starts_with("web.") || request.error().what.empty()) {
        std::abort();
    }
    const auto value = cookie_value(text, "taktwerk_8080");
    if (!value.empty() && text.find("taktwerk_8080=" + std::string(value)) == std::string_view::npos) std::abort();
    if (value.find(';') != std::string_view::npos) std::abort();
    if (is_json_type(text) && size < 16) std::abort();
    // Host before a line end, Origin behind it: whatever is own has a host that is known.
    static const PageOrigin origin("0.0.0.0", 8080, {"hmi.example"});
    const auto split = text.find('\n');
    const auto host = text.substr(0, split), from = split == std::string_view::npos ? std::string_view{} : text.substr(split + 1);
    if (origin.is_own(from, host, "192.168.1.2") && !origin.knows_host(host, "192.168.1.2")) std::abort();
    if (origin.knows_host(host, "192.168.1.2") && host.size() > 16) std::abort();
    return 0;
}
