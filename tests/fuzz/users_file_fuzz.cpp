// Any bytes as the file of the page's users: users that write back and read as the same, or an error that says what is wrong.
#include <cstdint>
#include <cstdlib>

#include "hmi_bridge/web/account/password.hpp"
#include "hmi_bridge/web/account/users.hpp"

using namespace taktwerk::hmi::web;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto users = Users::read({reinterpret_cast<const char*>(data), size}, "file");
    if (!users) {
        if (users.error().code != "web.users" || users.error().what.empty() || users.error().remedy.empty()) std::abort();
        return 0;
    }
    for (const auto& user : users->all())
        if (!is_user_name(user.name) || !is_password_hash(user.password) || users->find(user.name) == nullptr) std::abort();
    const auto again = Users::read(users->text(), "file");
    if (!again || again->all() != users->all()) std::abort();
    return 0;
}
