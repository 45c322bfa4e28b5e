#include "hmi_bridge/web/account/accounts.hpp"

namespace taktwerk::hmi::web {

Result<std::unique_ptr<Accounts>> Accounts::open(const std::string& path, Role role, Say say) {
    std::unique_ptr<Accounts> accounts(new Accounts(path, role, std::move(say)));
    if (path.empty()) return accounts;
    accounts->seen_ = accounts->stamp();
    auto users = Users::load(path);
    if (!users) return std::move(users).error();
    if (users->empty())
        return Error{"web.no_users", path, "the file names no user", "Add one: `taktwerk hmi user add NAME ROLE --users " + path + "`."};
    accounts->users = std::move(*users);
    accounts->desk_ = std::make_unique<PasswordDesk>();
    return accounts;
}

void Accounts::step(Instant now) {
    if (!needed()) return;
    sessions.expire(now);
    const auto is = stamp();
    if (is == seen_) return;
    seen_ = is;
    auto read = Users::load(path_);
    if (!read) return say_(read.error());
    users = std::move(*read);
    sessions.apply(users);
}

Accounts::Stamp Accounts::stamp() const {
    struct stat state {};
    if (::stat(path_.c_str(), &state) != 0) return {};
    return {std::int64_t{state.st_mtim.tv_sec} * 1'000'000'000 + state.st_mtim.tv_nsec, state.st_ino,
            static_cast<std::uint64_t>(state.st_size)};
}

}  // namespace taktwerk::hmi::web
