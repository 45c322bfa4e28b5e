#pragma once
// The users of the page, in a file: {"users":[{"name":"anna","role":"operator","password":"$argon2id$..."}]}. Written by `taktwerk hmi user`, read again by
// the server when it changes. Not thread-safe; not real-time.

#include <string>
#include <string_view>
#include <vector>

#include "core/result.hpp"
#include "hmi_bridge/web/roles.hpp"

namespace taktwerk::hmi::web {

struct User {
    std::string name;  ///< 1 to 64 bytes of UTF-8, no spaces and control characters
    Role role = Role::viewer;
    std::string password;  ///< its hash

    bool operator==(const User&) const = default;
};

class Users {
public:
    static constexpr std::size_t most = 256;
    static constexpr std::size_t longest_file = 256 * 1024;  ///< bytes

    /// `from`: for messages. Errors: web.users, with what is wrong where.
    static Result<Users> read(std::string_view text, const std::string& from);
    /// A file that others may read or write is refused. Errors: web.users.
    static Result<Users> load(const std::string& path);
    /// Beside it first, then in its place: whoever reads sees all of it or what was before. Mode 0640, or that of the file which was there. Errors: web.users.
    [[nodiscard]] Result<void> save(const std::string& path) const;
    [[nodiscard]] std::string text() const;

    [[nodiscard]] const User* find(std::string_view name) const;
    [[nodiscard]] const std::vector<User>& all() const { return users_; }
    [[nodiscard]] bool empty() const { return users_.empty(); }
    /// Takes the place of one of that name. Errors: web.users (name, number, hash).
    Result<void> put(User user);
    /// False: there is none of that name.
    bool remove(std::string_view name);

private:
    std::vector<User> users_;  ///< by name
};

[[nodiscard]] bool is_user_name(std::string_view name);

}  // namespace taktwerk::hmi::web
