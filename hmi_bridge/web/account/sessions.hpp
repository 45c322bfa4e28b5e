#pragma once
// Who has logged in. A page holds its session and sees there what becomes of it: another role, the end. Not thread-safe; not real-time.

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "core/time.hpp"
#include "hmi_bridge/web/account/users.hpp"

namespace taktwerk::hmi::web {

struct Session {
    std::string user;
    Role role = Role::viewer;
    std::string password;  ///< the hash it was opened with: another one ends it
    Instant opened{}, used{};
    bool ended = false;
};

class Sessions {
public:
    static constexpr std::size_t most = 64;
    static constexpr std::size_t most_of_user = 8;
    static constexpr Duration idle = std::chrono::minutes{30};   ///< without a page or a request
    static constexpr Duration longest = std::chrono::hours{12};  ///< a shift, and somebody else stands there

    /// Its token, for a cookie. Where there are too many, the one that was unused the longest ends: of this user, else of all.
    std::string open(const User& user, Instant now);
    /// Null: none, or ended. Counts as use.
    std::shared_ptr<Session> find(std::string_view token, Instant now);
    void close(std::string_view token);
    /// Ends what is too old. A page that is open uses its session: `used` is its to set.
    void expire(Instant now);
    /// The file has changed: roles are taken over, sessions of who is gone or has another password end.
    void apply(const Users& users);
    [[nodiscard]] std::size_t size() const { return by_digest_.size(); }

private:
    using ByDigest = std::map<std::string, std::shared_ptr<Session>, std::less<>>;
    ByDigest::iterator end(ByDigest::iterator session);
    /// The one unused the longest, of this user or (empty) of all.
    ByDigest::iterator stalest(std::string_view user, std::size_t& count);

    ByDigest by_digest_;
};

/// Of a `Cookie` header: the value of `name`, empty where it does not stand there.
[[nodiscard]] std::string_view cookie_value(std::string_view header, std::string_view name);

}  // namespace taktwerk::hmi::web
