// Any bytes as the head of a browser's request, a field a line: target, Host, Origin, Cookie, Content-Type, X-Forwarded-For's last, and the body behind
// them. A file is only what was read at the start; what counts as our own page's names our own host; a token and a body go in without harm.
#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <string>

#include "hmi_bridge/web/account/login_request.hpp"
#include "hmi_bridge/web/account/sessions.hpp"
#include "hmi_bridge/web/page_origin.hpp"
#include "hmi_bridge/web/site_files.hpp"
#include "tests/fuzz/scratch_folder.hpp"

using namespace taktwerk;
using namespace taktwerk::hmi::web;

namespace {

/// Three files that are served, and three that are not.
SiteFiles site() {
    static const fuzz::ScratchFolder folder;
    for (const char* name : {"index.html", "page.js", "page.css", "notes.txt", "users.json", ".html"}) folder.write(name, name);
    auto files = SiteFiles::load(folder.path().string());
    if (!files) std::abort();
    return *files;
}

bool same_letters(std::string_view a, std::string_view b) {
    const auto small = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return small(x) == small(y); });
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const SiteFiles files = site();
    static const std::map<std::string, std::string, std::less<>> served{
        {"/", "index.html"}, {"/index.html", "index.html"}, {"/page.js", "page.js"}, {"/page.css", "page.css"}};
    static const std::array origins{PageOrigin("127.0.0.1", 8080), PageOrigin("0.0.0.0", 80, {"hmi.example"}), PageOrigin("::", 8080)};
    std::string_view rest(reinterpret_cast<const char*>(data), size);
    std::array<std::string_view, 6> fields;
    for (auto& field : fields) {
        const auto end = std::min(rest.find('\n'), rest.size());
        field = rest.substr(0, end);
        rest.remove_prefix(std::min(end + 1, rest.size()));
    }
    const auto& [target, host, origin, cookie, type, client] = fields;

    const auto* file = files.find(target);
    const auto expected = served.find(target);
    if ((file != nullptr) != (expected != served.end()) || (file != nullptr && file->content != expected->second)) std::abort();

    for (const auto& own : origins)
        for (const std::string_view arrived : {std::string_view{}, std::string_view{"192.168.1.2"}, std::string_view{"fe80::1"}}) {
            if (!own.is_own(origin, host, arrived)) continue;
            if (!own.knows_host(host, arrived) || host.empty()) std::abort();
            if (!same_letters(origin.substr(0, 7), "http://") && !same_letters(origin.substr(0, 8), "https://")) std::abort();
            if (origin.size() < host.size() + 7 || !same_letters(origin.substr(origin.size() - host.size()), host)) std::abort();
            if (host.find_first_of(" /@\t#?\\") != std::string_view::npos) std::abort();
        }
    (void)is_loopback(client);
    if (is_json_type(type) && !same_letters(type.substr(0, 16), "application/json")) std::abort();

    static const auto opened = [] {
        static Sessions sessions;
        auto token = sessions.open({"anna", Role::operates, "hash"}, Instant{std::chrono::seconds{1}});
        return std::pair{&sessions, std::move(token)};
    }();
    const auto token = cookie_value(cookie, "taktwerk_8080");
    if (token.find(';') != std::string_view::npos) std::abort();
    if (!token.empty() && opened.first->find(token, Instant{std::chrono::seconds{2}}) && token != opened.second) std::abort();
    if (opened.first->size() != 1) std::abort();

    if (const auto request = read_login(rest); !request && (!request.error().code.starts_with("web.") || request.error().remedy.empty()))
        std::abort();
    return 0;
}
