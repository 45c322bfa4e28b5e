#pragma once
// Who may come in: the users' file as it stands now, their sessions, the gate and the desk before them. Without a file of users everybody is the one role
// that was configured. Not thread-safe but for the desk.

#include <sys/stat.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "hmi_bridge/web/account/login_gate.hpp"
#include "hmi_bridge/web/account/password.hpp"
#include "hmi_bridge/web/account/password_desk.hpp"
#include "hmi_bridge/web/account/sessions.hpp"
#include "hmi_bridge/web/account/users.hpp"

namespace taktwerk::hmi::web {

class Accounts {
public:
    using Say = std::function<void(const Error&)>;

    /// `path`: of the users' file; empty: nobody logs in. `role`: of everybody then. Errors: web.users, web.no_users (the file names nobody).
    static Result<std::unique_ptr<Accounts>> open(const std::string& path, Role role, Say say);

    /// Reads the file again where it has changed; one that cannot be read is told, and who was a user stays one. Ends what is too old.
    void step(Instant now);

    [[nodiscard]] bool needed() const { return desk_ != nullptr; }
    /// Of who has no session: the configured one, or nothing where people log in.
    [[nodiscard]] std::optional<Role> role_of_nobody() const { return needed() ? std::nullopt : std::optional<Role>{role_}; }

    Users users;
    Sessions sessions;
    LoginGate gate;
    [[nodiscard]] PasswordDesk& desk() { return *desk_; }

private:
    Accounts(std::string path, Role role, Say say) : gate(random_seed()), path_(std::move(path)), role_(role), say_(std::move(say)) {}
    struct Stamp {
        std::int64_t modified_ns = 0;
        std::uint64_t number = 0, size = 0;
        bool operator==(const Stamp&) const = default;
    };
    [[nodiscard]] Stamp stamp() const;

    std::string path_;
    Role role_;
    Say say_;
    Stamp seen_{};
    std::unique_ptr<PasswordDesk> desk_;
};

}  // namespace taktwerk::hmi::web
